"""The sites of a document as the page knows them, and what the disk says at each."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from studio.description.values import SiteKind
from studio.documents.robot_view import site_view
from studio.errors import EditError
from studio.protocol.edits import Sites, SiteView

if TYPE_CHECKING:
    from collections.abc import Mapping
    from typing import TypeAlias

    from studio.description.editing.sources import Sources
    from studio.description.values import Expansion, Site

    _MadeOf: TypeAlias = tuple[Site, str | None, str | None]


class SiteBook:
    """Takes what a run changed and answers what the page has not yet been told."""

    def __init__(self) -> None:
        self.sites: dict[str, Site] = {}
        self._order: tuple[str, ...] = ()
        self._told: dict[str, SiteView] = {}
        self._told_of: dict[str, _MadeOf] = {}
        """What each view was made of: comparing is quick, and making thousands is not."""
        self._unsure: set[str] = set()
        self._order_is_news = False
        self._ahead: set[str] = set()
        """Sites told with a text that no good run has seen."""

    def take(self, expansion: Expansion) -> None:
        """Take in a good run."""
        self.sites |= {site.id: site for site in expansion.changed_sites}
        self._unsure.update(site.id for site in expansion.changed_sites)
        self._unsure |= self._ahead
        self._ahead.clear()
        if expansion.site_order is None or expansion.site_order == self._order:
            return
        self._order, self._order_is_news = expansion.site_order, True
        self.sites = {name: self.sites[name] for name in self._order if name in self.sites}
        self._told = {name: view for name, view in self._told.items() if name in self.sites}
        self._told_of = {name: self._told_of[name] for name in self._told}

    def take_failure(self, sources: Sources) -> None:
        """A run failed: the texts as they stand in edited files are news, the values are not."""
        unsaved = set(sources.unsaved_files)
        for name, site in self.sites.items():
            if name in self._ahead or (
                site.place.file in unsaved and _text_now(site, sources) != site.text
            ):
                self._ahead.add(name)
        self._unsure |= self._ahead

    def doubt_all(self) -> None:
        """Compare every site at the next `news`: a save, a reload or an argument came between."""
        self._unsure.update(self.sites)

    def news(self, sources: Sources) -> Sites | None:
        """What differs from what was told; None when nothing does."""
        arguments = sources.arguments
        changed: list[SiteView] = []
        for name in self._unsure & self.sites.keys():
            site = self.sites[name]
            if name in self._ahead:
                site = replace(site, text=_text_now(site, sources))
            made_of = _made_of(site, sources, arguments)
            if made_of == self._told_of.get(name):
                continue
            self._told_of[name], view = made_of, site_view(*made_of)
            if view != self._told.get(name):
                self._told[name] = view
                changed.append(view)
        order = self._order if self._order_is_news else None
        self._unsure.clear()
        self._order_is_news = False
        return Sites(order=order, changed=tuple(changed)) if changed or order is not None else None

    def everything(self) -> Sites:
        """All sites as they were told, for a newcomer."""
        return Sites(order=self._order, changed=tuple(self._told.values()))


def _made_of(site: Site, sources: Sources, arguments: Mapping[str, str]) -> _MadeOf:
    argument = arguments.get(site.name) if site.kind == SiteKind.ARG else None
    return site, _saved_text(site, sources), argument


def _saved_text(site: Site, sources: Sources) -> str | None:
    try:
        return sources.saved_text(site.id)
    except EditError:
        return None  # typed over since the last run, which the next one tells


def _text_now(site: Site, sources: Sources) -> str:
    try:
        return sources.current_text(site.id)
    except EditError:
        return site.text  # as above
