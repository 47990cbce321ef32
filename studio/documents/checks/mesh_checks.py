"""Checks of meshes: those that the scene does not show, and names that miss a file by a typo."""

from __future__ import annotations

import asyncio
import re
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final, TypeAlias

from studio.description.syntax.attribute_spans import attribute_spans
from studio.description.syntax.source_tree import SourceError, parse_source
from studio.documents.meshes import mesh_problem
from studio.errors import EditError, PackageError, RobotError, WorkerError
from studio.packages.uris import near_file
from studio.problems import Fix, Replacement
from studio.robot.meshes.reading import MESH_SUFFIXES
from studio.robot.meshes.textured import split_textured
from studio.robot.values import Mesh

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
    from pathlib import Path

    from studio.description.syntax.source_tree import SourceElement, SourceTree
    from studio.documents.meshes import Meshes
    from studio.documents.model import Model
    from studio.documents.workspace import Workspace
    from studio.problems import Problem
    from studio.robot.measures import Bounds
    from studio.robot.meshes.library import MeshLibrary


_Stamp: TypeAlias = "tuple[Path, int, int]"


class HiddenMeshes:
    """Sizes and problems of meshes by URI, as they were read last.

    Collision shapes are loaded by the scene when somebody wants to see them; the checks want to
    know of them before.
    """

    def __init__(self, workspace: Workspace, library: MeshLibrary) -> None:
        self._workspace, self._library = workspace, library
        self._seen: dict[str, _Stamp | None] = {}
        self.bounds: dict[str, Bounds] = {}
        self.problems: dict[str, Problem] = {}

    async def read(self, uris: Iterable[str]) -> bool:
        """Read these meshes and forget the others; one at a time, for nobody waits for them.

        Returns:
            Whether anything changed.
        """
        before = dict(self.bounds), dict(self.problems)
        wanted = set(uris)
        for known in (self._seen, self.bounds, self.problems):
            for uri in known.keys() - wanted:
                del known[uri]
        for uri in sorted(wanted):
            await self._read(uri)
        return before != (self.bounds, self.problems)

    async def _read(self, uri: str) -> None:
        stamp: _Stamp | None = None
        try:
            stamp = await asyncio.to_thread(self._stamp, uri)
            if self._seen.get(uri) == stamp:
                return
            mesh = await self._library.load(stamp[0], self._workspace.served.all)
            self.bounds[uri] = mesh.bounds_m
            self.problems.pop(uri, None)
        except (PackageError, RobotError, WorkerError) as error:
            self.bounds.pop(uri, None)
            self.problems[uri] = mesh_problem(uri, error)
        self._seen[uri] = stamp

    def _stamp(self, uri: str) -> _Stamp:
        """Return the path, modification time and size of a mesh."""
        path = self._workspace.resolve_uri(uri)
        status = path.stat()
        return path, status.st_mtime_ns, status.st_size


_FIND: Final = re.compile(r"\$\(\s*find\s[^()]*\)")
"""Comes to the same folder in every call of a macro."""
_SEARCHED: Final = 200
"""Missing meshes; a robot whose whole folder is gone has more."""


@dataclass(frozen=True, slots=True)
class NearMeshes:
    """Looks for what was meant; touches the disk, so it is asked in a thread.

    Args:
        workspace: Of the robot.
        text: Of a file as it is edited now; None when it cannot be read.
        named: All mesh URIs of the robot.
    """

    workspace: Workspace
    text: Callable[[str], bytes | None]
    named: Collection[str]

    def mended(self, found: Mapping[str, Problem]) -> dict[str, Problem]:
        """Return the problems by URI that have a fix, with it; `found` has their places."""
        trees: dict[str, SourceTree | None] = {}
        made: dict[str, Problem] = {}
        for uri, problem in list(found.items())[:_SEARCHED]:
            meant = self._meant(uri) if problem.fix is None and problem.place else ""
            if not meant or problem.place is None:
                continue
            file = problem.place.file
            if file not in trees:
                trees[file] = self._tree(file)
            tree = trees[file]
            if tree is not None:
                made[uri] = _with_fix(problem, uri, meant, tree)
        return made

    def _meant(self, uri: str) -> str:
        if split_textured(uri)[1] != uri:
            return ""
        location, entry = self.workspace.location, self.workspace.entry
        return near_file(uri, entry, location.index, location.served, MESH_SUFFIXES, self.named)

    def _tree(self, file: str) -> SourceTree | None:
        data = self.text(file)
        try:
            return parse_source(file, data) if data is not None else None
        except SourceError:
            return None


