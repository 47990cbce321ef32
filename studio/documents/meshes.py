"""The meshes of a document: loaded once each when its scene lacks them, shown as they come."""

from __future__ import annotations

import asyncio
from dataclasses import replace
from typing import TYPE_CHECKING

from studio.errors import PackageError, PackageNotFoundError, RobotError, WorkerError
from studio.problems import Fix, Problem, Severity
from studio.protocol.documents import Progress
from studio.robot.meshes.textured import split_textured

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping
    from pathlib import Path

    from studio.description.values import Part
    from studio.documents.findings import Findings
    from studio.documents.model import Model
    from studio.documents.workspace import Workspace
    from studio.errors import StudioError
    from studio.protocol.listeners import Audience
    from studio.robot.meshes.library import MeshLibrary
    from studio.robot.meshes.loaded_mesh import LoadedMesh


class MeshLoading:
    """Loads by URI; `arrived(uri, mesh)` is called for each, with None when it failed.

    Args:
        library: Loads each file once for all.
        resolve: Returns the file of a URI and the folders it may use; raises PackageError.
        arrived: Called with each mesh as it comes.
        progress: Called with (done, total) of the running batch.
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
        """Load these in the background, except those being loaded."""
        for uri in uris:
            if uri not in self._tasks:
                self._total += 1
                self._tasks[uri] = asyncio.create_task(self._load(uri))
        self._report_progress()

    def forget(self, used: Iterable[str]) -> None:
        """Drop the problems and files of meshes that the robot no longer names."""
        kept = set(used)
        self.files = {uri: file for uri, file in self.files.items() if uri in kept}
        self.problems = {uri: found for uri, found in self.problems.items() if uri in kept}

    async def settled(self) -> None:
        """Wait until nothing is being loaded."""
        while self._tasks:
            await asyncio.wait(tuple(self._tasks.values()))

    async def close(self) -> None:
        """Cancel what is being loaded."""
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
        self._report_progress()

    def _report_progress(self) -> None:
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


class Meshes:
    """Loads the meshes that the scene needs, and forgets the others.

    Args:
        workspace: Resolves the URIs of the meshes.
        model: Names the meshes, and its scene draws them.
        library: Loads each file once for all.
        findings: Takes their problems.
        audience: Is sent the progress.
        arrived: Called when a mesh came, or failed to.
    """

    def __init__(
        self,
        workspace: Workspace,
        model: Model,
        library: MeshLibrary,
        findings: Findings,
        audience: Audience,
        arrived: Callable[[], None],
    ) -> None:
        self._workspace, self._model, self._findings = workspace, model, findings
        self._audience, self._on_arrived = audience, arrived
        self._nearer: dict[Problem, Problem] = {}
        """Problems with what was meant, by what they are without."""
        self._loading = MeshLoading(library, self._resolve, self._arrived, self._progress)

    @property
    def files(self) -> tuple[str, ...]:
        """The files of all meshes in use."""
        return tuple(self._loading.files.values())

    def want(self) -> None:
        """Load the meshes that the scene lacks, and forget those no longer used."""
        scene = self._model.scene
        self._loading.forget(self._model.mesh_uris() | scene.live.mesh_uris())
        self._loading.want(scene.missing_meshes())
        self._report_problems()

    def retry(self) -> None:
        """Load those again that failed."""
        self._loading.want(tuple(self._loading.problems))

    def reload(self, files: Iterable[str]) -> None:
        """Load what these files hold again."""
        changed = set(files)
        self._loading.want([uri for uri, file in self._loading.files.items() if file in changed])

    @property
    def problems(self) -> dict[str, Problem]:
        """Return the problems of the robot's meshes by URI, each at the first link that uses it."""
        model, found = self._model, self._loading.problems
        if not found:
            return {}
        users = model.mesh_users()
        return {
            uri: _placed(found[uri], users.get(uri)) for uri in model.mesh_uris() if uri in found
        }

    def trouble_of(self, uri: str) -> str:
        """Return why a mesh cannot be shown, in a sentence; empty if it can."""
        found = self._loading.problems.get(uri)
        return found.sentence if found else f"Mesh {uri} cannot be shown."

    def suggest(self, nearer: Mapping[Problem, Problem]) -> None:
        """Report these from now on instead of the problems that they are of."""
        self._nearer = dict(nearer)
        self._report_problems()

    async def settled(self) -> None:
        """Wait until nothing is being loaded."""
        await self._loading.settled()

    async def close(self) -> None:
        """Cancel what is being loaded."""
        await self._loading.close()

    def _arrived(self, uri: str, mesh: LoadedMesh | None) -> None:
        self._model.scene.provide_mesh(uri, mesh)
        self._model.scene.flush()
        self._on_arrived()
        self._report_problems()

    def _report_problems(self) -> None:
        found = self.problems.values()
        self._findings.replace("mesh", [self._nearer.get(one, one) for one in found])

    def _progress(self, done: int, total: int) -> None:
        self._audience.send(Progress(task="meshes", label="Loading meshes", done=done, total=total))

    def _resolve(self, uri: str) -> tuple[Path, tuple[Path, ...]]:
        """Return the file of a mesh, and the folders of the files that it may use."""
        return self._workspace.resolve_uri(uri), self._workspace.served.all


def _placed(problem: Problem, part: Part | None) -> Problem:
    return replace(problem, place=part.place, parts=(part.key,)) if part else problem
