"""Merges three texts: as read from the disk, as edited here, and as it is on disk now.

Both sides keep their changes, to the byte. Two changes collide when they touch the same token, the
text between blanks, quotes and brackets, so that no number is put together of halves of two.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from difflib import SequenceMatcher
from typing import TYPE_CHECKING, Final, Literal, TypeAlias

from studio.description.editing.edits import common_start

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

Side: TypeAlias = Literal["mine", "theirs"]

_LINES_COMPARED: Final = 4000
"""With more lines between the first and the last difference, all of them are one change."""
_TOKEN: Final = re.compile(rb"[^\s\"'<>=,\[\]{}]*")
_TOKEN_BACKWARDS_LIMIT: Final = 1000


@dataclass(frozen=True, slots=True)
class Hunk:
    """Replaces bytes [start, end) of the text before by `new`."""

    start: int
    end: int
    new: bytes


@dataclass(frozen=True, slots=True)
class Place:
    """Bytes [start, end) of the base that at least one side changed, and what each has there."""

    start: int
    end: int
    mine: bytes
    theirs: bytes


@dataclass(frozen=True, slots=True)
class Merge:
    """All changes of both sides, in order, and those that collide."""

    base: bytes
    places: tuple[Place, ...]
    collisions: tuple[Place, ...]
    kept: int
    """Number of places with a change of mine alone."""

    def text(self, wins: Side = "mine", each: Sequence[Side] = ()) -> bytes:
        """Return both sides' changes; at a collision those of the winner.

        `each` names the winners of the first collisions, in their order; `wins` has the others.
        """
        winners = dict(zip(self.collisions, each, strict=False))
        chosen = (self._chosen(place, winners.get(place, wins)) for place in self.places)
        return patched(self.base, chosen)

    def _chosen(self, place: Place, wins: Side) -> Hunk:
        base = self.base[place.start : place.end]
        if place in self.collisions:
            return Hunk(place.start, place.end, place.mine if wins == "mine" else place.theirs)
        return Hunk(place.start, place.end, place.theirs if place.mine == base else place.mine)


def merge(base: bytes, mine: bytes, theirs: bytes) -> Merge:
    """Put together what two sides made of a text."""
    ours, others = hunks_between(base, mine), hunks_between(base, theirs)
    places = tuple(
        Place(start, end, _made_of(base, start, end, ours), _made_of(base, start, end, others))
        for start, end in _extents(base, [*ours, *others])
    )
    collisions = tuple(one for one in places if _collides(one, base))
    kept = sum(one.mine not in {base[one.start : one.end], one.theirs} for one in places)
    return Merge(base, places, collisions, kept - len(collisions))


def hunks_between(old: bytes, new: bytes) -> list[Hunk]:
    """Return what leads from `old` to `new`: in order, none overlapping, split by lines."""
    if old == new:
        return []
    # Only what is between the first and the last difference is compared closely.
    start = old.rfind(b"\n", 0, common_start(old, new)) + 1
    tail = common_start(old[start:][::-1], new[start:][::-1])
    before, after = old[start : len(old) - tail], new[start : len(new) - tail]
    return [
        Hunk(start + hunk.start, start + hunk.end, hunk.new) for hunk in _line_hunks(before, after)
    ]


def patched(old: bytes, hunks: Iterable[Hunk]) -> bytes:
    """Return the text that hunks lead to; they are in order, none overlapping."""
    parts: list[bytes] = []
    at = 0
    for hunk in hunks:
        parts += [old[at : hunk.start], hunk.new]
        at = hunk.end
    return b"".join((*parts, old[at:]))


def _line_hunks(old: bytes, new: bytes) -> Iterator[Hunk]:
    before, after = old.splitlines(keepends=True), new.splitlines(keepends=True)
    if max(len(before), len(after)) > _LINES_COMPARED:
        yield from _trimmed(0, old, new)
        return
    starts = [0]
    for line in before:
        starts.append(starts[-1] + len(line))
    for tag, i1, i2, j1, j2 in SequenceMatcher(None, before, after).get_opcodes():
        if tag == "equal":
            continue
        if i2 - i1 == j2 - j1:
            for i, j in zip(range(i1, i2), range(j1, j2), strict=True):
                yield from _trimmed(starts[i], before[i], after[j])
        else:
            yield from _trimmed(starts[i1], old[starts[i1] : starts[i2]], b"".join(after[j1:j2]))


def _trimmed(at: int, old: bytes, new: bytes) -> Iterator[Hunk]:
    """Yield one hunk without what both begin and end with; none when they are equal."""
    if old == new:
        return
    start = common_start(old, new)
    end = common_start(old[start:][::-1], new[start:][::-1])
    yield Hunk(at + start, at + len(old) - end, new[start : len(new) - end])


def _extents(base: bytes, hunks: list[Hunk]) -> Iterator[tuple[int, int]]:
    """Yield the stretches of the base that hunks touch, in whole tokens, those that meet joined."""
    begun: tuple[int, int] | None = None
    for start, end in sorted(_widened(base, hunk) for hunk in hunks):
        if begun is not None and start <= begun[1]:
            begun = begun[0], max(begun[1], end)
            continue
        if begun is not None:
            yield begun
        begun = start, end
    if begun is not None:
        yield begun


def _widened(base: bytes, hunk: Hunk) -> tuple[int, int]:
    behind = _TOKEN.match(base, hunk.end)
    before = _TOKEN.match(base[max(0, hunk.start - _TOKEN_BACKWARDS_LIMIT) : hunk.start][::-1])
    return hunk.start - (before.end() if before else 0), behind.end() if behind else hunk.end


def _made_of(base: bytes, start: int, end: int, hunks: list[Hunk]) -> bytes:
    """Apply hunks, none of which crosses an end of it, to a stretch of the base."""
    inside = [
        Hunk(hunk.start - start, hunk.end - start, hunk.new)
        for hunk in hunks
        if start <= hunk.start and hunk.end <= end
    ]
    return patched(base[start:end], inside)


def _collides(place: Place, base: bytes) -> bool:
    old = base[place.start : place.end]
    return old not in {place.mine, place.theirs} and place.mine != place.theirs
