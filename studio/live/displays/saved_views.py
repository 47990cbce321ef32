"""SavedViews: the views that are saved with a document, for all who look at it."""

from __future__ import annotations

import logging
from dataclasses import replace
from typing import TYPE_CHECKING, Final

from studio.errors import CommandError, StudioError
from studio.protocol import views as protocol
from studio.protocol.commands import Commands, Scope
from studio.protocol.views import (
    DeleteView,
    GetViewKinds,
    MoveView,
    RenameView,
    SaveView,
    ViewKinds,
    ViewKindView,
)
from studio.rviz.config_lists import with_entries
from studio.rviz.views import VIEW_KINDS, VIEWS_MAX, ViewSpec

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from studio.protocol.listeners import Audience

_log = logging.getLogger(__name__)


class SavedViews:
    """Views in the order in which they are listed; ids are never given twice.

    A command that fails raises a CommandError, ViewError or DisplayPropertyError and leaves
    everything as it was.

    Args:
        audience: Is sent the views when they change.
        changed: Called when they did.
    """

    def __init__(self, audience: Audience, changed: Callable[[], object]) -> None:
        self._audience, self._changed = audience, changed
        self._specs: dict[str, ViewSpec] = {}
        self._given = 0

    @property
    def specs(self) -> tuple[ViewSpec, ...]:
        """All of them, in order."""
        return tuple(self._specs.values())

    def restore(self, specs: Iterable[ViewSpec]) -> None:
        """Have these and no others; what is no view any more is left out."""
        self._specs = {}
        for spec in tuple(specs)[:VIEWS_MAX]:
            try:
                self._specs[self._new_id()] = spec.checked()
            except StudioError as error:
                _log.warning("The view %s was left out: %s", spec.name, error)
        self._audience.send(self.event())

    def note_saved(self, saved: Iterable[ViewSpec]) -> None:
        """Note where each stands in the config file that was written."""
        self._specs = dict(zip(self._specs, with_entries(self.specs, saved), strict=True))

    def event(self) -> protocol.SavedViews:
        """Return all of them, for pages."""
        return protocol.SavedViews(
            views=tuple(
                protocol.SavedView(id=id_, kind=one.kind, name=one.name, values=dict(one.values))
                for id_, one in self._specs.items()
            )
        )

    def save(self, command: SaveView) -> None:
        """Add a view."""
        if len(self._specs) >= VIEWS_MAX:
            raise CommandError(f"There are {VIEWS_MAX} saved views: delete one first.")
        spec = ViewSpec(command.kind, _named(command.name), command.values).checked()
        if command.before:
            self._get(command.before)
        id_ = self._new_id()
        self._specs[id_] = spec
        self._arrange(id_, command.before)

    def rename(self, command: RenameView) -> None:
        """Give one another name."""
        spec = self._get(command.view)
        self._specs[command.view] = replace(spec, name=_named(command.name))
        self._tell()

    def move(self, command: MoveView) -> None:
        """Put one before another."""
        self._get(command.view)
        if command.before:
            self._get(command.before)
        self._arrange(command.view, command.before)

    def delete(self, command: DeleteView) -> None:
        """Take one away."""
        self._get(command.view)
        del self._specs[command.view]
        self._tell()

    def kinds(self, command: GetViewKinds) -> ViewKinds:
        """Return all kinds of views."""
        from studio.live.displays.catalogue_views import property_view  # noqa: PLC0415 - imports all

        kinds = (
            ViewKindView(
                kind=one.kind, doc=one.doc, properties=tuple(map(property_view, one.properties))
            )
            for one in VIEW_KINDS.values()
        )
        return ViewKinds(request=command.request, kinds=tuple(kinds))

    def _get(self, view: str) -> ViewSpec:
        if found := self._specs.get(view):
            return found
        raise CommandError("This view is not saved any more: choose another.")

    def _new_id(self) -> str:
        self._given += 1
        return f"v{self._given}"

    def _arrange(self, view: str, before: str) -> None:
        """Put one before another, or at the end."""
        if view != before:
            others = [one for one in self._specs if one != view]
            at = others.index(before) if before else len(others)
            self._specs = {one: self._specs[one] for one in (*others[:at], view, *others[at:])}
        self._tell()

    def _tell(self) -> None:
        self._audience.send(self.event())
        self._changed()


def _named(name: str) -> str:
    name = name.strip()
    if not name:
        raise CommandError("A view needs a name of at least one letter.")
    return name


COMMANDS: Final = Commands[SavedViews](Scope.DOCUMENT)
COMMANDS.viewer(GetViewKinds, lambda views, c, _: views.kinds(c), same_for_all=True)
COMMANDS.controller(SaveView, lambda views, c, _: views.save(c))
COMMANDS.controller(RenameView, lambda views, c, _: views.rename(c))
COMMANDS.controller(MoveView, lambda views, c, _: views.move(c))
COMMANDS.controller(DeleteView, lambda views, c, _: views.delete(c))
