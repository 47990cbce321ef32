"""What differs between two texts, as stretches of lines that a person reads."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, TypeAlias

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

LineKind: TypeAlias = Literal["same", "old", "new"]


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
    """All differences counted, of their lines the first `limit` kept."""
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
