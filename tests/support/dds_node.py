"""Nodes of ROS 2 on DDS: publishers, subscriptions, services and clients by rclpy's names.

All nodes of a process share one participant, as those of one `rclpy.init()` do, and one thread.
"""

from __future__ import annotations

import heapq
import itertools
import logging
import queue
import secrets
import time
from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, Final, Protocol

from studio.errors import CdrError
from studio.ros.cdr import HEADER_BYTES, codec_of
from studio.ros.messages import types_of
from studio.ros.node.clock import Clock
from studio.ros.parameters.node_parameters import NodeParameters
from studio.ros.profiles import PROFILES, profile_named
from studio.ros.qos import QoSProfile, as_profile
from studio.ros.types.classes import definition_of
from tests.support.dds_wire import DdsParticipant, DdsReader

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.ros.types.classes import MessageValue
    from studio.ros.types.library import ServiceType, TypeLibrary
    from tests.support.dds_wire import DdsWriter

NEWEST: Final = next(reversed(PROFILES))
_SERVICES: Final = QoSProfile(depth=10)
_CALL_HEADER_BYTES: Final = 16
"""Before each request and response: who asks, 8 bytes, and the number of the request, 8 bytes."""
_LOOK_FOR_SERVER_S: Final = 0.01
_ENDLESS_S: Final = 3600.0
_log = logging.getLogger(__name__)


@dataclass(order=True)
class Timer:
    """Something to be done at a time of `time.monotonic`, once or in a period."""

    at_s: float
    number: int
    work: Callable[[], None] = field(compare=False)
    period_s: float | None = field(compare=False, default=None)
    cancelled: bool = field(compare=False, default=False)

    def cancel(self) -> None:
        """Do it no more."""
        self.cancelled = True


class DdsProcess:
    """The participant of this process, its nodes, and the thread that works for all of them."""

    def __init__(self, distro: str, domain: int = 0) -> None:
        """`rolling` takes the newest types known."""
        distro = distro if distro in PROFILES else NEWEST
        self.types: TypeLibrary = types_of(distro)
        self.participant = DdsParticipant(profile_named(distro), self.types, domain)
        self.nodes: list[DdsNode] = []
        self.graph_changed = True
        self._timers: list[Timer] = []
        self._numbers = itertools.count()
        self._asked: queue.SimpleQueue[Callable[[], None]] = queue.SimpleQueue()
        self._runs = True

    def node(self, name: str, namespace: str = "/") -> DdsNode:
        """Make a node."""
        made = DdsNode(self, name, namespace)
        self.nodes.append(made)
        self.graph_changed = True
        return made

    def after(self, delay_s: float, work: Callable[[], None]) -> Timer:
        """Do something once."""
        return self._timer(Timer(time.monotonic() + delay_s, next(self._numbers), work))

    def every(self, period_s: float, work: Callable[[], None]) -> Timer:
        """Do something again and again, now for the first time."""
        return self._timer(Timer(time.monotonic(), next(self._numbers), work, period_s))

    def ask(self, work: Callable[[], None]) -> None:
        """Have the thread of the nodes do something; from any thread."""
        self._asked.put(work)
        self.participant.wake()

    def end(self) -> None:
        """Let `run` return; from any thread."""
        self.ask(self._end)

    def run(self) -> None:
        """Work until `end`."""
        while self._runs:
            if self.graph_changed:
                self.graph_changed = False
                self.participant.write_graph(one.entry() for one in self.nodes)
            self.participant.turn(self._wait_s())
            while not self._asked.empty():
                self._asked.get()()
            self._do_due()
        self.participant.leave()

    def new_number(self) -> int:
        """A number that no other end of a service has."""
        return next(self._numbers) & 0xFF

    def _end(self) -> None:
        self._runs = False

    def _timer(self, timer: Timer) -> Timer:
        heapq.heappush(self._timers, timer)
        return timer

    def _wait_s(self) -> float:
        if self.graph_changed or not self._asked.empty():
            return 0.0
        return self._timers[0].at_s - time.monotonic() if self._timers else _ENDLESS_S

    def _do_due(self) -> None:
        now_s = time.monotonic()
        while self._timers and self._timers[0].at_s <= now_s:
            timer = heapq.heappop(self._timers)
            if timer.cancelled:
                continue
            timer.work()
            if timer.period_s is not None:
                timer.at_s = max(timer.at_s + timer.period_s, now_s)
                heapq.heappush(self._timers, timer)


