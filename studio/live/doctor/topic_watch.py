"""TopicWatch: what comes on one topic: its pace, the clocks of its senders, its newest header."""

from __future__ import annotations

import struct
import threading
import time
from typing import TYPE_CHECKING, Final, NamedTuple

from studio.errors import AttachmentError
from studio.live.doctor.pace import Pace
from studio.ros.attachment import unpack
from studio.ros.node.samples import bridged_attachment
from studio.ros.node.topic_statistics import RING, TopicStatistics

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from studio.live.doctor.pace import PaceNow
    from studio.ros.attachment import Attachment
    from studio.ros.node.context import Context
    from studio.ros.wire.zenoh import Sample

RING_OF_ALL: Final = 1_024
"""Where each message counts, and not only how many come."""
_SENDERS_MAX: Final = 64
_OFFSETS_S: Final = 60.0
"""Offsets are forgotten after one to two of these: clocks are set, and senders end."""
_LARGE_BYTES: Final = 1 << 16
_READ_LARGE_EVERY_S: Final = 1.0
"""A header costs a copy of its message."""
_READ_EVERY_S: Final = 0.1
_FRAME_BYTES_MAX: Final = 1_024
_ENCAPSULATION: Final = 4
_LITTLE_ENDIAN: Final = 1


class SentHeader(NamedTuple):
    """A header, with when and by whom it was sent; times in ns since the Unix epoch."""

    stamp_ns: int
    frame: str
    sent_ns: int
    received_ns: int
    gid: bytes


class Reading(NamedTuple):
    """What is read of the messages of a topic, besides that they come.

    Attributes:
        has_header: Whether they begin with a std_msgs/Header, which is read now and then.
        take: Called with each payload in the drain's thread.
        latched_key: The data key, where samples that were sent before are wanted, too.
    """

    has_header: bool = False
    take: Callable[[bytes, Attachment, int], None] | None = None
    latched_key: str = ""


class LeastOffset(NamedTuple):
    """The least time from sending to receiving of one endpoint's samples, and their number."""

    least_ns: int
    samples: int


class TopicWatch(TopicStatistics):
    """Statistics of a topic, and what else is known of its samples.

    Args:
        context: Of the session.
        topic: In full.
        kept_s: It ends by itself when nobody asked for `flow` for so long.
        reading: What is read of its messages.
        clock: Seconds that never go back.

    Raises:
        RosNameError: The name of the topic is not valid.
    """

    def __init__(
        self,
        context: Context,
        topic: str,
        kept_s: float,
        reading: Reading,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self.topic, self.has_header, self._take = topic, reading.has_header, reading.take
        self.is_latched = bool(reading.latched_key)
        self._lock, self._pace = threading.Lock(), Pace()
        self.began_s = clock()
        self._offsets: dict[bytes, LeastOffset] = {}
        self._offsets_before: dict[bytes, LeastOffset] = {}
        self._offsets_since_s = self.began_s
        self._header: SentHeader | None = None
        self._read_s = -_READ_LARGE_EVERY_S
        self.samples = self.not_understood = 0
        ring = RING if reading.take is None else RING_OF_ALL
        # Last, for samples come from then on.
        super().__init__(context, topic, kept_s, clock, ring, reading.latched_key)

    def pace(self) -> PaceNow | None:
        """Return how it comes now; None once it has ended."""
        with self._lock:
            return self._pace.now(self._clock()) if self.is_open else None

    def header(self) -> SentHeader | None:
        """Return the newest header that was read."""
        return self._header

    def offsets(self) -> dict[bytes, LeastOffset]:
        """Return the least offset of each sender, by its GID."""
        with self._lock:
            self._forget_offsets()
            found = dict(self._offsets_before)
            for gid, one in self._offsets.items():
                found[gid] = _both(one, found[gid]) if gid in found else one
            return found

    @property
    def listened_s(self) -> float:
        """Since when it is received."""
        return self._clock() - self.began_s

    def _count(self, samples: Sequence[Sample]) -> None:
        self._note(samples, self._sent)

    def _count_bridged(self, samples: Sequence[Sample]) -> None:
        self._note(samples, self._passed_on)

    def _note(
        self, samples: Sequence[Sample], read: Callable[[Sample, int], Attachment | None]
    ) -> None:
        now_ns, now_s = time.time_ns(), self._clock()
        size = sum(len(one.payload) for one in samples)
        self._arrivals.count(time.monotonic_ns(), len(samples), size)
        with self._lock:
            self.samples += len(samples)
            self._pace.count(now_s, len(samples))
            self._forget_offsets()
            noted = [(one, sent) for one in samples if (sent := read(one, now_ns))]
        if self._take is not None:
            for sample, sent in noted:
                self._take(sample.payload.to_bytes(), sent, now_ns)
        elif self.has_header and noted:
            self._read(*noted[-1], now_ns, now_s)

    def _sent(self, sample: Sample, now_ns: int) -> Attachment | None:
        attachment = sample.attachment
        try:
            sent = unpack(None if attachment is None else attachment.to_bytes())
        except AttachmentError:
            self.not_understood += 1
            return None
        return self._timed(sent, now_ns)

    def _passed_on(self, sample: Sample, now_ns: int) -> Attachment | None:
        """Return what is known of a sample from DDS: its time is when the bridge passed it on."""
        found = bridged_attachment(self._context.wire.bridges, self.topic, sample, now_ns)
        return None if found is None else self._timed(found[0], now_ns)

    def _timed(self, sent: Attachment, now_ns: int) -> Attachment:
        if not self.is_latched:  # else it may have been sent long ago
            self._note_offset(sent.gid, now_ns - sent.source_time_ns)
        return sent

    def _note_offset(self, gid: bytes, offset_ns: int) -> None:
        before, now = self._offsets.get(gid), LeastOffset(offset_ns, 1)
        if before is not None:
            self._offsets[gid] = _both(before, now)
        elif len(self._offsets) < _SENDERS_MAX:
            self._offsets[gid] = now

    def _forget_offsets(self) -> None:
        if self._clock() - self._offsets_since_s > _OFFSETS_S:
            self._offsets_before, self._offsets = self._offsets, {}
            self._offsets_since_s = self._clock()

    def _read(self, sample: Sample, sent: Attachment, now_ns: int, now_s: float) -> None:
        is_large = len(sample.payload) > _LARGE_BYTES
        if now_s - self._read_s < (_READ_LARGE_EVERY_S if is_large else _READ_EVERY_S):
            return
        self._read_s = now_s
        if (found := header_of(sample.payload.to_bytes())) is not None:
            self._header = SentHeader(*found, sent.source_time_ns, now_ns, sent.gid)


def _both(one: LeastOffset, other: LeastOffset) -> LeastOffset:
    return LeastOffset(min(one.least_ns, other.least_ns), one.samples + other.samples)


def header_of(payload: bytes) -> tuple[int, str] | None:
    """Return stamp (ns) and frame of a message that begins with a header; None: it has none."""
    order = "<" if len(payload) > 1 and payload[1] & _LITTLE_ENDIAN else ">"
    try:
        sec, nanosec, length = struct.unpack_from(f"{order}iII", payload, _ENCAPSULATION)
    except struct.error:
        return None
    begin = _ENCAPSULATION + 12
    frame = payload[begin : begin + min(length, _FRAME_BYTES_MAX)]
    text = frame.rstrip(b"\0").decode("utf-8", "replace")
    return sec * 1_000_000_000 + nanosec, text
