"""One file of an open document: as the disk has it, as it is now, and where the two differ."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.description.editing.changed_regions import ChangedRegions
from studio.description.editing.merging import hunks_between
from studio.description.editing.splice import apply
from studio.description.values import Edit

if TYPE_CHECKING:
    from studio.description.values import Span


class HeldText:
    """A file's bytes with the edits that the disk does not have."""

    __slots__ = ("disk", "file", "now", "regions")

    def __init__(self, file: str, disk: bytes) -> None:
        self.file, self.disk, self.now = file, disk, disk
        self.regions = ChangedRegions(disk)

    def apply(self, edit: Edit) -> None:
        """Apply an edit and note what differs then."""
        self.now = apply(self.now, (edit,))
        self.regions.note(edit, self.now)

    def saved_at(self, span: Span) -> bytes | None:
        """What the disk has where `span` is now; None when a reload changed the file around it."""
        base = self.regions.base_span(span)
        return None if base is None else self.disk[base.start : base.end]

    def rebased(self, disk: bytes) -> HeldText:
        """The same text, with its differences counted against another text of the disk."""
        text = HeldText(self.file, disk)
        for edit in edits_between(self.file, disk, self.now):
            text.apply(edit)
        return text


def edits_between(file: str, old: bytes, new: bytes) -> tuple[Edit, ...]:
    """The edits from one text to the other, the last place first: so each one's offsets hold."""
    hunks = reversed(hunks_between(old, new))
    return tuple(Edit(file, hunk.start, hunk.end, hunk.new) for hunk in hunks)
