"""Differences of two texts, line by line, for a person to read."""

from __future__ import annotations

from dataclasses import dataclass
from difflib import SequenceMatcher
from typing import TYPE_CHECKING, Final, Literal, TypeAlias

from studio.description.editing.editor_text import EditorText

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

LineKind: TypeAlias = Literal["same", "old", "new"]
LINES_SHOWN: Final = 1500
"""Limit for one file; nobody reads more."""
_LINES_COMPARED: Final = 4000
"""With more lines between the first and the last difference, all of them are one change."""
_AROUND: Final = 3
_LETTERS_SHOWN: Final = 1000


@dataclass(frozen=True, slots=True)
class DiffLine:
    """A line with its numbers from 1 in the text before and after; None: it is not in that one."""

    kind: LineKind
    before: int | None
    after: int | None
    text: str


@dataclass(frozen=True, slots=True)
class LineDiff:
    """Stretches of lines that differ, each with a few lines around it."""

    added: int = 0
    removed: int = 0
    hunks: tuple[tuple[DiffLine, ...], ...] = ()
    left_out: int = 0
    """Lines of further hunks, which are not among them."""


def line_diff(hunks: Sequence[tuple[DiffLine, ...]], limit: int) -> LineDiff:
    """Return the first `limit` lines of all differences, and the count of all."""
    kinds = [line.kind for hunk in hunks for line in hunk]
    shown = tuple(_cut(hunks, limit))
    return LineDiff(
        added=kinds.count("new"),
        removed=kinds.count("old"),
        hunks=shown,
        left_out=len(kinds) - sum(map(len, shown)),
    )


def _cut(hunks: Iterable[tuple[DiffLine, ...]], limit: int) -> Iterator[tuple[DiffLine, ...]]:
    left = limit
    for hunk in hunks:
        if left <= 0:
            return
        yield hunk[:left]
        left -= len(hunk)


def file_diff(before: bytes, after: bytes) -> LineDiff:
    """Compare two texts of one file, in whichever encoding each is."""
    old, new = _lines(before), _lines(after)
    return line_diff([tuple(_drawn(group, old, new)) for group in _groups(old, new)], LINES_SHOWN)


def _lines(data: bytes) -> list[str]:
    lines = EditorText(data).text.split("\n")
    return lines if lines[-1] else lines[:-1]


@dataclass(frozen=True, slots=True)
class _Change:
    """Replaces lines [start, end) of the text before by [into, into_end) of the one after."""

    start: int
    end: int
    into: int
    into_end: int


def _groups(old: Sequence[str], new: Sequence[str]) -> list[list[_Change]]:
    """Return the changes, those that stand near each other in one group."""
    groups: list[list[_Change]] = []
    for change in _changes(old, new):
        if groups and change.start - groups[-1][-1].end <= 2 * _AROUND:
            groups[-1].append(change)
        else:
            groups.append([change])
    return groups


def _changes(old: Sequence[str], new: Sequence[str]) -> Iterator[_Change]:
    start, end = _alike(old, new)
    before, after = old[start : len(old) - end], new[start : len(new) - end]
    if max(len(before), len(after)) > _LINES_COMPARED:
        yield _Change(start, len(old) - end, start, len(new) - end)
        return
    for tag, i, j, k, m in SequenceMatcher(None, before, after).get_opcodes():
        if tag != "equal":
            yield _Change(start + i, start + j, start + k, start + m)


def _alike(old: Sequence[str], new: Sequence[str]) -> tuple[int, int]:
    """Return how many lines both begin with, and how many of the rest both end with."""
    shorter = min(len(old), len(new))
    start = next((at for at in range(shorter) if old[at] != new[at]), shorter)
    left = shorter - start
    end = next((at for at in range(left) if old[-1 - at] != new[-1 - at]), left)
    return start, end


def _drawn(group: list[_Change], old: Sequence[str], new: Sequence[str]) -> Iterator[DiffLine]:
    at = max(0, group[0].start - _AROUND)
    for change in group:
        yield from _same(old, at, change.start, change.into - change.start)
        for line in range(change.start, change.end):
            yield DiffLine("old", line + 1, None, old[line][:_LETTERS_SHOWN])
        for line in range(change.into, change.into_end):
            yield DiffLine("new", None, line + 1, new[line][:_LETTERS_SHOWN])
        at = change.end
    end, last = min(len(old), at + _AROUND), group[-1]
    yield from _same(old, at, end, last.into_end - last.end)


def _same(old: Sequence[str], start: int, end: int, further: int) -> Iterator[DiffLine]:
    """Yield lines that both have, in the text after so many lines further down."""
    for at in range(start, end):
        yield DiffLine("same", at + 1, at + further + 1, old[at][:_LETTERS_SHOWN])
