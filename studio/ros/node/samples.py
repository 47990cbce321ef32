"""Samples between Zenoh and a callback: the queue of a subscription, lost samples, message info."""

from __future__ import annotations

import inspect
import threading
from collections import deque
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple, TypedDict

from studio.errors import MessageCallbackError
from studio.ros.attachment import Attachment
from studio.ros.profiles import NO_HASH

if TYPE_CHECKING:
    from studio.ros.tokens import EndpointToken
    from studio.ros.wire.bridges.bridge import Sender
    from studio.ros.wire.bridges.bridges import Bridges
    from studio.ros.wire.zenoh import Sample

BLINK_NS = 20_000_000
SAMPLES_MAX = 4_096
SENDERS_MAX = 10_000
BRIDGED_RING_MIN = 16
"""Of samples from bridges where the newest suffices: between them others come that do not count."""
LATE_MAX = 256
"""So many missing samples of one sender may still come late."""


class RawSample(NamedTuple):
    """A sample as it came; one is made for each, for which a tuple takes the least time.

    `payload` is CDR, `attachment` holds number, time and sender, `received_ns` is when it was taken
    out of the ring, since the Unix epoch.
    """

    payload: bytes
    attachment: Attachment
    received_ns: int


def sender_of(bridges: Bridges, topic: str, sample: Sample) -> Sender | None:
    """Return who sent a sample through a bridge to DDS.

    None where it comes by another way as well: from a node of rmw_zenoh by its own key, or from
    another bridge in the same DDS domain.
    """
    if sample.attachment is not None:  # only nodes of rmw_zenoh have one
        return None
    return bridges.sender(_stamp_of(sample)[1], topic)


def bridged_attachment(
    bridges: Bridges, topic: str, sample: Sample, now_ns: int
) -> tuple[Attachment, str] | None:
    """Return what rmw_zenoh would have attached to a sample from DDS, and the hash of its type.

    DDS's own number and time stay behind: the number is 0, and the time is when the bridge passed
    it on. The hash is empty where DDS does not tell it. None: as for `sender_of`.
    """
    if sample.attachment is not None:
        return None
    time_text, zid = _stamp_of(sample)  # read once for both: it takes most of the time
    sender = bridges.sender(zid, topic)
    if sender is None:
        return None
    # NTP64: 2**32 are a second since the Unix epoch.
    time_ns = int(time_text) * 1_000_000_000 >> 32 if time_text else now_ns
    return Attachment(0, time_ns, sender.gid), sender.type_hash


def bridged_sample(
    bridges: Bridges, token: EndpointToken, sample: Sample, now_ns: int
) -> RawSample | None:
    """Return a sample that a bridge to DDS sent to an end; None where it is not to be taken.

    It is not where it comes by another way as well, nor where its sender told another hash of the
    type: DDS compares names only, and its bytes would be misread.
    """
    found = bridged_attachment(bridges, token.name, sample, now_ns)
    if found is None:
        return None
    attachment, told = found
    if told and token.type_hash not in {told, NO_HASH}:
        return None
    return RawSample(sample.payload.to_bytes(), attachment, now_ns)


def _stamp_of(sample: Sample) -> tuple[str, str]:
    """Return Zenoh's time of a sample and the session that gave it; empty where it has none.

    Their text takes less than Zenoh's own methods for both.
    """
    stamp = sample.timestamp
    if stamp is None:
        return "", ""
    time_text, _, zid = str(stamp).partition("/")
    return time_text, zid


class SampleQueue:
    """Keeps the last `depth` samples, and those of the last 20 ms.

    Rings are read every 2 ms and threads take turns: what came a moment ago is no backlog, however
    fast its sender is, so that a reader that keeps up loses nothing. A depth of 1 means the newest
    and nothing else.

    Attributes:
        samples: Those that wait, the oldest first; taken from the left.
        overwritten: The number dropped.
    """

    def __init__(self, depth: int) -> None:
        self._depth = depth
        self._most = max(depth, SAMPLES_MAX)
        self._blink_ns = BLINK_NS if depth > 1 else 0
        self.samples: deque[RawSample] = deque()
        self._lock = threading.Lock()
        self.overwritten = 0

    def __len__(self) -> int:
        return len(self.samples)

    def post(self, samples: list[RawSample]) -> None:
        """Add the samples that came since the last call; drop what is too old."""
        with self._lock:
            waiting = self.samples
            waiting.extend(samples)
            since_ns = waiting[-1].received_ns - self._blink_ns if waiting else 0
            while len(waiting) > self._depth and (
                waiting[0].received_ns <= since_ns or len(waiting) > self._most
            ):
                waiting.popleft()
                self.overwritten += 1

    def take(self) -> RawSample | None:
        """Take the oldest out."""
        try:
            return self.samples.popleft()
        except IndexError:
            return None


