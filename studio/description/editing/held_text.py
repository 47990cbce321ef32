"""One file of an open document: as the disk has it, as it is now, and where the two differ."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.description.editing.changed_regions import ChangedRegions
from studio.description.editing.merging import hunks_between
from studio.description.editing.splice import apply_to, decode
from studio.description.editing.undo import Splice
from studio.description.values import Edit

if TYPE_CHECKING:
    from collections.abc import Iterable

    from studio.description.values import Span


class HeldText:
    """A file's bytes with the edits that the disk does not have."""

    __slots__ = ("disk", "file", "now", "regions")

    def __init__(self, file: str, disk: bytes) -> None:
        self.file, self.disk, self.now = file, disk, disk
        self.regions = ChangedRegions(disk)

    def apply(self, edits: Iterable[Edit]) -> tuple[Splice, ...]:
        """Apply edits one after the other and note what differs then; what each one did.

        Raises:
            EditError: An edit lies outside the text; those before it are applied.
        """
        text = bytearray(self.now)
        try:
            return tuple(self._apply(edit, text) for edit in edits)
        finally:
            self.now = bytes(text)

    def saved_at(self, span: Span) -> bytes | None:
        """What the disk has where `span` is now; None when a reload changed the file around it."""
        base = self.regions.base_span(span)
        return None if base is None else self.disk[base.start : base.end]

    def saved_text(self, span: Span) -> str | None:
        """What the disk says where `span` is now, when it says something else and can be told."""
        base = self.regions.base_span(span)
        if base is None:
            return None
        is_same = self.disk[base.start : base.end] == self.now[span.start : span.end]
        return None if is_same else decode(self.disk, base)

    def rebased(self, disk: bytes) -> HeldText:
        """The same text, with its differences counted against another text of the disk."""
        text = HeldText(self.file, disk)
        text.apply(edits_between(self.file, disk, self.now))
        return text

    def _apply(self, edit: Edit, text: bytearray) -> Splice:
        taken = apply_to(text, edit)
        self.regions.note(edit, text)
        return Splice(edit.file, edit.start, taken, edit.new)


def edits_between(file: str, old: bytes, new: bytes) -> tuple[Edit, ...]:
    """The edits from one text to the other, the last place first: so each one's offsets hold."""
    hunks = reversed(hunks_between(old, new))
    return tuple(Edit(file, hunk.start, hunk.end, hunk.new) for hunk in hunks)
