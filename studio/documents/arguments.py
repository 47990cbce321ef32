"""The arguments of a robot as a form: for an open document, or for a file before it is opened."""

from __future__ import annotations

import asyncio
from pathlib import Path
from typing import TYPE_CHECKING, Final

from studio.description.sites.launch_arguments import LaunchArgument, launch_arguments
from studio.description.values import SiteKind
from studio.errors import CommandError, PackageError
from studio.files import is_folder, is_there
from studio.protocol.documents import Arguments, ArgumentView

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from studio.documents.runs import LastRun
    from studio.documents.sites import SiteTable
    from studio.documents.workspace import Workspace
    from studio.packages.workspace import Location

_NAMES_READ: Final = 1000
"""Limit for one folder: nobody reads more choices."""


class RoomWorld:
    """The files below the served folders of a location, as they are edited."""

    def __init__(self, location: Location, texts: Mapping[str, bytes]) -> None:
        self._location, self._texts = location, texts
        self._names: dict[str, tuple[str, ...]] = {}

    def read(self, path: str) -> bytes:
        """Return a file's text as it is edited; PackageError when it may not or cannot be read."""
        real = str(self._location.served.resolve(path))
        held = self._texts.get(real)
        return self._location.served.read(real) if held is None else held

    def find(self, package: str, asking_file: str) -> str | None:
        """Return the folder of a package."""
        folders = self._location.index.candidates(package, asking_file)
        return str(folders[0]) if folders else None

    def names(self, folder: str) -> tuple[str, ...]:
        """Return the names in a folder; none if it is no folder or lies outside."""
        if folder not in self._names:
            self._names[folder] = self._listed(folder)
        return self._names[folder]

    def exists(self, path: str) -> bool:
        """Whether a file or folder is there, inside."""
        return self._location.served.serves(path) and is_there(Path(path))

    def is_folder(self, path: str) -> bool:
        """Whether a folder is there, inside."""
        return self._location.served.serves(path) and is_folder(Path(path))

    def _listed(self, folder: str) -> tuple[str, ...]:
        try:
            real = self._location.served.resolve(folder)
            found = [one.name for one, _ in zip(real.iterdir(), range(_NAMES_READ), strict=False)]
        except (PackageError, OSError):
            return ()
        return tuple(sorted(found))


async def form_of(
    workspace: Workspace, last_run: LastRun, sites: SiteTable, request: int
) -> Arguments:
    """Return the arguments that an open document is launched with, and those it could have."""
    path, sources = workspace.path, workspace.sources
    world = RoomWorld(workspace.location, sources.overlay())
    passed, files = sources.arguments, last_run.files
    found = await asyncio.to_thread(launch_arguments, path, passed, world, files)
    of_sites = sites.sites.values()
    values = {one.name: one.value for one in of_sites if one.kind is SiteKind.ARG and one.value}
    views = tuple(_view(one, passed, values) for one in found)
    missing = () if last_run.expansion else _missing(found, passed)
    return Arguments(request=request, path=path, arguments=views, missing=missing)


async def form_at(location: Location, request: int) -> Arguments:
    """Return the arguments that a file can be launched with before it is opened.

    Raises:
        CommandError: There is no robot file.
    """
    if location.entry is None:
        raise CommandError(f"{location.root} holds no robot description: choose a file.")
    entry, world = str(location.entry), RoomWorld(location, {})
    found = await asyncio.to_thread(launch_arguments, entry, {}, world)
    outside = [one for one in found if one.default is not None or not one.in_macro]
    views = tuple(_view(one, {}, {}) for one in outside)
    missing = _missing(outside, {})
    return Arguments(request=request, path=entry, arguments=views, missing=missing)


def _missing(found: Iterable[LaunchArgument], passed: Mapping[str, str]) -> tuple[str, ...]:
    needed = (one.name for one in found if one.default is None or one.is_early)
    return tuple(name for name in needed if name not in passed)


def _view(
    one: LaunchArgument, passed: Mapping[str, str], values: Mapping[str, str]
) -> ArgumentView:
    return ArgumentView(
        name=one.name,
        file=one.place.file,
        line=one.place.line,
        default=one.default,
        value=passed.get(one.name),
        shown=values.get(one.name, one.shown),
        widget=one.widget,
        is_file=one.is_file,
    )
