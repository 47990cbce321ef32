"""KeptTopic: the last messages of one topic of the live system, in memory and in order of time."""

from __future__ import annotations

import hashlib
from array import array
from bisect import bisect_left, bisect_right
from itertools import accumulate, pairwise
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from studio.ros.attachment import GID_BYTES, Attachment
from studio.ros.node.samples import RawSample

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from numpy.typing import NDArray

    from studio.ros.qos import QoSProfile

SAMPLE_BYTES: Final = 128
"""What a message takes beside its payload: three numbers, and what Python keeps of bytes."""
BLOCK_BYTES: Final = 1_500
"""What a block takes beside its messages."""
_BLOCK_PAYLOAD_BYTES: Final = 256 << 10
_BLOCK_COUNT: Final = 2_000
_BLOCK_NS: Final = 10_000_000_000
"""So old are messages at most that are let go with others that are older."""
_LEAST_GAP_NS: Final = 1_000_000_000
"""Thinning leaves one message in this time."""
_DENSE_SHARE: Final = 4
"""The newest of so many parts is not thinned."""
_SENDERS_MAX: Final = 10_000


class Columns(NamedTuple):
    """Messages, each part of them in one column; `senders` may be empty."""

    payloads: Sequence[bytes]
    received_ns: Sequence[int]
    sources_ns: Sequence[int]
    senders: Sequence[bytes]

    def cut(self, begin: int, end: int) -> Columns:
        """Return some of them."""
        payloads, received_ns, sources_ns, senders = self
        return Columns(
            payloads[begin:end], received_ns[begin:end], sources_ns[begin:end], senders[begin:end]
        )


class Block:
    """Messages that came one after the other, as columns: few objects for garbage collection.

    It only grows: what was read of it stays as it is.

    Attributes:
        received_ns: Of each message, never less than of the one before.
        numbers: Its number within the topic.
        sources_ns: When it was published.
        payloads: Its bytes.
        senders: GIDs of the publishers; empty where the topic is not latched.
        size: Bytes of memory that it takes, about.
        level: How many times every second message was left out.
    """

    __slots__ = ("level", "numbers", "payloads", "received_ns", "senders", "size", "sources_ns")

    def __init__(self, level: int = 0) -> None:
        self.received_ns, self.numbers, self.sources_ns = array("q"), array("q"), array("q")
        self.payloads: list[bytes] = []
        self.senders: list[bytes] = []
        self.size, self.level = BLOCK_BYTES, level

    def __len__(self) -> int:
        return len(self.payloads)

    @property
    def is_full(self) -> bool:
        """Whether the next message belongs in another."""
        times = self.received_ns
        return len(times) > 0 and (
            self.size > _BLOCK_PAYLOAD_BYTES
            or len(times) >= _BLOCK_COUNT
            or times[-1] - times[0] > _BLOCK_NS
        )

    def extend(self, columns: Columns, first_number: int) -> None:
        """Add messages, whose times do not go back."""
        payloads, received_ns, sources_ns, senders = columns
        count = len(payloads)
        self.numbers.extend(range(first_number, first_number + count))
        self.sources_ns.extend(sources_ns)
        self.senders.extend(senders)
        self.payloads.extend(payloads)
        self.received_ns.extend(received_ns)
        self.size += sum(map(len, payloads)) + count * SAMPLE_BYTES

    def chosen(self, indices: Sequence[int], level: int) -> Block:
        """Return a block of some of its messages."""
        made = Block(level)
        for name in ("received_ns", "numbers", "sources_ns"):
            column = getattr(self, name)
            getattr(made, name).extend([column[one] for one in indices])
        made.payloads = [self.payloads[one] for one in indices]
        made.senders = [self.senders[one] for one in indices] if self.senders else []
        made.size += sum(map(len, made.payloads)) + len(indices) * SAMPLE_BYTES
        return made

    def joined(self, later: Block) -> Block:
        """Return a block of its messages and those of a later one."""
        made = Block(max(self.level, later.level))
        made.received_ns = self.received_ns + later.received_ns
        made.numbers = self.numbers + later.numbers
        made.sources_ns = self.sources_ns + later.sources_ns
        made.payloads = self.payloads + later.payloads
        if self.senders or later.senders:
            made.senders = _padded(self) + _padded(later)
        made.size = self.size + later.size - BLOCK_BYTES
        return made

    def last_of_senders(self) -> list[int]:
        """Return the indices of the newest message of each publisher, in order."""
        return sorted({gid: index for index, gid in enumerate(self.senders)}.values())


def _padded(block: Block) -> list[bytes]:
    """Return the senders; of messages from before the topic was latched, nobody."""
    return block.senders or [b""] * len(block)


