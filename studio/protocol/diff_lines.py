"""The lines of a difference, in whichever message it is told."""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING, Literal

from studio.protocol.message import Message

if TYPE_CHECKING:
    from studio.description.editing.line_diff import LineDiff


class DiffLineView(Message):
    """A line with its numbers from 1 in the text before and after, where it is in them."""

    kind: Literal["same", "old", "new"]
    before: int | None
    after: int | None
    text: str


def hunk_views(diff: LineDiff) -> tuple[tuple[DiffLineView, ...], ...]:
    """The stretches of lines of a difference."""
    return tuple(tuple(DiffLineView(**asdict(line)) for line in hunk) for hunk in diff.hunks)