def _with_fix(problem: Problem, uri: str, meant: str, tree: SourceTree) -> Problem:
    """Add the intended name to the sentence, and a fix where the texts have the wrong one."""
    edits = tuple(_edits(problem, uri, meant, tree))
    sentence = f'{problem.sentence.removesuffix(".")}: did you mean "{meant}"?'
    fix = Fix(f'Write "{meant}"', "edit", edits=edits) if edits else None
    return replace(problem, sentence=sentence, fix=fix)


def _edits(problem: Problem, uri: str, meant: str, tree: SourceTree) -> Iterator[Replacement]:
    """Yield edits that give each <mesh> with this URI in the link the intended file name."""
    part = next((one for one in tree.elements if one.place == problem.place), None)
    for mesh in _meshes(part) if part is not None else ():
        written = mesh.attributes.get("filename", "")
        if _matches(written, uri) and (edit := _renamed(mesh, written, meant)):
            yield edit


def _meshes(element: SourceElement) -> Iterator[SourceElement]:
    for one in element.elements():
        if one.tag == "mesh":
            yield one
        yield from _meshes(one)


def _matches(written: str, uri: str) -> bool:
    """Whether the text is the URI, but for folders of packages that are found."""
    literal = _FIND.split(written)
    if any("$" in piece for piece in literal):
        return False
    return re.fullmatch(".*".join(map(re.escape, literal)), uri, re.DOTALL) is not None


def _renamed(mesh: SourceElement, written: str, meant: str) -> Replacement | None:
    name = written.rstrip().rpartition("/")[2]
    data, encoding = mesh.tree.data, mesh.tree.encoding
    try:
        span = attribute_spans(data, mesh.offset)["filename"]
    except (EditError, KeyError):
        return None
    raw = name.encode(encoding, "replace")
    at = data.rfind(raw, span.start, span.end) if raw else -1
    plain = not re.search(r"[<>&\"'$]", name + meant)
    if at < 0 or not plain or data[at + len(raw) : span.end].strip():
        return None
    return Replacement(mesh.tree.path, at, at + len(raw), name, meant)


class MeshChecks:
    """Checks the meshes of a robot: those of its scene, and those that only collisions name.

    Args:
        workspace: Where the meshes lie.
        model: Names the meshes.
        meshes: Those of the scene.
        library: Loads the others.
    """

    def __init__(
        self, workspace: Workspace, model: Model, meshes: Meshes, library: MeshLibrary
    ) -> None:
        self._workspace, self._model, self._meshes = workspace, model, meshes
        self._hidden = HiddenMeshes(workspace, library)

    async def read_hidden(self) -> bool:
        """Read the meshes that the scene has not loaded; whether anything is other than before."""
        return await self._hidden.read(self._hidden_uris())

    def bounds(self) -> dict[str, Bounds]:
        """Return the boxes of all meshes that are known, by URI."""
        shown = ((uri, self._model.scene.mesh(uri)) for uri in self._model.mesh_uris())
        of_scene = {uri: mesh.bounds_m for uri, mesh in shown if mesh is not None}
        return {**self._hidden.bounds, **of_scene}

    async def check(self, text: Callable[[str], bytes | None]) -> list[Problem]:
        """Return the problems of hidden meshes, and give the scene's their fixes.

        Args:
            text: As for `NearMeshes`.
        """
        hidden, shown = self._problems_of_hidden(), self._meshes.problems
        named = self._model.mesh_uris() | self._hidden_uris()
        near_meshes = NearMeshes(self._workspace, text, named)
        near = await asyncio.to_thread(near_meshes.mended, hidden | shown)
        self._meshes.suggest({shown[uri]: near[uri] for uri in near if uri in shown})
        return [near.get(uri, one) for uri, one in hidden.items()]

    def _hidden_uris(self) -> frozenset[str]:
        """Meshes of collisions that the scene has not loaded."""
        scene = self._model.scene
        return frozenset(
            one.geometry.uri
            for link in self._model.robot.links.values()
            for one in link.collisions
            if isinstance(one.geometry, Mesh) and scene.mesh(one.geometry.uri) is None
        )

    def _problems_of_hidden(self) -> dict[str, Problem]:
        users = self._model.mesh_users()
        return {
            uri: replace(problem, place=part.place, parts=(part.key,))
            if (part := users.get(uri))
            else problem
            for uri, problem in self._hidden.problems.items()
        }
