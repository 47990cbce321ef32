"""Positions of spans after edits: in the text as it began, and as it is now."""

from __future__ import annotations

import re
from bisect import bisect_left
from dataclasses import dataclass, replace
from itertools import accumulate
from typing import TYPE_CHECKING, Final

from studio.description.values import SiteKind, Span
from studio.errors import StaleEditError

if TYPE_CHECKING:
    from collections.abc import Iterable

    from studio.description.values import Edit, Site

_QUOTES: Final = {'"': b'"', "'": b"'"}
"""The quotes that end an attribute, just outside the span."""
_ONE_VALUE: Final = re.compile(rb"[\w.+-]+", re.ASCII)
"""One whole value, in YAML and among the parameters of a macro."""


@dataclass(frozen=True, slots=True)
class Region:
    """Other bytes, `growth` more of them, now stand where [base_start, base_end) stood."""

    base_start: int
    base_end: int
    growth: int


class ChangedRegions:
    """The regions of one text that differ from its base: disjoint, in order.

    A region does not store its present place: an edit above thousands of them would move them all.
    It follows from those above it, counted from the last place that was computed.
    """

    def __init__(self, base: bytes) -> None:
        self._base = base
        self._regions: list[Region] = []
        self._at = self._shift = 0
        """A place in the list, and how much the regions above it have grown together."""

    def __len__(self) -> int:
        """Return the number of regions."""
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
        """All regions, in order."""
        return tuple(self._regions)

    def base_span(self, span: Span) -> Span | None:
        """Return a span in the base; None when a region cuts across an end of it."""
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
        """Return the regions that meet [start, end) or an end of it, from `_at` on."""
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


@dataclass(frozen=True, slots=True)
class _Noted:
    """An edit, the version that it led to, and the site that it wrote, if it was made for one."""

    version: int
    edit: Edit
    site: str = ""

    def moved(self, name: str, span: Span | None) -> Span | None:
        """Return the span of a site after it; None when that is not sure."""
        if span is None:
            return None
        edit = self.edit
        if name == self.site and (edit.start, edit.end) == (span.start, span.end):
            return replace(span, end=span.start + len(edit.new))
        return moved(span, edit)


def _moved_by_each(name: str, span: Span | None, notes: Iterable[_Noted]) -> Span | None:
    for noted in notes:
        span = noted.moved(name, span)
    return span


class _Shifts:
    """How far successive edits of one file move what none of them touched."""

    def __init__(self, notes: Iterable[_Noted]) -> None:
        changed = ChangedRegions(b"")
        for noted in notes:
            changed.note(noted.edit, None)
        self._regions = changed.regions
        self._ends = [one.base_end for one in self._regions]
        self._shifts = [0, *accumulate(one.growth for one in self._regions)]

    def of(self, span: Span) -> int | None:
        """Return by how many bytes; None: an edit touched the span or an end of it."""
        at = bisect_left(self._ends, span.start)
        if at < len(self._regions) and self._regions[at].base_start <= span.end:
            return None
        return self._shifts[at]


