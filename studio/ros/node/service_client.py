"""Client: calls a service; the answer is a future, which is set while the node spins."""

from __future__ import annotations

import threading
import time
from collections import deque
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from studio.errors import (
    AttachmentError,
    CallRefusedError,
    CdrError,
    DestroyedError,
    ExternalShutdownException,
    ForeignAnswerError,
    NoAnswerError,
    NotServedError,
    WireError,
)
from studio.ros import strictness
from studio.ros.attachment import packed, unpack
from studio.ros.cdr import check_kind, codec_of
from studio.ros.node.service_end import ServiceEnd
from studio.ros.node.task import Future
from studio.ros.types.classes import definition_of
from studio.ros.wire.zenoh import (
    REPLIES_WAITING_MAX,
    Replies,
    Reply,
    Sample,
    ZError,
    declare_querier,
)

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.ros.node.base import Endpoint, NodeBase
    from studio.ros.node.work import CallbackGroup
    from studio.ros.types.classes import MessageValue
    from studio.ros.types.library import ServiceKind
    from studio.ros.wire.zenoh import Querier

SERVICE_TIMEOUT_S = 600.0
"""rmw_zenoh's limit for the duration of a call."""
_CHECK_EVERY_S = 0.1
_CHECK_LOST_EVERY_S = 0.25
_LOST_CHECKS = 4
_SILENCE = b"Timeout"


@dataclass(slots=True)
class _Call:
    """A pending request; `answered` when a reply came, others may follow."""

    future: Future[Any]
    replies: Replies
    raw: bool = False
    answered: bool = False
    was_served: bool = False
    is_bridged: bool = False
    checks_without_server: int = 0
    failure: WireError | None = None