@dataclass(slots=True)
class _Sender:
    """A sender's highest number, when that was sent, and the numbers that may still come."""

    last: int
    last_ns: int
    missing: dict[int, None] = field(default_factory=dict[int, None])


class Gaps:
    """Counts what is missing between the numbers of each sender's samples.

    A sample that comes late, by its number and its time, is missing no more. One with a lower
    number that was sent later is of a sender that began again, which is no gap. Only the last
    senders are remembered: a peer that invents one for every sample costs no more.
    """

    def __init__(self) -> None:
        self._senders: dict[bytes, _Sender] = {}
        self.lost = 0

    def begin_anew(self) -> None:
        """Forget the senders, so that there is no gap before the next sample of each."""
        self._senders = {}

    def count(self, attachment: Attachment) -> int:
        """Count a sample, and return how many of its sender are missing before it."""
        sequence, source_time_ns, gid = attachment
        sender = self._senders.get(gid)
        if sender is None:
            self._meet(gid, _Sender(sequence, source_time_ns))
            return 0
        missing = sequence - sender.last - 1
        if not missing:
            sender.last, sender.last_ns = sequence, source_time_ns
            return 0
        if missing < 0 and source_time_ns <= sender.last_ns:
            self._came_late(sender, sequence)
            return 0
        if missing > 0:
            self._miss(sender, sequence)
        else:
            sender.missing.clear()
        sender.last, sender.last_ns = sequence, source_time_ns
        return max(0, missing)

    def _meet(self, gid: bytes, sender: _Sender) -> None:
        self._senders[gid] = sender
        if len(self._senders) > SENDERS_MAX:
            del self._senders[next(iter(self._senders))]

    def _miss(self, sender: _Sender, sequence: int) -> None:
        """Count what lies between, and remember the newest of it."""
        self.lost += sequence - sender.last - 1
        first = max(sender.last + 1, sequence - LATE_MAX)
        sender.missing |= dict.fromkeys(range(first, sequence))
        while len(sender.missing) > LATE_MAX:
            del sender.missing[next(iter(sender.missing))]

    def _came_late(self, sender: _Sender, sequence: int) -> None:
        if sequence in sender.missing:
            del sender.missing[sequence]
            self.lost -= 1


class MessageInfo(TypedDict):
    """Times are since the Unix epoch; the GID names the publisher, as in its token."""

    source_timestamp: int
    received_timestamp: int
    publication_sequence_number: int
    reception_sequence_number: int | None
    publisher_gid: bytes


def message_info(sample: RawSample) -> MessageInfo:
    """Return what came with a sample."""
    attachment = sample.attachment
    return MessageInfo(
        source_timestamp=attachment.source_time_ns,
        received_timestamp=sample.received_ns,
        publication_sequence_number=attachment.sequence,
        reception_sequence_number=None,
        publisher_gid=attachment.gid,
    )


def wants_info(topic: str, callback: object) -> bool:
    """Whether a callback takes the message and what came with it, or the message only.

    Raises:
        MessageCallbackError: It takes neither.
    """
    if not callable(callback):
        raise MessageCallbackError(topic, f"{callback!r:.60}", is_callable=False)
    try:
        signature = inspect.signature(callback)
    except ValueError:  # of some built-in functions nothing is known
        return False
    for count in (1, 2):
        try:
            signature.bind(*(object(),) * count)
        except TypeError:
            continue
        return count == 2
    name = getattr(callback, "__name__", "it")
    arguments = ", ".join(signature.parameters)
    raise MessageCallbackError(topic, f"{name}({arguments})", is_callable=True)
