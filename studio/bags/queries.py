"""Questions about one file of a recording, answered by reading as few of its blocks as can be."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from studio.bags.recording import Recorded

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from numpy.typing import NDArray

    from studio.bags.blocks import BlockFile, BlockTable, Outline
    from studio.ros.node.samples import RawSample

_ATTEMPTS: Final = 8
"""As often as messages turn out to be damaged, what lies before them is looked for."""

_ALL: Final = 2**62
_KEPT_BLOCKS_MAX: Final = 5
"""Of a range of more blocks none is kept for whoever asks next: it would drive out all others."""
_HELD_BYTES_MAX: Final = 16 * 2**20
"""Messages that wait for later blocks are held; where they are more, they are read once more."""


class Place(NamedTuple):
    """Where a message lies; of two, the one that comes later is the larger."""

    time_ns: int
    start: int
    place: int
    block: int
    channel: int


class _Waiting(NamedTuple):
    """A message that waits for those of later blocks; the places of no two are equal.

    One that is held has its number in the block as its place, which sorts in the same way.
    """

    place: Place
    held: Recorded | None = None


def newest(
    file: BlockFile, channels: Mapping[int, Outline], at_ns: int, most: int, since_ns: int
) -> list[RawSample]:
    """Return the newest messages of some channels in [since, at], at most so many, oldest first."""
    whole: list[RawSample] = []
    damaged: set[Place] = set()
    for _ in range(_ATTEMPTS):
        places = {
            place
            for key in channels
            for place in _newest_places(file, key, at_ns, most + len(damaged), since_ns)
        }
        wanted = sorted(places - damaged)[-most:]
        found = [
            file.sample(one.block, one.channel, one.place, channels[one.channel].gid)
            for one in wanted
        ]
        whole = [one for one in found if one is not None]
        if len(whole) == len(found):
            break
        damaged.update(place for place, one in zip(wanted, found, strict=True) if one is None)
    return whole


def _newest_places(
    file: BlockFile, channel: int, at_ns: int, most: int, since_ns: int
) -> list[Place]:
    """Return where the newest messages of a channel in [since, at] lie, in no order."""
    presence = file.table.presence.get(channel)
    if presence is None:
        return []
    found: list[Place] = []
    for i in range(int(np.searchsorted(presence.begins_ns, at_ns, "right")) - 1, -1, -1):
        enough = len(found) >= most
        if presence.ends_max_ns[i] < (min(found).time_ns if enough else since_ns):
            break
        block = int(presence.blocks[i])
        found += _in_block(file, channel, block, (since_ns, at_ns), most)
        found = sorted(found)[-most:]
    return found


def _in_block(
    file: BlockFile, channel: int, block: int, span_ns: tuple[int, int], most: int
) -> list[Place]:
    """Return where the last messages of a channel in a block and a span, ends included, lie."""
    times_ns, places = file.entries(block, channel)
    first = int(np.searchsorted(times_ns, span_ns[0], "left"))
    last = int(np.searchsorted(times_ns, span_ns[1], "right"))
    first = max(first, last - most)
    start = int(file.table.starts[block])
    return [
        Place(int(times_ns[i]), start, int(places[i]), block, channel) for i in range(first, last)
    ]


def next_time(file: BlockFile, channel: int, after_ns: int) -> int | None:
    """Return the time of the first message of a channel after a time."""
    presence = file.table.presence.get(channel)
    if presence is None:
        return None
    found: int | None = None
    first = int(np.searchsorted(presence.ends_max_ns, after_ns, "right"))
    for i in range(first, len(presence.blocks)):
        if found is not None and presence.begins_ns[i] >= found:
            break
        times_ns = file.entries(int(presence.blocks[i]), channel).times_ns
        at = int(np.searchsorted(times_ns, after_ns, "right"))
        if at < len(times_ns):
            found = int(times_ns[at]) if found is None else min(found, int(times_ns[at]))
    return found


def previous_time(file: BlockFile, channel: int, before_ns: int) -> int | None:
    """Return the time of the last message of a channel before a time."""
    places = _newest_places(file, channel, before_ns - 1, 1, -(2**63))
    return max(places).time_ns if places else None


def add_counts(
    file: BlockFile, channel: int, edges_ns: Sequence[int], counts: NDArray[np.int64]
) -> None:
    """Add how many messages of a channel lie between each two of some times to `counts`.

    Args:
        file: The file.
        channel: One of its channels.
        edges_ns: Ascending; a part holds its first time, and not its last.
        counts: Shape (len(edges_ns) - 1,).
    """
    presence = file.table.presence.get(channel)
    if presence is None:
        return
    edges = np.array(edges_ns, np.int64)
    first = int(np.searchsorted(presence.ends_max_ns, edges_ns[0], "left"))
    last = int(np.searchsorted(presence.begins_ns, edges_ns[-1], "left"))
    for block in presence.blocks[first:last].tolist():
        times_ns = file.entries(block, channel).times_ns
        if not len(times_ns):
            continue
        # Only the parts that it reaches into: there may be thousands of blocks and of parts.
        begin, end = np.searchsorted(edges, (times_ns[0], times_ns[-1]), "right").tolist()
        begin, end = max(begin - 1, 0), min(end, len(counts))
        if begin < end:
            counts[begin:end] += np.diff(np.searchsorted(times_ns, edges[begin : end + 1], "left"))


def messages(
    file: BlockFile, channels: Mapping[int, Outline], begin_ns: int, end_ns: int
) -> Iterator[Recorded]:
    """Yield the messages of some channels in [begin, end), by time.

    Where blocks overlap in time, their messages are merged one by one, all others handed out as
    they lie. A block that ends with the very time at which the next begins does not overlap it:
    there a chunk was full between two messages of one time.
    """
    table = file.table
    blocks = _blocks_of(file, channels, begin_ns, end_ns)
    keep = len(blocks) <= _KEPT_BLOCKS_MAX
    waiting: list[_Waiting] = []
    for block, following in zip(blocks, [*blocks[1:], None], strict=False):
        until_ns = end_ns if following is None else int(table.begins_ns[following])
        alone: Iterable[Recorded] = ()
        if _held_bytes(waiting) < _HELD_BYTES_MAX:
            scan = file.scanned(block, channels, keep=keep)
            found = _in_order(table, block, scan.times_ns, (begin_ns, end_ns))
            if not waiting and (following is None or _is_before(table, block, following)):
                yield from scan.made(found)
                continue
            time_ns = scan.times_ns.__getitem__
            first = bisect_right(found, waiting[-1].place.time_ns, key=time_ns) if waiting else 0
            last = max(first, bisect_left(found, until_ns, key=time_ns))
            alone = scan.made(found[first:last])
            start = int(table.starts[block])
            waiting += [
                _Waiting(Place(time_ns(number), start, number, block, -1), one)
                for number in (*found[:first], *found[last:])
                for one in scan.made((number,))
            ]
        else:
            for key in channels:
                places = _in_block(file, key, block, (begin_ns, end_ns - 1), _ALL)
                waiting += [_Waiting(place) for place in places]
        waiting.sort()
        count = bisect_left(waiting, until_ns, key=lambda one: one.place.time_ns)
        yield from _each(file, waiting[:count], channels)
        del waiting[:count]
        yield from alone
    yield from _each(file, waiting, channels)


def _held_bytes(waiting: Sequence[_Waiting]) -> int:
    return sum(len(one.held.sample.payload) for one in waiting if one.held is not None)


def _is_before(table: BlockTable, block: int, following: int) -> bool:
    """Whether all messages of a block come before those of the one that follows it."""
    end_ns, begin_ns = table.ends_ns[block], table.begins_ns[following]
    return bool(
        end_ns < begin_ns or (end_ns == begin_ns and table.starts[block] < table.starts[following])
    )


def _blocks_of(
    file: BlockFile, channels: Mapping[int, Outline], begin_ns: int, end_ns: int
) -> list[int]:
    """Return the blocks that may hold messages of some channels in [begin, end)."""
    table = file.table
    is_in = np.zeros(len(table.begins_ns), np.bool_)
    for key in channels:
        if key in table.presence:
            is_in[table.presence[key].blocks] = True
    near = (table.begins_ns < end_ns) & (table.ends_ns >= begin_ns)
    return np.flatnonzero(is_in & near).tolist()


def _in_order(
    table: BlockTable, block: int, times_ns: Sequence[int], span_ns: tuple[int, int]
) -> Sequence[int]:
    """Return the numbers of a block's messages that lie in [begin, end), by time."""
    begin_ns, end_ns = span_ns
    numbers: Sequence[int] = range(len(times_ns))
    if table.begins_ns[block] < begin_ns or table.ends_ns[block] >= end_ns:
        numbers = [one for one in numbers if begin_ns <= times_ns[one] < end_ns]
    ordered = sorted(times_ns)
    return numbers if times_ns == ordered else sorted(numbers, key=times_ns.__getitem__)


def _each(
    file: BlockFile, waiting: Sequence[_Waiting], channels: Mapping[int, Outline]
) -> Iterator[Recorded]:
    for place, held in waiting:
        if held is not None:
            yield held
            continue
        outline = channels[place.channel]
        sample = file.sample(place.block, place.channel, place.place, outline.gid)
        if sample is not None:
            yield Recorded(outline.topic, sample)
