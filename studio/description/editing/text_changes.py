"""What changed between two states of a text, in few small pieces: for editors that follow it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from studio.description.editing.splice import common_start

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator


@dataclass(frozen=True, slots=True)
class Piece:
    """In the text before, characters [start, end) give way to `text`."""

    start: int
    end: int
    text: str


def changes_between(old: str, new: str) -> tuple[Piece, ...]:
    """The pieces that lead from `old` to `new`, in order, none touching another.

    A single stretch, except where as many lines stood there before: then each changed line alone,
    so that what stands between them stays in place.
    """
    if old == new:
        return ()
    # Only what lies between the first and the last difference is looked at closely.
    start = old.rfind("\n", 0, common_start(old, new)) + 1
    end = common_start(old[start:][::-1], new[start:][::-1])
    before, after = old[start : len(old) - end], new[start : len(new) - end]
    if before.count("\n") == after.count("\n"):
        return tuple(_line_by_line(before.split("\n"), after.split("\n"), start))
    return (_one_piece(before, after, start),)


def patched(old: str, pieces: Iterable[Piece]) -> str:
    """The text that the pieces lead to; in order, none overlapping."""
    parts: list[str] = []
    at = 0
    for piece in pieces:
        parts += [old[at : piece.start], piece.text]
        at = piece.end
    return "".join((*parts, old[at:]))


def _line_by_line(before: list[str], after: list[str], at: int) -> Iterator[Piece]:
    for old, new in zip(before, after, strict=True):
        if old != new:
            yield _one_piece(old, new, at)
        at += len(old) + 1


def _one_piece(old: str, new: str, offset: int) -> Piece:
    start = common_start(old, new)
    end = common_start(old[start:][::-1], new[start:][::-1])
    return Piece(offset + start, offset + len(old) - end, new[start : len(new) - end])
