"""Which stretches of a text differ from the text it began as, and where they were there."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from studio.description.values import Edit, Span


@dataclass(frozen=True, slots=True)
class Region:
    """Bytes [start, end) now stand where [base_start, base_end) stood."""

    base_start: int
    base_end: int
    start: int
    end: int

    @property
    def growth(self) -> int:
        """How many bytes longer it is now."""
        return (self.end - self.start) - (self.base_end - self.base_start)

    def shifted(self, by: int) -> Region:
        """The same region, `by` bytes further down in the text as it is now."""
        return replace(self, start=self.start + by, end=self.end + by)


class ChangedRegions:
    """The regions of one text against its base: disjoint, in order, each really different."""

    def __init__(self, base: bytes) -> None:
        self._base = base
        self._regions: tuple[Region, ...] = ()

    def __len__(self) -> int:
        """How many there are."""
        return len(self._regions)

    def note(self, edit: Edit, text: bytes) -> None:
        """Take in an edit that made `text`; what it brought back to the base is no region."""
        growth = len(edit.new) - (edit.end - edit.start)
        before = [one for one in self._regions if one.end < edit.start]
        behind = [one for one in self._regions if one.start > edit.end]
        touched = self._regions[len(before) : len(self._regions) - len(behind)]
        shift = sum(one.growth for one in before)
        start = min([edit.start, *(one.start for one in touched)])
        end = max([edit.end, *(one.end for one in touched)])
        base_end = end - shift - sum(one.growth for one in touched)
        merged = Region(start - shift, base_end, start, end + growth)
        is_back = self._base[merged.base_start : base_end] == text[start : merged.end]
        kept = [] if is_back else [merged]
        self._regions = (*before, *kept, *(one.shifted(growth) for one in behind))

    def base_span(self, span: Span) -> Span | None:
        """Where a span stood in the base; None when a region cuts across an end of it."""
        before = [one for one in self._regions if one.end < span.start]
        touched = [one for one in self._regions if one.end >= span.start and one.start <= span.end]
        if any(one.start < span.start or one.end > span.end for one in touched):
            return None
        start = span.start - sum(one.growth for one in before)
        growth = sum(one.growth for one in touched)
        return replace(span, start=start, end=start + (span.end - span.start) - growth)
