"""Which stretches of a text differ from the text it began as, and where they were there."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from studio.description.values import Edit, Span


@dataclass(frozen=True, slots=True)
class Region:
    """Other bytes, `growth` more of them, now stand where [base_start, base_end) stood."""

    base_start: int
    base_end: int
    growth: int


class ChangedRegions:
    """The regions of one text against its base: disjoint, in order, each really different.

    A region does not say where it stands now: an edit above thousands of them would move them all.
    It follows from those above it, counted on from the place that was looked at last.
    """

    def __init__(self, base: bytes) -> None:
        self._base = base
        self._regions: list[Region] = []
        self._at = self._shift = 0
        """A place in the list, and how much the regions above it have grown together."""

    def __len__(self) -> int:
        """How many there are."""
        return len(self._regions)

    def note(self, edit: Edit, text: bytes | bytearray | None) -> None:
        """Take in an edit that made `text`; what it brought back to the base is no region.

        Without a text no region goes again.
        """
        touched = self._touched(edit.start, edit.end)
        start, end, shift = edit.start, edit.end, self._shift
        growth = sum(one.growth for one in touched)
        if touched:
            start = min(start, touched[0].base_start + shift)
            end = max(end, touched[-1].base_end + shift + growth)
        merged = Region(
            start - shift, end - shift - growth, growth + len(edit.new) - (edit.end - edit.start)
        )
        end = merged.base_end + shift + merged.growth
        base = self._base[merged.base_start : merged.base_end]
        is_back = text is not None and base == text[start:end]
        self._regions[self._at : self._at + len(touched)] = [] if is_back else [merged]

    @property
    def regions(self) -> tuple[Region, ...]:
        """All of them, in order."""
        return tuple(self._regions)

    def base_span(self, span: Span) -> Span | None:
        """Where a span stood in the base; None when a region cuts across an end of it."""
        touched = self._touched(span.start, span.end)
        growth = sum(one.growth for one in touched)
        if touched:
            first, last = touched[0], touched[-1]
            is_cut = first.base_start + self._shift < span.start
            if is_cut or last.base_end + self._shift + growth > span.end:
                return None
        start = span.start - self._shift
        return replace(span, start=start, end=start + (span.end - span.start) - growth)

    def _touched(self, start: int, end: int) -> list[Region]:
        """The regions that meet [start, end) or an end of it, from `_at` on."""
        self._seek(start)
        touched: list[Region] = []
        shift = self._shift
        for at in range(self._at, len(self._regions)):
            one = self._regions[at]
            if one.base_start + shift > end:
                break
            touched.append(one)
            shift += one.growth
        return touched

    def _seek(self, start: int) -> None:
        """Go to the first region that ends at or behind a place."""
        regions = self._regions
        while self._at > 0 and regions[self._at - 1].base_end + self._shift >= start:
            self._at -= 1
            self._shift -= regions[self._at].growth
        while self._at < len(regions):
            one = regions[self._at]
            if one.base_end + self._shift + one.growth >= start:
                return
            self._at += 1
            self._shift += one.growth
