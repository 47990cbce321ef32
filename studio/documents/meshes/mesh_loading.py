"""Brings the meshes that the scene asks for: loaded once each, reported as they come."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

from studio.errors import PackageError, PackageNotFoundError, RobotError, WorkerError
from studio.problems import Fix, Problem, Severity
from studio.robot.meshes.textured import split_textured

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable
    from pathlib import Path

    from studio.errors import StudioError
    from studio.robot.meshes.library import MeshLibrary
    from studio.robot.meshes.loaded_mesh import LoadedMesh


class MeshLoading:
    """Loads by URI; `arrived(uri, mesh)` is called for each, with None when it failed.

    Args:
        library: Loads a file once, whatever the number of askers.
        resolve: From a URI to a file and the folders that may be read; raises PackageError.
        arrived: Told of each mesh as it comes.
        progress: Told (done, total) of the batch under way.
    """

    def __init__(
        self,
        library: MeshLibrary,
        resolve: Callable[[str], tuple[Path, tuple[Path, ...]]],
        arrived: Callable[[str, LoadedMesh | None], None],
        progress: Callable[[int, int], None],
    ) -> None:
        self._library, self._resolve = library, resolve
        self._arrived, self._progress = arrived, progress
        self._tasks: dict[str, asyncio.Task[None]] = {}
        self._done = self._total = 0
        self.files: dict[str, str] = {}
        self.problems: dict[str, Problem] = {}

    def want(self, uris: Iterable[str]) -> None:
        """Load these in the background, but for those under way."""
        for uri in uris:
            if uri not in self._tasks:
                self._total += 1
                self._tasks[uri] = asyncio.create_task(self._load(uri))
        self._tell_progress()

    def forget(self, used: Iterable[str]) -> None:
        """Drop the problems and files of meshes that the robot no longer names."""
        kept = set(used)
        self.files = {uri: file for uri, file in self.files.items() if uri in kept}
        self.problems = {uri: found for uri, found in self.problems.items() if uri in kept}

    async def settled(self) -> None:
        """Wait until nothing is under way."""
        while self._tasks:
            await asyncio.wait(tuple(self._tasks.values()))

    async def close(self) -> None:
        """Give up what is under way."""
        tasks = tuple(self._tasks.values())
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)

    async def _load(self, uri: str) -> None:
        mesh: LoadedMesh | None = None
        try:
            shape, file = split_textured(uri)
            path, roots = self._resolve(file)
            self.files[uri] = str(path)
            mesh = await self._library.load(path, roots, shape)
            self.problems.pop(uri, None)
        except (PackageError, RobotError, WorkerError) as error:
            self.problems[uri] = mesh_problem(uri, error)
        finally:
            self._tasks.pop(uri, None)
            self._done += 1
        self._arrived(uri, mesh)
        self._tell_progress()

    def _tell_progress(self) -> None:
        if self._total:
            self._progress(self._done, self._total)
        if self._done == self._total:
            self._done = self._total = 0


def mesh_problem(uri: str, error: StudioError) -> Problem:
    """Why a mesh, or a texture on a primitive, is not there to be drawn."""
    file = split_textured(uri)[1]
    what = "Texture" if uri != file else "Mesh"
    if isinstance(error, PackageNotFoundError):  # the file that names it is where this is shown
        error = PackageNotFoundError(error.name, file)
    return Problem(Severity.WARNING, "mesh", f"{what} {error}", fix=_fix_of(error))


def _fix_of(error: Exception) -> Fix | None:
    """A package that is missing can be pointed at."""
    if isinstance(error, PackageNotFoundError):
        return Fix("Choose its folder", "choose_package", error.name)
    return None