class End(Protocol):
    """Something of a node that has readers and writers."""

    readers: list[DdsReader]
    writers: list[DdsWriter]


class DdsNode(NodeParameters):
    """A node; names may be relative, or private with `~/`."""

    def __init__(self, process: DdsProcess, name: str, namespace: str) -> None:
        self.process, self.name, self.namespace = process, name, namespace
        self.types = process.types
        self.ends: list[End] = []
        # What the studio's own services of parameters and of states ask their node for.
        self.context = SimpleNamespace(wire=SimpleNamespace(types=self.types))

    def create_publisher(
        self, msg_type: type[MessageValue], topic: str, qos_profile: QoSProfile | int
    ) -> DdsPublisher:
        """Publish on a topic."""
        return self._added(DdsPublisher(self, msg_type, self.full_name(topic), qos_profile))

    def create_subscription(
        self,
        msg_type: type[MessageValue],
        topic: str,
        callback: Callable[[bytes], None],
        qos_profile: QoSProfile | int,
    ) -> DdsSubscription:
        """Hear a topic; the callback gets CDR."""
        made = DdsSubscription(self, msg_type, self.full_name(topic), callback, qos_profile)
        return self._added(made)

    def create_service(
        self,
        srv_type: ServiceType,
        srv_name: str,
        callback: Callable[[MessageValue, MessageValue], MessageValue | None],
        *,
        qos_profile: QoSProfile = _SERVICES,
    ) -> DdsService:
        """Serve; None is no answer."""

        def handle(request: MessageValue, reply: Reply) -> None:
            response = callback(request, srv_type.Response())
            if response is not None:
                reply(response)

        return self.create_late_service(srv_type, srv_name, handle, qos_profile)

    def create_late_service(
        self,
        srv_type: ServiceType,
        srv_name: str,
        handle: Callable[[MessageValue, Reply], None],
        qos_profile: QoSProfile = _SERVICES,
    ) -> DdsService:
        """Serve with answers that may come later."""
        made = DdsService(self, srv_type, self.full_name(srv_name), handle, qos_profile)
        return self._added(made)

    def create_client(self, srv_type: ServiceType, srv_name: str) -> DdsClient:
        """Call a service."""
        return self._added(DdsClient(self, srv_type, self.full_name(srv_name)))

    def destroy(self, end: End) -> None:
        """Take away what was made."""
        self.ends.remove(end)
        # The graph is told first, as rmw does it, so that nobody sees ends of no node.
        self.process.participant.write_graph(one.entry() for one in self.process.nodes)
        for one in (*end.readers, *end.writers):
            self.process.participant.close(one)

    def destroy_node(self) -> None:
        """Take it away, with all that it has."""
        self.process.nodes.remove(self)
        self.process.participant.write_graph(one.entry() for one in self.process.nodes)
        for end in self.ends:
            for one in (*end.readers, *end.writers):
                self.process.participant.close(one)

    def entry(self) -> tuple[str, str, list[bytes], list[bytes]]:
        """What the graph says of it."""
        readers = [one.guid for end in self.ends for one in end.readers]
        writers = [one.guid for end in self.ends for one in end.writers]
        return self.namespace, self.name, readers, writers

    def full_name(self, name: str) -> str:
        """The name of a topic or service, from /."""
        if name.startswith("/"):
            return name
        if name.startswith("~/"):
            return f"{self.get_fully_qualified_name()}/{name[2:]}"
        return f"{self.namespace.rstrip('/')}/{name}"

    def get_fully_qualified_name(self) -> str:
        """Namespace and name."""
        return f"{self.namespace.rstrip('/')}/{self.name}"

    def get_clock(self) -> Clock:
        """The clock of the system."""
        return Clock()

    def get_logger(self) -> logging.Logger:
        """What it has to say about faults."""
        return _log

    def now(self) -> Any:  # noqa: ANN401
        """A message of the time."""
        seconds, nanoseconds = divmod(time.time_ns(), 10**9)
        return self.types.message("builtin_interfaces/msg/Time")(sec=seconds, nanosec=nanoseconds)

    def _added(self, end: Any) -> Any:  # noqa: ANN401
        self.ends.append(end)
        self.process.graph_changed = True
        return end


class Reply(Protocol):
    """Answers a request."""

    def __call__(self, response: MessageValue) -> None: ...


