"""Subscription: receives the samples of a topic, counts what was lost, and calls back."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Any, Self

from studio.errors import AttachmentError, CdrError
from studio.ros.attachment import unpack
from studio.ros.cdr import codec_of
from studio.ros.node.logger import get_logger
from studio.ros.node.samples import (
    BRIDGED_RING_MIN,
    Gaps,
    MessageInfo,
    RawSample,
    SampleQueue,
    bridged_sample,
    message_info,
    wants_info,
)
from studio.ros.node.task import Future
from studio.ros.node.work import Work
from studio.ros.qos import DEPTH_DEFAULT, DurabilityPolicy, HistoryPolicy, ReliabilityPolicy
from studio.ros.tokens import EndpointKind
from studio.ros.wire.zenoh import SAMPLES_WAITING_MAX, declare_subscription

if TYPE_CHECKING:
    from studio.ros.node.base import Endpoint
    from studio.ros.node.event_handler import CountEvent
    from studio.ros.node.work import CallbackGroup
    from studio.ros.qos import QoSProfile
    from studio.ros.types.classes import MessageValue
    from studio.ros.wire.zenoh import Incoming, Sample

RING = 4_096
"""Samples that Zenoh keeps between two reads, where not only the newest counts."""

MessageCallback = Callable[[Any], object] | Callable[[Any, MessageInfo], object]
"""Takes a message, or its bytes where they are raw; and what came with it, if it has two."""


@dataclass(slots=True)
class Losses:
    """Samples that did not reach the callback of a subscription.

    Attributes:
        lost: Missing in the numbers of a sender: on the way, or overwritten in the ring.
        overwritten: Received, and dropped from the queue because the callback was too slow.
        refused: Received without an attachment of rmw_zenoh's.
        malformed: Not decoded.
        reason: Why the last sample was refused or malformed, a sentence.
    """

    lost: int = 0
    overwritten: int = 0
    refused: int = 0
    malformed: int = 0
    reason: str | None = None


class Subscription(Work):
    """Receives one topic.

    The callback takes the message, or the message and a `MessageInfo`. With `raw` it takes the
    bytes of the CDR instead of the message. Without a callback, `async for` takes messages.

    Attributes:
        events: Handlers that call back on its events, work of its node.
        lost_event: The one of them that counts lost messages.
    """

    def __init__(
        self,
        endpoint: Endpoint,
        msg_type: type[MessageValue],
        callback: MessageCallback | None,
        group: CallbackGroup,
        *,
        raw: bool = False,
    ) -> None:
        super().__init__(group)
        self.endpoint = endpoint
        self.msg_type = msg_type
        self.callback = callback
        self.raw = raw
        self._wants_info = callback is not None and wants_info(endpoint.token.name, callback)
        self._codec = codec_of(msg_type)
        self._losses, self._gaps = Losses(), Gaps()
        depth, ring = _sizes(endpoint.token.qos)
        self._inbox = SampleQueue(depth)
        self._arrived: Future[None] | None = None
        self.events: list[Work] = []
        self.lost_event: CountEvent | None = None
        self._incoming: Incoming[Sample] | None = _declared(endpoint, endpoint.key, ring)
        self._bridged = endpoint.for_bridges(
            lambda key: _declared(endpoint, key, ring, is_of_others=True)
        )
        endpoint.show()

    @property
    def topic_name(self) -> str:
        """The full name of the topic."""
        return self.endpoint.token.name

    topic = topic_name

    @property
    def qos_profile(self) -> QoSProfile:
        """The profile asked for."""
        return self.endpoint.token.qos

    def get_publisher_count(self) -> int:
        """Count who publishes the topic."""
        return self.endpoint.graph().count(EndpointKind.PUBLISHER, self.topic_name)

    @property
    def losses(self) -> Losses:
        """The losses until now, a copy."""
        return replace(self._losses, lost=self._gaps.lost, overwritten=self._inbox.overwritten)

    @property
    def is_ready(self) -> bool:
        """Whether a sample waits for the callback."""
        return bool(self._inbox.samples) and self.callback is not None

    def drain(self) -> int:
        """Empty the ring into the queue; of the drain's thread."""
        incoming = self._incoming
        if incoming is None:
            return 0
        samples = incoming.take(RING)
        now_ns = time.time_ns()
        came = [raw for sample in samples if (raw := self._received(sample, now_ns)) is not None]
        bridged = self._bridged.declared
        count = len(samples)
        if bridged is not None and (samples := bridged.take(RING)):
            bridges, token = self.endpoint.wire.bridges, self.endpoint.token
            read = (bridged_sample(bridges, token, sample, now_ns) for sample in samples)
            came += [raw for raw in read if raw is not None]
            count += len(samples)
        if came:
            self._inbox.post(came)
            self._notify()
        return count

    def take(self) -> Callable[[], object] | None:
        """Take the oldest sample, and return what calls back with it."""
        sample = self._inbox.take()
        return None if sample is None else partial(self._call_back, sample)

    def take_message(self) -> MessageValue | None:
        """Take the oldest message of a subscription without a callback; None: there is none."""
        while (sample := self._inbox.take()) is not None:
            if (message := self._decoded(sample)) is not None:
                return message
        return None

    def destroy(self) -> None:
        """Take it back; again is harmless."""
        incoming, self._incoming = self._incoming, None
        if incoming is not None:
            self.endpoint.hide(incoming)
            self._notify()

    def __aiter__(self) -> Self:
        return self

    async def __anext__(self) -> Any:  # noqa: ANN401
        """Wait for the next message, or for its bytes where they are raw.

        In asyncio or in a callback; it ends when the subscription is destroyed.
        """
        while True:
            self._arrived = arrived = Future[None]()
            sample = self._inbox.take()
            if sample is not None:
                message: Any = sample.payload if self.raw else self._decoded(sample)
                if message is not None:
                    return message
            elif self._incoming is None:
                raise StopAsyncIteration
            else:
                await arrived

    def _notify(self) -> None:
        arrived = self._arrived
        if arrived is not None:
            arrived.set_result(None)
        if self.callback is not None:
            self.announce()

    def _received(self, sample: Sample, now_ns: int) -> RawSample | None:
        attachment = sample.attachment
        try:
            unpacked = unpack(None if attachment is None else attachment.to_bytes())
        except AttachmentError as error:
            self._losses.refused += 1
            self._log_dropped(str(error))
            return None
        missing = self._gaps.count(unpacked)
        if missing and self.lost_event is not None:
            self.lost_event.count(missing)
        return RawSample(sample.payload.to_bytes(), unpacked, now_ns)

    def _call_back(self, sample: RawSample) -> object:
        callback: Callable[..., object] | None = self.callback
        if callback is None:
            return None
        try:
            message: Any = sample.payload if self.raw else self._codec.decode(sample.payload)
        except CdrError as error:
            self._count_malformed(error)
            return None
        if self._wants_info:
            return callback(message, message_info(sample))
        return callback(message)

    def _decoded(self, sample: RawSample) -> MessageValue | None:
        try:
            return self._codec.decode(sample.payload)
        except CdrError as error:
            self._count_malformed(error)
            return None

    def _count_malformed(self, error: CdrError) -> None:
        self._losses.malformed += 1
        self._log_dropped(str(error))

    def _log_dropped(self, reason: str) -> None:
        """Keep why a sample was lost, and log the first of a kind: a flood is no flood of lines."""
        if self._losses.reason is None:
            get_logger("studio.ros").warning(f"A sample on {self.topic_name} was dropped. {reason}")
        self._losses.reason = reason


def _sizes(qos: QoSProfile) -> tuple[int, int]:
    """Return how many samples may wait for the callback, and how many for the drain."""
    if qos.history is HistoryPolicy.KEEP_ALL:
        return SAMPLES_WAITING_MAX, SAMPLES_WAITING_MAX
    depth = qos.depth or DEPTH_DEFAULT
    return depth, 1 if depth == 1 else max(RING, depth)


def _declared(
    endpoint: Endpoint, key: str, ring: int, *, is_of_others: bool = False
) -> Incoming[Sample]:
    qos = endpoint.token.qos
    latched = qos.durability is DurabilityPolicy.TRANSIENT_LOCAL
    return declare_subscription(
        endpoint.wire.zenoh,
        key,
        max(ring, BRIDGED_RING_MIN) if is_of_others else ring,
        reliable=qos.reliability is not ReliabilityPolicy.BEST_EFFORT,
        wanted=(qos.depth or DEPTH_DEFAULT) if latched else None,
        is_of_others=is_of_others,
    )