class Client(ServiceEnd):
    """One service's client.

    A future ends with the first response; with NotServedError when nobody serves the service,
    and with NoAnswerError when a server was silent for longer than `timeout_s`. When several
    nodes serve it, each handles the request, and the first answer counts, with one warning.
    """

    def __init__(
        self,
        endpoint: Endpoint,
        srv_type: ServiceKind,
        group: CallbackGroup,
        node: NodeBase,
        timeout_s: float = SERVICE_TIMEOUT_S,
    ) -> None:
        super().__init__(endpoint, srv_type, group)
        self._node = node
        self._timeout_s = timeout_s
        self._codecs = codec_of(srv_type.Request), codec_of(srv_type.Response)
        self._request = definition_of(srv_type.Request)
        self._sequence = 0
        self._warned_of_several = self._warned_of_silence = False
        self._check_at_s = 0.0
        self._lock = threading.Lock()
        self._calls: dict[int, _Call] = {}
        self._done: deque[tuple[_Call, bytes | WireError]] = deque()
        zenoh = endpoint.wire.zenoh
        self._querier: Querier | None = declare_querier(zenoh, endpoint.key, timeout_s)
        self._bridged = endpoint.for_bridges(
            lambda key: declare_querier(zenoh, key, timeout_s, is_for_bridge=True), self._lock
        )
        endpoint.show()

    @property
    def is_ready(self) -> bool:
        """Whether an answer waits."""
        return bool(self._done)

    def service_is_ready(self) -> bool:
        """Whether a node serves it."""
        return self.endpoint.graph().has_server(self.service_name, self.srv_type.name)

    def wait_for_service(self, timeout_sec: float | None = None) -> bool:
        """Wait until a node serves it, or that long; whether one does.

        Raises:
            ExternalShutdownException: The process was asked to end; rclpy has an error of its own.
        """
        end_s = None if timeout_sec is None else time.monotonic() + timeout_sec
        graph = self.endpoint.graph()
        while not self.service_is_ready():
            left_s = _CHECK_EVERY_S if end_s is None else end_s - time.monotonic()
            if not self._node.context.ok():
                raise ExternalShutdownException
            if left_s <= 0:
                return False
            graph.wait_for(self.service_is_ready, min(left_s, _CHECK_EVERY_S))
        return True

    def call(self, request: MessageValue, timeout_sec: float | None = None) -> Any:  # noqa: ANN401
        """Call and wait, while another thread spins the node; never within its only callback.

        Raises:
            NoAnswerError: No answer came in time.
            NotServedError: Nobody serves it.
        """
        future = self.call_async(request)
        if not future.wait(timeout_sec):
            future.cancel()
            raise NoAnswerError("service", self.service_name, timeout_sec or 0.0)
        return future.result()

    def call_async(self, request: MessageValue, *, raw: bool = False) -> Future[Any]:
        """Call, and return the future of the answer; with `raw`, of its bytes, as they came.

        Raises:
            MessageValueError: It is no request of this service, or a field holds what it does
                not take.
            DestroyedError: The client was destroyed.
        """
        payload = self._codecs[0].encode(check_kind(self._request, request))
        was_served = self.service_is_ready()
        future: Future[Any] = Future(executor=self._node.executor)
        with self._lock:
            if self._querier is None:
                raise DestroyedError(f"client of {self.service_name}")
            bridged = self._querier_for_bridge()
            self._sequence += 1
            number = self._sequence
            if bridged is None:
                attachment = packed(number, time.time_ns(), self.endpoint.gid)
                replies = Replies(self._querier, payload, attachment)
            else:
                replies = Replies(bridged, payload, None)
            self._calls[number] = _Call(
                future, replies, raw, was_served=was_served, is_bridged=bridged is not None
            )
        future.listen(lambda: self._give_up(number, future))
        self._node.context.drain.hurry(self)
        return future

    def remove_pending_request(self, future: Future[Any]) -> None:
        """Forget a request: its future is never set."""
        with self._lock:
            numbers = [number for number, call in self._calls.items() if call.future is future]
        for number in numbers:
            self._forget(number)

    def drain(self) -> int:
        """Take in replies; of the drain's thread."""
        with self._lock:
            calls = list(self._calls.items())
        came = sum(self._drain_call(number, call) for number, call in calls)
        if calls and time.monotonic() > self._check_at_s:
            self._end_lost(calls)
        if self._done:
            self.announce()
        return came

    def take(self) -> Callable[[], object] | None:
        """Take the oldest answer, and return what sets its future."""
        try:
            call, answer = self._done.popleft()
        except IndexError:
            return None
        return lambda: self._settle(call, answer)

    def destroy(self) -> None:
        """End the client; pending requests are cancelled."""
        with self._lock:
            querier, self._querier = self._querier, None
            calls, self._calls = self._calls, {}
        if querier is None:
            return
        for call in calls.values():
            call.replies.cancel()
            call.future.cancel()
        self.endpoint.hide(querier)

    def _querier_for_bridge(self) -> Querier | None:
        """Return what asks through a bridge, where only DDS nodes serve it; with the lock."""
        bridged = self._bridged.declared
        if bridged is None:
            return None
        name = self.srv_type.name
        servers = self.endpoint.graph().servers(self.service_name)
        fitting = [one for one in servers if one.type_name == name]
        return bridged if fitting and all(one.node.bridge for one in fitting) else None

    def _drain_call(self, number: int, call: _Call) -> int:
        # No more at once than wait: a server that replies without end must not hold the drain.
        for came in range(REPLIES_WAITING_MAX):
            try:
                reply = call.replies.try_recv()
            except ZError:  # the last reply was taken, or the time is over
                self._ended(number, call)
                return came + 1
            if reply is None:
                return came
            self._replied(number, call, reply)
        return REPLIES_WAITING_MAX

    def _replied(self, number: int, call: _Call, reply: Reply) -> None:
        sample, refusal = reply.ok, reply.err
        if refusal is not None:
            payload = refusal.payload.to_bytes()
            call.failure = _failure(self.service_name, payload, self._timeout_s)
        elif (
            sample is not None
            and not call.is_bridged
            and (reason := self._why_foreign(number, sample))
        ):
            call.failure = ForeignAnswerError(self.service_name, reason)
        elif sample is not None and not call.answered:
            call.answered = True
            self._done.append((call, sample.payload.to_bytes()))
        elif not self._warned_of_several:
            self._warned_of_several = True
            self._node.get_logger().warning(
                f"The service {self.service_name} is served by more than one node: each did what "
                "was asked, and the first answer was taken."
            )

    def _why_foreign(self, number: int, sample: Sample) -> str | None:
        """Return why a reply is not rmw_zenoh's to a request, None when it is."""
        attachment = sample.attachment
        try:
            unpacked = unpack(None if attachment is None else attachment.to_bytes())
        except AttachmentError as error:
            return error.reason
        if (unpacked.sequence, unpacked.gid) != (number, self.endpoint.gid):
            return "it carries the number of another request"
        return None

    def _ended(self, number: int, call: _Call) -> None:
        known = self._forget(number)
        if known and not call.answered:
            if strictness.is_begun() and call.failure is None:
                self._tell_of_silence()
                return
            failure = call.failure or NotServedError("service", self.service_name)
            self._done.append((call, failure))

    def _tell_of_silence(self) -> None:
        """Say that nobody answers: in a user's program the future stays as it is, as in rclpy."""
        if not self._warned_of_silence:
            self._warned_of_silence = True
            self._node.get_logger().debug(
                f"Nobody serves {self.service_name}: what was asked of it is not answered."
            )

    def _end_lost(self, calls: list[tuple[int, _Call]]) -> None:
        """End calls whose server has been gone for a while, and that Zenoh did not end.

        Zenoh forgets a request that arrives while its server ends.
        """
        self._check_at_s = time.monotonic() + _CHECK_LOST_EVERY_S
        is_served = self.service_is_ready()
        for number, call in calls:
            call.was_served |= is_served
            call.checks_without_server = 0 if is_served else call.checks_without_server + 1
            if call.was_served and call.checks_without_server >= _LOST_CHECKS:
                call.replies.cancel()
                self._ended(number, call)

    def _settle(self, call: _Call, answer: bytes | WireError) -> None:
        if isinstance(answer, WireError):
            call.future.set_exception(answer)
            return
        try:
            call.future.set_result(answer if call.raw else self._codecs[1].decode(answer))
        except CdrError as error:
            call.future.set_exception(error)

    def _give_up(self, number: int, future: Future[Any]) -> None:
        if future.cancelled():
            self._forget(number, cancel=True)

    def _forget(self, number: int, *, cancel: bool = False) -> bool:
        """Forget a call; whether it was known."""
        with self._lock:
            call = self._calls.pop(number, None)
        if call is not None and cancel:
            call.replies.cancel()
        return call is not None


def _failure(name: str, payload: bytes, timeout_s: float) -> WireError:
    if payload == _SILENCE:
        return NoAnswerError("service", name, timeout_s)
    text = payload[:200].decode(errors="replace")
    return CallRefusedError(name, text)
