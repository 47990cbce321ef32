"""Topic statistics: rate, bandwidth and age of what comes on a topic of any type."""

from __future__ import annotations

import threading
import time
from collections import deque
from contextlib import suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, NamedTuple

from studio.errors import AttachmentError
from studio.ros.attachment import unpack
from studio.ros.names import check_full_name
from studio.ros.node.samples import Gaps, sender_of
from studio.ros.tokens import whatever_type_key
from studio.ros.wire.bridges.side import BridgeSide
from studio.ros.wire.zenoh import declare_subscription

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from studio.ros.node.context import Context
    from studio.ros.wire.zenoh import Sample

_BUCKET_NS: Final = 50_000_000
_WINDOW_NS: Final = 4_000_000_000
_SEEN_NS: Final = 60_000_000_000
"""Largest gap between two arrivals that still give a rate."""
_SILENT_NS: Final = 3_000_000_000
_PERIODS: Final = 3
"""After so many of its own periods without a sample, a topic is silent."""
RING: Final = 64
"""Samples that Zenoh keeps between two reads; dropped ones are counted by their numbers."""
_BRIDGED_RING: Final = 1_024
"""Of samples from bridges to DDS, which number none."""
_MISSED_MAX: Final = 10_000
"""A peer may write any number."""


@dataclass(frozen=True, slots=True)
class Flow:
    """Rate, bandwidth and age of a topic.

    Attributes:
        rate_hz: Samples in a second; 0 when too few came, or none any more.
        bytes_per_s: Of their payloads.
        age_s: Since the last one; None when none came.
        is_silent: None came for longer than is usual for it.
    """

    rate_hz: float = 0.0
    bytes_per_s: float = 0.0
    age_s: float | None = None
    is_silent: bool = False


class _Mark(NamedTuple):
    """The counts at a time."""

    at_ns: int
    samples: int
    bytes: int


class Arrivals:
    """Counts arrivals; one thread counts, others ask. It keeps some 80 marks however much comes.

    All times are of one clock, in ns. A rate is measured between arrivals, so that it neither
    flickers nor depends on when it is asked for.
    """

    def __init__(self, began_ns: int) -> None:
        self._began_ns = began_ns
        self._lock = threading.Lock()
        self._marks: deque[_Mark] = deque()
        self._bucket_ns = 0
        self._samples = self._bytes = 0

    def count(self, now_ns: int, samples: int, payload_bytes: int) -> None:
        """Count samples that came just now, with so many bytes in all."""
        with self._lock:
            self._samples += samples
            self._bytes += payload_bytes
            if self._marks and now_ns - self._bucket_ns < _BUCKET_NS:
                self._marks.pop()
            else:
                self._bucket_ns = now_ns
            self._marks.append(_Mark(now_ns, self._samples, self._bytes))
            self._forget(now_ns)

    def flow(self, now_ns: int) -> Flow:
        """Return the rate, bandwidth and age at a time."""
        with self._lock:
            first, last = (self._marks[0], self._marks[-1]) if self._marks else (None, None)
        if first is None or last is None:
            return Flow(is_silent=now_ns - self._began_ns > _SILENT_NS)
        age_ns, span_ns = now_ns - last.at_ns, last.at_ns - first.at_ns
        samples = last.samples - first.samples
        age_s = max(0, age_ns) / 1e9
        if not samples or not span_ns:
            return Flow(age_s=age_s, is_silent=age_ns > _SILENT_NS)
        if age_ns > max(_SILENT_NS, _PERIODS * span_ns // samples):
            return Flow(age_s=age_s, is_silent=True)
        a_second = 1e9 / span_ns
        return Flow(samples * a_second, (last.bytes - first.bytes) * a_second, age_s)

    def _forget(self, now_ns: int) -> None:
        """Keep what lies in the window; of what comes seldom, the last two."""
        marks = self._marks
        while len(marks) > 2 and now_ns - marks[0].at_ns > _WINDOW_NS:
            marks.popleft()
        if len(marks) == 2 and now_ns - marks[0].at_ns > _SEEN_NS:
            marks.popleft()


class TopicStatistics:
    """Subscribes to a topic, and ends by itself when nobody asked for `kept_s`.

    It declares no token, so the graph shows no further subscription; payloads are never copied.

    Args:
        context: Of the session.
        topic: In full.
        kept_s: See above.
        clock: Seconds that never go back.
        ring: Samples that are kept between two reads.
        latched_key: The data key, where samples that were sent before are wanted, too.

    Raises:
        RosNameError: The name of the topic is not valid.
    """

    def __init__(
        self,
        context: Context,
        topic: str,
        kept_s: float,
        clock: Callable[[], float] = time.monotonic,
        ring: int = RING,
        latched_key: str = "",
    ) -> None:
        self._context, self._kept_s, self._clock, self._ring = context, kept_s, clock, ring
        self._asked_s, self._topic = clock(), topic
        self._arrivals = Arrivals(time.monotonic_ns())
        self._gaps = Gaps()
        key = latched_key or whatever_type_key(context.wire.domain, check_full_name(topic))
        is_latched = bool(latched_key)
        wanted = ring if is_latched else None
        self._incoming = declare_subscription(
            context.wire.zenoh, key, ring, reliable=is_latched, wanted=wanted
        )
        self._bridged = BridgeSide(
            context.wire.zenoh,
            context.wire.bridges,
            None,
            topic,
            lambda key: declare_subscription(
                context.wire.zenoh,
                key,
                max(_BRIDGED_RING, ring),
                reliable=is_latched,
                wanted=wanted,
                is_of_others=True,
            ),
        )
        self.is_open = True
        context.drain.add(self)

    def flow(self) -> Flow:
        """Return what comes of the topic; it stays subscribed for `kept_s` from now on."""
        self._asked_s = self._clock()
        return self._arrivals.flow(time.monotonic_ns())

    def close(self) -> None:
        """Take the subscription back; again is harmless."""
        self.is_open = False
        self._context.forget_source(self)
        self._incoming.undeclare()
        self._bridged.close()

    def drain(self) -> int:
        """Count what came; of the drain's thread."""
        if samples := self._incoming.take(self._ring):
            self._count(samples)
        count = len(samples)
        bridged = self._bridged.declared
        if bridged is not None and (from_dds := self._of_dds(bridged.take(_BRIDGED_RING))):
            self._count_bridged(from_dds)
            count += len(from_dds)
        if self._clock() - self._asked_s > self._kept_s:
            self.close()
        return count

    def _of_dds(self, samples: list[Sample]) -> list[Sample]:
        """Return what bridges brought, and no other way does."""
        bridges = self._context.wire.bridges
        return [one for one in samples if sender_of(bridges, self._topic, one) is not None]

    def _count_bridged(self, samples: Sequence[Sample]) -> None:
        """Count what bridges brought, which has no number."""
        self._count(samples)

    def _count(self, samples: Sequence[Sample]) -> None:
        sizes, missed = [len(one.payload) for one in samples], self._missed(samples)
        bytes_missed = missed * sum(sizes) // len(sizes)
        now_ns = time.monotonic_ns()
        self._arrivals.count(now_ns, len(sizes) + missed, sum(sizes) + bytes_missed)

    def _missed(self, samples: Sequence[Sample]) -> int:
        """Count samples dropped from the ring, as far as senders number them."""
        missed = 0
        for sample in samples:
            attachment = sample.attachment
            with suppress(AttachmentError):
                numbered = unpack(None if attachment is None else attachment.to_bytes())
                missed += self._gaps.count(numbered)
        return min(missed, _MISSED_MAX) if len(samples) == self._ring else 0
