"""What an edit of a package changes: new files, changed spans, and what is left by hand."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from studio.problems import NewFile, Replacement


@dataclass(frozen=True, slots=True)
class PackageEdit:
    """All that one new thing of a package takes, as one undo step.

    Attributes:
        label: Names it in the undo history: `New node talker`.
        opened: The new file that a person wants to see first.
        new_files: Files that are not there yet.
        edits: Changes of files that are there, in the order of file and place, none overlapping.
        by_hand: Sentences: what was not written, because a file is not as it can be edited safely,
            with the lines to write.
    """

    label: str
    opened: str
    new_files: tuple[NewFile, ...] = ()
    edits: tuple[Replacement, ...] = ()
    by_hand: tuple[str, ...] = ()
