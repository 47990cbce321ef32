"""The meshes that a robot names and its scene does not show: whether they are there, how large."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, TypeAlias

from studio.documents.meshes.mesh_loading import mesh_problem
from studio.errors import PackageError, RobotError, WorkerError
from studio.packages.uris import resolve_uri

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from studio.documents.document import Document
    from studio.problems import Problem
    from studio.robot.measures import Bounds
    from studio.robot.meshes.library import MeshLibrary

    _Stamp: TypeAlias = tuple[Path, int, int]


class HiddenMeshes:
    """Sizes and problems of meshes by URI, as they were looked at last.

    Collision shapes are loaded by the scene when somebody wants to see them; the checks want to
    know of them before.
    """

    def __init__(self, document: Document, library: MeshLibrary) -> None:
        self._document, self._library = document, library
        self._seen: dict[str, _Stamp | None] = {}
        self.bounds: dict[str, Bounds] = {}
        self.problems: dict[str, Problem] = {}

    async def look(self, uris: Iterable[str]) -> bool:
        """Look at these and forget the others; one after the other, for nobody waits for them.

        Returns:
            Whether anything is other than before.
        """
        before = dict(self.bounds), dict(self.problems)
        wanted = set(uris)
        for known in (self._seen, self.bounds, self.problems):
            for uri in known.keys() - wanted:
                del known[uri]
        for uri in sorted(wanted):
            await self._look_at(uri)
        return before != (self.bounds, self.problems)

    async def _look_at(self, uri: str) -> None:
        stamp: _Stamp | None = None
        try:
            stamp = await asyncio.to_thread(self._stamp, uri)
            if self._seen.get(uri) == stamp:
                return
            mesh = await self._library.load(stamp[0], self._document.location.served.all)
            self.bounds[uri] = mesh.bounds_m
            self.problems.pop(uri, None)
        except (PackageError, RobotError, WorkerError) as error:
            self.bounds.pop(uri, None)
            self.problems[uri] = mesh_problem(uri, error)
        self._seen[uri] = stamp

    def _stamp(self, uri: str) -> _Stamp:
        """Where a mesh lies, when it was written and how long it is."""
        document = self._document
        location = document.location
        path = resolve_uri(uri, document.entry, location.index, location.served)
        status = path.stat()
        return path, status.st_mtime_ns, status.st_size
