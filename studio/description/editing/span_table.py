"""Where each site stands now, between the run that told its place and the next one."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from studio.description.values import Span
from studio.errors import StaleEditError

if TYPE_CHECKING:
    from collections.abc import Iterable

    from studio.description.values import Edit, Site


class SpanTable:
    """The sites of the last good run, and the edits since, which move their spans.

    `version` counts the edits noted so far. Who sends edits off for a run keeps the version of
    that moment, and gives it back with the run's sites: later edits then still count.
    """

    def __init__(self) -> None:
        self.version = 0
        self._sites: dict[str, Site] = {}
        self._spans: dict[str, dict[str, Span]] = {}
        """By file, where its sites were at the last good run."""
        self._since: list[tuple[int, Edit]] = []

    def adopt(self, changed: Iterable[Site], order: Iterable[str] | None, version: int) -> None:
        """Take over a run's sites: `changed` and `order` as in `Expansion`, true at `version`.

        Those that are not among `changed` moved with the edits until then.
        """
        for at, edit in self._since:
            if at <= version:
                self._move(edit)
        for site in changed:
            self._sites[site.id] = site
            self._spans.setdefault(site.place.file, {})[site.id] = site.span
        if order is not None:
            self._keep_only(set(order))
        self._since = [(at, edit) for at, edit in self._since if at > version]

    def _move(self, edit: Edit) -> None:
        """Have the sites of a file stand where an edit left them."""
        spans = self._spans.get(edit.file)
        if spans and len(edit.new) != edit.end - edit.start:
            for name, span in spans.items():
                if span.end >= edit.start:
                    spans[name] = moved(span, edit) or span

    def _keep_only(self, wanted: set[str]) -> None:
        self._sites = {one: site for one, site in self._sites.items() if one in wanted}
        for file, spans in self._spans.items():
            self._spans[file] = {one: span for one, span in spans.items() if one in wanted}

    def note(self, edits: Iterable[Edit]) -> int:
        """Note edits that were applied, in order; the version that they lead to."""
        for edit in edits:
            self.version += 1
            self._since.append((self.version, edit))
        return self.version

    def site(self, site_id: str) -> Site:
        """A site as the last run had it.

        Raises:
            StaleEditError: The last run had no such site.
        """
        site = self._sites.get(site_id)
        if site is None:
            raise StaleEditError(site_id)
        span = self._spans[site.place.file][site_id]
        if span is not site.span:
            site = self._sites[site_id] = replace(site, span=span)
        return site

    def span(self, site_id: str) -> Span:
        """Where a site stands now: its own edits stretch it, those before it in its file move it.

        Raises:
            StaleEditError: There is no such site, or an edit cut across its ends.
        """
        site = self.site(site_id)
        span: Span | None = site.span
        for _, edit in self._since:
            if edit.file == site.place.file:
                span = moved(span, edit)
                if span is None:
                    raise StaleEditError(site_id)
        return span


def moved(span: Span, edit: Edit) -> Span | None:
    """A span after an edit of its file; None when the edit cut across an end of it.

    An edit of exactly the span or of a part inside it stretches it, also when the span is empty.
    """
    growth = len(edit.new) - (edit.end - edit.start)
    if span.start <= edit.start and edit.end <= span.end:
        return Span(span.start, span.end + growth, span.syntax)
    if edit.end <= span.start:
        return Span(span.start + growth, span.end + growth, span.syntax)
    return span if edit.start >= span.end else None
