"""The sites of a document as the page has them, with their texts on disk."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, TypeAlias

from studio.description.values import SiteKind
from studio.errors import EditError
from studio.protocol.edits import Sites, SiteView

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from studio.description.editing.sources import Sources
    from studio.description.values import Expansion, Site
    from studio.protocol.listeners import Audience

_MadeOf: TypeAlias = "tuple[Site, str | None, str | None]"
"""What a view is made of: the site, its text on disk, and the argument passed."""


class SiteTable:
    """Takes the changes of a run, and sends the audience those that it does not have.

    Args:
        sources: The texts that the sites are in.
        audience: Is sent the sites.
    """

    def __init__(self, sources: Sources, audience: Audience) -> None:
        self._sources, self._audience = sources, audience
        self.sites: dict[str, Site] = {}
        self._order: tuple[str, ...] = ()
        self._sent: dict[str, SiteView] = {}
        self._sent_of: dict[str, _MadeOf] = {}
        """What each view was made of: comparing is fast, and making thousands is not."""
        self._changed: set[str] = set()
        """Sites to compare with those sent."""
        self._order_changed = False
        self._ahead: set[str] = set()
        """Sites sent with a text that no good run has seen."""

    def take(self, expansion: Expansion) -> None:
        """Take in a good run."""
        self.sites |= {site.id: site for site in expansion.changed_sites}
        self._changed.update(site.id for site in expansion.changed_sites)
        self._changed |= self._ahead
        self._ahead.clear()
        if expansion.site_order is None or expansion.site_order == self._order:
            return
        self._order, self._order_changed = expansion.site_order, True
        self.sites = {name: self.sites[name] for name in self._order if name in self.sites}
        self._sent = {name: view for name, view in self._sent.items() if name in self.sites}
        self._sent_of = {name: self._sent_of[name] for name in self._sent}

    def take_failure(self) -> None:
        """Take in a run that failed: texts in edited files are new, their values are not."""
        unsaved = set(self._sources.unsaved_files)
        for name, site in self.sites.items():
            if name in self._ahead or (
                site.place.file in unsaved and self._text_now(site) != site.text
            ):
                self._ahead.add(name)
        self._changed |= self._ahead

    def invalidate(self) -> None:
        """Compare every site at the next `send`, after a save, a reload or another argument."""
        self._changed.update(self.sites)

    def send(self) -> None:
        """Send the audience the sites that changed."""
        if changed := self._take_changed():
            self._audience.send(changed)

    def event(self) -> Sites:
        """Return all sites as they were sent."""
        return Sites(order=self._order, changed=tuple(self._sent.values()))

    def argument_values(self) -> dict[str, str]:
        """Return the value of each argument in the last good run, passed or not."""
        return argument_values(self.sites.values())

    def _take_changed(self) -> Sites | None:
        arguments = self._sources.arguments
        changed: list[SiteView] = []
        for name in self._changed & self.sites.keys():
            site = self.sites[name]
            if name in self._ahead:
                site = replace(site, text=self._text_now(site))
            made_of = self._made_of(site, arguments)
            if made_of == self._sent_of.get(name):
                continue
            self._sent_of[name], view = made_of, _site_view(*made_of)
            if view != self._sent.get(name):
                self._sent[name] = view
                changed.append(view)
        order = self._order if self._order_changed else None
        self._changed.clear()
        self._order_changed = False
        return Sites(order=order, changed=tuple(changed)) if changed or order is not None else None

    def _made_of(self, site: Site, arguments: Mapping[str, str]) -> _MadeOf:
        argument = arguments.get(site.name) if site.kind == SiteKind.ARG else None
        return site, self._saved_text(site), argument

    def _saved_text(self, site: Site) -> str | None:
        try:
            return self._sources.saved_text(site.id)
        except EditError:
            return None  # typed over since the last run: the next one has the site again

    def _text_now(self, site: Site) -> str:
        try:
            return self._sources.current_text(site.id)
        except EditError:
            return site.text  # as above


def argument_values(sites: Iterable[Site]) -> dict[str, str]:
    """Return the value of each argument in a run; of several declarations the first counts."""
    found: dict[str, str] = {}
    for site in sites:
        if site.kind is SiteKind.ARG:
            found.setdefault(site.name, site.value or site.text)
    return found


def _site_view(site: Site, saved_text: str | None, argument: str | None) -> SiteView:
    return SiteView(
        id=site.id,
        kind=site.kind,
        name=site.name,
        file=site.place.file,
        line=site.place.line,
        text=site.text,
        saved_text=saved_text,
        value=site.value,
        number=site.number,
        values=site.values,
        reads=site.reads,
        widget=site.widget,
        group=site.group,
        owner=site.owner,
        argument=argument,
    )