class Part(NamedTuple):
    """Messages [begin, end) of a block."""

    block: Block
    begin: int
    end: int


class KeptTopic:
    """Blocks of one topic, the oldest first; not thread-safe, but what it returns stays as it is.

    Of a latched topic the newest message of each publisher stays for ever, as a late subscriber
    would get it: `_before` has those whose blocks are gone.

    Attributes:
        type_name: Of its messages.
        type_hash: As in liveliness tokens.
        qos: What its publishers offered.
        size: Bytes of memory, about.
        count: Messages that are kept.
        level: How many times every second message was left out, where that was most.
    """

    def __init__(self, name: str, type_name: str, type_hash: str) -> None:
        self.name, self.type_name, self.type_hash = name, type_name, type_hash
        self.qos: tuple[QoSProfile, ...] = ()
        self.is_latched = False
        self.size = self.count = self.level = 0
        self._gid = hashlib.sha256(name.encode()).digest()[:GID_BYTES]
        self._blocks: list[Block] = []
        self._before = Block()
        self._number = 0
        self._last_ns = 0
        self._newest: dict[bytes, tuple[int, int]] = {}
        """Number and time of the newest message of each publisher, where some may come twice."""

    @property
    def begin_ns(self) -> int | None:
        """Time of the oldest, beside those that only latching keeps; None: there is none."""
        return self._blocks[0].received_ns[0] if self._blocks else None

    @property
    def end_ns(self) -> int | None:
        """Time of the newest message."""
        blocks = self._all_blocks()
        return blocks[-1].received_ns[-1] if blocks else None

    # Adding

    def add(self, samples: Sequence[RawSample], *, may_repeat: bool) -> None:
        """Add what came.

        Args:
            samples: In the order in which they came.
            may_repeat: Whether some may have come before: latched ones come to each subscription.
        """
        fresh = [one for one in samples if self._is_new(one)] if may_repeat else samples
        if not may_repeat:
            number, time_ns, sender = samples[-1].attachment
            self._note(sender, number, time_ns)
        if fresh:
            self._extend(self._columns(fresh))

    def _extend(self, columns: Columns) -> None:
        ends = list(accumulate(map(len, columns.payloads)))
        begin, count = 0, len(ends)
        while begin < count:
            block = self._open_block()
            room_bytes = _BLOCK_PAYLOAD_BYTES - block.size + (ends[begin - 1] if begin else 0)
            end = min(count, begin + _BLOCK_COUNT - len(block), bisect_left(ends, room_bytes) + 1)
            before = block.size
            block.extend(columns.cut(begin, end), self._number + 1)
            self._number += end - begin
            self.count += end - begin
            self.size += block.size - before
            begin = end

    def add_latched(self, samples: Sequence[RawSample]) -> None:
        """Add what publishers had latched before anything was kept; the oldest first."""
        if self._blocks or len(self._before):
            return
        self.is_latched = True
        fresh = [one for one in samples if self._is_new(one)]
        if not fresh:
            return
        self._before.extend(self._columns(fresh), 1)
        self._number = len(fresh)
        self.count += len(fresh)
        self.size += self._before.size

    def _open_block(self) -> Block:
        blocks = self._blocks
        if not blocks or blocks[-1].is_full or (self.is_latched and not blocks[-1].senders):
            blocks.append(Block())
            self.size += BLOCK_BYTES
        return blocks[-1]

    def _columns(self, samples: Sequence[RawSample]) -> Columns:
        """Return them with times that do not go back, as a clock may that is set."""
        payloads, attachments, received = zip(*samples, strict=True)
        in_order = sorted((self._last_ns, *received))
        if in_order[0] < self._last_ns or in_order[1:] != list(received):
            in_order = list(accumulate(received, max, initial=self._last_ns))
        self._last_ns = in_order[-1]
        sources = [one[1] for one in attachments]
        senders = [one[2] for one in attachments] if self.is_latched else ()
        return Columns(payloads, in_order[1:], sources, senders)

    def _is_new(self, sample: RawSample) -> bool:
        number, time_ns, sender = sample.attachment
        before = self._newest.get(sender)
        if before is not None and number <= before[0] and time_ns <= before[1]:
            return False
        self._note(sender, number, time_ns)
        return True

    def _note(self, sender: bytes, number: int, time_ns: int) -> None:
        self._newest[sender] = number, time_ns
        if len(self._newest) > _SENDERS_MAX:
            del self._newest[next(iter(self._newest))]

    # Making room

    def drop_oldest(self) -> None:
        """Let go of the oldest block; what is latched and newest of its publisher stays."""
        if not self._blocks:
            self._drop_before()
            return
        gone = self._blocks.pop(0)
        self._subtract(gone)
        if gone.senders:
            both = self._before.joined(gone)
            self._replace_before(both.chosen(both.last_of_senders()[-_SENDERS_MAX:], gone.level))
        if gone.level == self.level:
            self.level = max((one.level for one in self._blocks), default=0)

    def _drop_before(self) -> None:
        """Let go of the oldest message that only latching keeps."""
        kept = self._before.chosen(range(1, len(self._before)), 0)
        self._replace_before(kept)

    def _replace_before(self, block: Block) -> None:
        if len(self._before):
            self._subtract(self._before)
        self._before = block
        if len(block):
            self._add(block)

    def thin(self) -> bool:
        """Leave out every second message of a while, where the fewest were left out so far.

        Returns:
            Whether any was: the newest quarter stays, and one message in a second.
        """
        at = self._thinnable()
        if at is None:
            return False
        both = self._blocks[at].joined(self._blocks[at + 1])
        keep = set(range(0, len(both), 2))
        if both.senders:
            keep.update(both.last_of_senders())
        thinned = both.chosen(sorted(keep), both.level + 1)
        for one in self._blocks[at : at + 2]:
            self._subtract(one)
        self._blocks[at : at + 2] = [thinned]
        self._add(thinned)
        self.level = max(self.level, thinned.level)
        return True

    def _thinnable(self) -> int | None:
        """Return the index of the first of two blocks that can become one."""
        blocks = self._blocks
        until = len(blocks) - max(1, len(blocks) // _DENSE_SHARE)
        pairs = (
            (one.level, at)
            for at, (one, after) in enumerate(pairwise(blocks[:until]))
            if one.level == after.level and _is_dense(one, after)
        )
        return min(pairs, default=(0, None))[1]

    def _add(self, block: Block) -> None:
        self.size += block.size
        self.count += len(block)

    def _subtract(self, block: Block) -> None:
        self.size -= block.size
        self.count -= len(block)

    # Reading

    def _all_blocks(self) -> list[Block]:
        return [self._before, *self._blocks] if len(self._before) else self._blocks

    def parts(self, begin_ns: int, end_ns: int) -> list[Part]:
        """Return the messages in [begin_ns, end_ns), the oldest first."""
        found: list[Part] = []
        for block in self._all_blocks():
            times = block.received_ns
            if times[-1] < begin_ns:
                continue
            if times[0] >= end_ns:
                break
            found.append(Part(block, bisect_left(times, begin_ns), bisect_left(times, end_ns)))
        return found

    def samples(self, part: Part) -> Iterator[RawSample]:
        """Yield the messages of a part."""
        block = part.block
        for at in range(part.begin, part.end):
            attachment = Attachment(block.numbers[at], block.sources_ns[at], self._gid)
            yield RawSample(block.payloads[at], attachment, block.received_ns[at])

    def last(self, at_ns: int, most: int, since_ns: int = 0) -> list[RawSample]:
        """Return the newest in [since_ns, at_ns], at most so many, the oldest first."""
        chosen: list[Part] = []
        for part in reversed(self.parts(since_ns, at_ns + 1)):
            if most <= 0:
                break
            begin = max(part.begin, part.end - most)
            chosen.append(part._replace(begin=begin))
            most -= part.end - begin
        return [one for part in reversed(chosen) for one in self.samples(part)]

    def next_ns(self, after_ns: int) -> int | None:
        """Return the time of the first message after a time."""
        for block in self._all_blocks():
            times = block.received_ns
            if times[-1] > after_ns:
                return times[bisect_right(times, after_ns)]
        return None

    def previous_ns(self, before_ns: int) -> int | None:
        """Return the time of the last message before a time."""
        for block in reversed(self._all_blocks()):
            times = block.received_ns
            if times[0] < before_ns:
                return times[bisect_left(times, before_ns) - 1]
        return None

    def counts(self, begin_ns: int, end_ns: int, bins: int) -> NDArray[np.int64]:
        """Return how many lie in each of so many equal parts of [begin_ns, end_ns)."""
        found = np.zeros(bins, dtype=np.int64)
        edges = [begin_ns + (end_ns - begin_ns) * k // bins for k in range(bins + 1)]
        for block, begin, end in self.parts(begin_ns, end_ns):
            times = np.array(block.received_ns[begin:end], dtype=np.int64)
            found += np.diff(np.searchsorted(times, edges, "left"))
        return found


def _is_dense(one: Block, after: Block) -> bool:
    """Whether more than one message in a second is left if every second goes."""
    lasted_ns = after.received_ns[-1] - one.received_ns[0]
    return lasted_ns < _LEAST_GAP_NS * (len(one) + len(after)) // 2
