"""Meshes that are missing by a slip of the pen: which file was meant, and the edit for it."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final

from studio.description.syntax.attribute_spans import attribute_spans
from studio.description.syntax.source_tree import SourceError, parse_source
from studio.errors import EditError
from studio.packages.near_files import near_file
from studio.problems import Fix, Replacement
from studio.robot.meshes.reading import MESH_SUFFIXES
from studio.robot.meshes.textured import split_textured

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterator, Mapping
    from pathlib import Path

    from studio.description.syntax.source_tree import SourceElement, SourceTree
    from studio.packages.workspace import Location
    from studio.problems import Problem

_FIND: Final = re.compile(r"\$\(\s*find\s[^()]*\)")
"""Comes to the same folder in every call of a macro."""
_LOOKED_AT: Final = 200
"""Missing meshes; a robot whose whole folder is gone has more."""


@dataclass(frozen=True, slots=True)
class NearMeshes:
    """Looks for what was meant; touches the disk, so it is asked in a thread.

    Args:
        location: Of the robot.
        entry: The file that its URIs stand in.
        text: Of a file as it is edited now; None when it cannot be read.
        named: All mesh URIs of the robot.
    """

    location: Location
    entry: Path
    text: Callable[[str], bytes | None]
    named: Collection[str]

    def mended(self, found: Mapping[str, Problem]) -> dict[str, Problem]:
        """The problems by URI that can be mended, each with its fix; `found` has their places."""
        trees: dict[str, SourceTree | None] = {}
        made: dict[str, Problem] = {}
        for uri, problem in list(found.items())[:_LOOKED_AT]:
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
        index, served = self.location.index, self.location.served
        return near_file(uri, self.entry, index, served, MESH_SUFFIXES, self.named)

    def _tree(self, file: str) -> SourceTree | None:
        data = self.text(file)
        try:
            return parse_source(file, data) if data is not None else None
        except SourceError:
            return None


def _with_fix(problem: Problem, uri: str, meant: str, tree: SourceTree) -> Problem:
    """The name that was meant is said in any case; the fix is there where the name stands so."""
    edits = tuple(_edits(problem, uri, meant, tree))
    sentence = f'{problem.sentence.removesuffix(".")}: did you mean "{meant}"?'
    fix = Fix(f'Write "{meant}"', "edit", edits=edits) if edits else None
    return replace(problem, sentence=sentence, fix=fix)


def _edits(problem: Problem, uri: str, meant: str, tree: SourceTree) -> Iterator[Replacement]:
    """Each <mesh> of the link that says this URI gets the other name behind the last slash."""
    part = next((one for one in tree.elements if one.place == problem.place), None)
    for mesh in _meshes(part) if part is not None else ():
        written = mesh.attributes.get("filename", "")
        if _says(written, uri) and (edit := _renamed(mesh, written, meant)):
            yield edit


def _meshes(element: SourceElement) -> Iterator[SourceElement]:
    for one in element.elements():
        if one.tag == "mesh":
            yield one
        yield from _meshes(one)


def _says(written: str, uri: str) -> bool:
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