class SpanTable:
    """The sites of the last good run, and the edits since, which move their spans.

    `version` counts the edits noted so far. Who sends edits off for a run keeps the version of
    that moment, and gives it back with the run's sites: later edits then still count.
    """

    def __init__(self) -> None:
        self.version = 0
        self._sites: dict[str, Site] = {}
        self._spans: dict[str, dict[str, Span | None]] = {}
        """By file, the spans of its sites at the last good run; None: an edit cut across one."""
        self._since: list[_Noted] = []
        self._shifts: dict[str, tuple[list[_Noted], _Shifts]] = {}
        """By file, the edits since, and how far they move what they did not touch."""

    def adopt(self, changed: Iterable[Site], order: Iterable[str] | None, version: int) -> None:
        """Take over a run's sites: `changed` and `order` as in `Expansion`, true at `version`.

        Those that are not among `changed` moved with the edits until then.
        """
        by_file: dict[str, list[_Noted]] = {}
        for noted in self._since:
            if noted.version <= version:
                by_file.setdefault(noted.edit.file, []).append(noted)
        for file, notes in by_file.items():
            self._move(self._spans.get(file, {}), notes)
        for site in changed:
            self._sites[site.id] = site
            self._spans.setdefault(site.place.file, {})[site.id] = site.span
        if order is not None:
            self._keep_only(set(order))
        self._since = [noted for noted in self._since if noted.version > version]
        self._shifts.clear()

    def _move(self, spans: dict[str, Span | None], notes: list[_Noted]) -> None:
        """Move the sites of a file to where edits left them."""
        shifts = _Shifts(notes)
        for name, span in spans.items():
            if span is None:
                continue
            shift = shifts.of(span)
            if shift is None:
                spans[name] = _moved_by_each(name, span, notes)
            elif shift:
                spans[name] = Span(span.start + shift, span.end + shift, span.syntax)

    def _keep_only(self, wanted: set[str]) -> None:
        self._sites = {one: site for one, site in self._sites.items() if one in wanted}
        for file, spans in self._spans.items():
            self._spans[file] = {one: span for one, span in spans.items() if one in wanted}

    def note(self, edits: Iterable[Edit]) -> int:
        """Note edits that were applied, in order; the version that they lead to."""
        self._shifts.clear()
        for edit in edits:
            self.version += 1
            self._since.append(_Noted(self.version, edit))
        return self.version

    @property
    def numbers(self) -> tuple[str, ...]:
        """Ids of the attributes of URDF elements among the sites."""
        return tuple(name for name, one in self._sites.items() if one.kind is SiteKind.LITERAL)

    def wrote(self, site_id: str) -> None:
        """Note that the last edit wrote a site's text as its place spells it."""
        self._since[-1] = replace(self._since[-1], site=site_id)
        self._shifts.clear()

    def site(self, site_id: str) -> Site:
        """Return a site as the last run had it.

        Raises:
            StaleEditError: The last run had no such site.
        """
        site = self._sites.get(site_id)
        if site is None:
            raise StaleEditError(site_id)
        span = self._spans[site.place.file][site_id]
        if span is not None and span is not site.span:
            site = self._sites[site_id] = replace(site, span=span)
        return site

    def span(self, site_id: str) -> Span:
        """Return a site's present span: its own edits stretch it, those before it move it.

        Raises:
            StaleEditError: There is no such site, or only the next run can find it.
        """
        file = self.site(site_id).place.file
        span = self._spans[file][site_id]
        if span is not None and self._since:
            notes, shifts = self._since_in(file)
            shift = shifts.of(span)
            if shift is None:
                span = _moved_by_each(site_id, span, notes)
            elif shift:
                span = Span(span.start + shift, span.end + shift, span.syntax)
        if span is None:
            raise StaleEditError(site_id)
        return span

    def _since_in(self, file: str) -> tuple[list[_Noted], _Shifts]:
        known = self._shifts.get(file)
        if known is None:
            notes = [one for one in self._since if one.edit.file == file]
            known = self._shifts[file] = (notes, _Shifts(notes))
        return known


def moved(span: Span, edit: Edit) -> Span | None:
    """Return a span after an edit of its file; None when another text may stand there now.

    That is so when the edit touched an end of it, or what ends it, or wrote something into it that
    may end it earlier. An edit of a part of it, or of all, otherwise stretches it.
    """
    growth = len(edit.new) - (edit.end - edit.start)
    if span.start <= edit.start and edit.end <= span.end:
        is_whole = _is_one_text(span, edit)
        return Span(span.start, span.end + growth, span.syntax) if is_whole else None
    if edit.end < span.start:
        return Span(span.start + growth, span.end + growth, span.syntax)
    return span if edit.start > span.end else None


def _is_one_text(span: Span, edit: Edit) -> bool:
    """Whether an edit within a span leaves it what it is: one text from end to end."""
    quote = _QUOTES.get(span.syntax)
    if quote is not None:
        return quote not in edit.new
    is_all = (edit.start, edit.end) == (span.start, span.end)
    return is_all and _ONE_VALUE.fullmatch(edit.new) is not None
