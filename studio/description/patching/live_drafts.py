"""The drafts of a file while its texts are edited in place: what they say, where they stand."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from studio.description.values import Span
from studio.problems import Place

if TYPE_CHECKING:
    from collections.abc import Mapping

    from studio.description.sites.drafts import Draft, FileDrafts
    from studio.description.values import Edit


class LiveDrafts:
    """Follows the edits of one file, each inside one draft and on its line."""

    def __init__(self, file: FileDrafts) -> None:
        self._drafts = list(file.drafts)
        self._starts = [one.span.start for one in file.drafts]
        self._ends = [one.span.end for one in file.drafts]
        self.index_of = {draft.id: index for index, draft in enumerate(file.drafts)}
        self.has_aliases = bool(file.aliases)

    def find(self, edit: Edit) -> int | None:
        """The draft that an edit lies in."""
        for index, (start, end) in enumerate(zip(self._starts, self._ends, strict=True)):
            if start <= edit.start and edit.end <= end:
                return index
        return None

    def draft(self, index: int) -> Draft:
        """A draft as it stands now."""
        draft = self._drafts[index]
        start, end = self._starts[index], self._ends[index]
        if (draft.span.start, draft.span.end) != (start, end):
            draft = self._drafts[index] = replace(draft, span=Span(start, end, draft.span.syntax))
        return draft

    def written(self, site: str) -> Draft:
        """A draft as it is now by its id, but for its span."""
        return self._drafts[self.index_of[site]]

    def by_id(self, site: str) -> Draft:
        """A draft as it stands now, by its id."""
        return self.draft(self.index_of[site])

    def take(self, index: int, edit: Edit, text: str) -> None:
        """Write another text at a draft; those behind it move."""
        growth = len(edit.new) - (edit.end - edit.start)
        start, end = self._starts[index], self._ends[index]
        self._drafts[index] = self._drafts[index].rewritten(text)
        if growth:
            self._starts = [at + growth if at >= end else at for at in self._starts]
            self._ends = [at + growth if at > end else at for at in self._ends]
            self._starts[index], self._ends[index] = start, end + growth

    def move_yaml(self, index: int, growth: int) -> list[str]:
        """Shift the columns of what stands behind a draft on its line; the ids of what moved."""
        at, line = self._starts[index], self._drafts[index].place.line
        behind = (n for n, one in enumerate(self._drafts) if one.place.line == line)
        moved = [n for n in behind if self._starts[n] > at]
        for number in moved:
            place = self._drafts[number].place
            self._place(number, Place(place.file, line, place.column + growth))
        return [self._drafts[number].id for number in moved]

    def move_elements(self, places: Mapping[int, Place]) -> list[str]:
        """Put drafts where their elements are now, by ordinal; the ids of what moved."""
        moved = [number for number, one in enumerate(self._drafts) if one.ordinal in places]
        for number in moved:
            self._place(number, places[self._drafts[number].ordinal])
        return [self._drafts[number].id for number in moved]

    def _place(self, index: int, place: Place) -> None:
        self._drafts[index] = replace(self._drafts[index], place=place)