class DdsPublisher:
    """Publishes on one topic."""

    def __init__(
        self, node: DdsNode, kind: type[MessageValue], topic: str, qos: QoSProfile | int
    ) -> None:
        self.topic, self._codec = topic, codec_of(kind)
        name = definition_of(kind).name
        participant = node.process.participant
        data = participant.hash_data(name)
        self._writer = participant.writer(f"rt{topic}", name, as_profile(qos), data)
        self.readers: list[DdsReader] = []
        self.writers = [self._writer]

    def publish(self, message: MessageValue) -> None:
        """Send a message."""
        self._writer.write(self._codec.encode(message))

    def publish_cdr(self, cdr: bytes) -> None:
        """Send what is CDR already."""
        self._writer.write(cdr)


class DdsSubscription:
    """Hears one topic."""

    def __init__(
        self,
        node: DdsNode,
        kind: type[MessageValue],
        topic: str,
        callback: Callable[[bytes], None],
        qos: QoSProfile | int,
    ) -> None:
        name = definition_of(kind).name
        participant = node.process.participant
        self.topic = topic
        profile, data = as_profile(qos), participant.hash_data(name)
        self.readers = [participant.reader(f"rt{topic}", name, profile, data, callback)]
        self.writers: list[DdsWriter] = []


class DdsService:
    """Answers one service."""

    def __init__(
        self,
        node: DdsNode,
        kind: ServiceType,
        name: str,
        handle: Callable[[MessageValue, Reply], None],
        qos: QoSProfile,
    ) -> None:
        self.topic, self._handle = name, handle
        self._request, self._response = codec_of(kind.Request), codec_of(kind.Response)
        data = _call_data(node, "serviceid", kind)
        participant = node.process.participant
        self.readers = [
            participant.reader(f"rq{name}Request", f"{kind.name}_Request", qos, data, self._hear)
        ]
        self._writer = participant.writer(f"rr{name}Reply", f"{kind.name}_Response", qos, data)
        self.writers = [self._writer]

    def _hear(self, cdr: bytes) -> None:
        header, body = _split(cdr)
        try:
            request = self._request.decode(body)
        except CdrError as error:
            _log.warning("A request was not understood: %s", error)
            return

        def reply(response: MessageValue) -> None:
            self._writer.write(_joined(header, self._response.encode(response)))

        self._handle(request, reply)


class DdsClient:
    """Calls one service, once a server is there."""

    def __init__(self, node: DdsNode, kind: ServiceType, name: str) -> None:
        self.topic, self._process = name, node.process
        self._request, self._response = codec_of(kind.Request), codec_of(kind.Response)
        self._id = secrets.token_bytes(8)
        self._numbers = itertools.count(1)
        self._waiting: dict[bytes, Callable[[Any], None]] = {}
        data = _call_data(node, "clientid", kind)
        participant = node.process.participant
        self._writer = participant.writer(
            f"rq{name}Request", f"{kind.name}_Request", _SERVICES, data
        )
        self._reader = participant.reader(
            f"rr{name}Reply", f"{kind.name}_Response", _SERVICES, data, self._hear
        )
        self.readers, self.writers = [self._reader], [self._writer]

    def call(self, request: MessageValue, answered: Callable[[Any], None]) -> None:
        """Send a request when there is a server; `answered` gets the response."""
        if not (self._writer.matched and self._reader.matched):
            self._process.after(_LOOK_FOR_SERVER_S, lambda: self.call(request, answered))
            return
        header = self._id + next(self._numbers).to_bytes(8, "little")
        self._waiting[header] = answered
        self._writer.write(_joined(header, self._request.encode(request)))

    def _hear(self, cdr: bytes) -> None:
        header, body = _split(cdr)
        answered = self._waiting.pop(header, None)
        if answered is not None:
            answered(self._response.decode(body))


def _call_data(node: DdsNode, word: str, kind: ServiceType) -> str:
    """User data of both ends of a server or client, by which others know that they are a pair."""
    participant = node.process.participant
    octets = participant.guid[:12] + bytes([0, 0, node.process.new_number(), 0x18])
    called = ".".join(f"{one:02x}" for one in octets)
    return f"{word}= {called};{participant.hash_data(kind.name)}"


def _split(cdr: bytes) -> tuple[bytes, bytes]:
    end = HEADER_BYTES + _CALL_HEADER_BYTES
    return cdr[HEADER_BYTES:end], cdr[:HEADER_BYTES] + cdr[end:]


def _joined(header: bytes, cdr: bytes | bytearray) -> bytes:
    return bytes(cdr[:HEADER_BYTES]) + header + bytes(cdr[HEADER_BYTES:])
