"""The sites of a document as the page knows them, and what the disk says at each."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.description.values import SiteKind
from studio.engine.messages import Sites, SiteView
from studio.engine.views import site_view

if TYPE_CHECKING:
    from collections.abc import Mapping

    from studio.description.sources import Sources
    from studio.description.values import Expansion, Site


class SiteBook:
    """Takes what a run changed and answers what the page has not yet been told."""

    def __init__(self) -> None:
        self.sites: dict[str, Site] = {}
        self._order: tuple[str, ...] = ()
        self._told: dict[str, SiteView] = {}
        self._unsure: set[str] = set()
        self._order_is_news = False

    def take(self, expansion: Expansion) -> None:
        """Take in a good run."""
        self.sites |= {site.id: site for site in expansion.changed_sites}
        self._unsure.update(site.id for site in expansion.changed_sites)
        if expansion.site_order is None or expansion.site_order == self._order:
            return
        self._order, self._order_is_news = expansion.site_order, True
        self.sites = {name: self.sites[name] for name in self._order if name in self.sites}
        self._told = {name: view for name, view in self._told.items() if name in self.sites}

    def doubt_all(self) -> None:
        """Compare every site at the next `news`: a save, a reload or an argument came between."""
        self._unsure.update(self.sites)

    def news(self, sources: Sources) -> Sites | None:
        """What differs from what was told; None when nothing does."""
        arguments = sources.arguments
        changed: list[SiteView] = []
        for name in self._unsure & self.sites.keys():
            view = _view(self.sites[name], sources, arguments)
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


def _view(site: Site, sources: Sources, arguments: Mapping[str, str]) -> SiteView:
    argument = arguments.get(site.name) if site.kind == SiteKind.ARG else None
    return site_view(site, sources.saved_text(site.id), argument)
