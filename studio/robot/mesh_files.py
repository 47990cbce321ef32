"""The files of one mesh: itself and what it refers to, read below the served roots only."""

from __future__ import annotations

import hashlib
import re
from typing import TYPE_CHECKING
from urllib.parse import unquote

from studio.errors import MeshError, PackageError
from studio.packages.lfs import LFS_REASON, is_lfs_pointer
from studio.packages.roots import ServedRoots
from studio.problems import Place, Problem, Severity
from studio.settings import MESH_SIZE_LIMIT_BYTES

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

TRIANGLE_LIMIT = 4_000_000
"""What a browser can still draw; a mesh beyond it needs simplifying, not loading."""
_REFERENCE_LIMIT = 256
_REFERENCES_LIMIT_BYTES = 1 << 30
_SCHEME = re.compile(r"^([a-z][a-z0-9+.-]+):", re.IGNORECASE)


class MeshFiles:
    """Reads a mesh file and the files beside it, and keeps count of what it was and came to.

    Args:
        path: The mesh, already resolved below the served roots.
        roots: Folders that may be read; without any, the mesh's own folder.

    Raises:
        MeshError: It is a Git LFS pointer.
        PackageError: The mesh cannot be read.
    """

    def __init__(self, path: Path, roots: Iterable[Path] = ()) -> None:
        self.path = path
        self._roots = ServedRoots(tuple(roots) or (path.parent,))
        self.data = self._roots.read(path, MESH_SIZE_LIMIT_BYTES)
        if is_lfs_pointer(self.data):
            raise self.fault(f"it {LFS_REASON}")
        self.digest = content_digest(self.data)
        self.references: dict[str, str] = {}
        """Digest of each file that was asked for by absolute path; empty when it is missing."""
        self.problems: list[Problem] = []
        self._left_bytes = _REFERENCES_LIMIT_BYTES
        self._left_triangles = TRIANGLE_LIMIT

    def fault(self, reason: str) -> MeshError:
        """The error that says why this mesh cannot be shown."""
        return MeshError(str(self.path), reason)

    def warn(self, code: str, reason: str) -> None:
        """Note what the mesh is drawn without."""
        sentence = f"{self.path.name}: {reason}"
        problem = Problem(Severity.WARNING, code, sentence, Place(str(self.path)))
        if problem not in self.problems:
            self.problems.append(problem)

    def count_triangles(self, count: int) -> None:
        """Take `count` more triangles, before any memory is spent on them.

        Raises:
            MeshError: There are more than anyone can draw.
        """
        self._left_triangles -= count
        if self._left_triangles < 0:
            raise self.fault(
                f"it has more than {TRIANGLE_LIMIT:,} triangles, which no browser draws: "
                "simplify it."
            )

    def read_beside(self, uri: str) -> bytes:
        """Read a file that the mesh refers to.

        An absolute path of another machine, as many exporters write it, is looked for by its name
        in the mesh's own folder.

        Raises:
            MeshError: It is on the network, outside the served roots, missing, or too much.
        """
        path = self._beside(uri)
        try:
            return self._read(path)
        except MeshError as error:
            fallback = self.path.parent / path.name
            if fallback == path or not path.name:
                raise
            try:
                return self._read(fallback)
            except MeshError:
                raise error from None  # what was written is what must be mended

    def _beside(self, uri: str) -> Path:
        scheme = _SCHEME.match(uri)
        if scheme and scheme[1].lower() != "file" and len(scheme[1]) > 1:
            raise self.fault(f'it refers to "{_short(uri)}", which is not read over the network.')
        local = unquote(re.sub(r"^file:(//(localhost)?(?=/))?", "", uri)).replace("\\", "/")
        if "\0" in local:
            raise self.fault("it refers to a file whose name holds a NUL.")
        return self.path.parent / local

    def _read(self, path: Path) -> bytes:
        if len(self.references) >= _REFERENCE_LIMIT:
            raise self.fault(f"it refers to more than {_REFERENCE_LIMIT} files.")
        try:
            data = self._roots.read(path, min(MESH_SIZE_LIMIT_BYTES, self._left_bytes))
        except PackageError as error:
            self.references[str(path)] = ""
            raise MeshError(str(self.path), f'it refers to "{path.name}": {error}') from error
        if is_lfs_pointer(data):
            raise self.fault(f'it refers to "{path.name}", which {LFS_REASON}')
        self._left_bytes -= len(data)
        self.references[str(path)] = content_digest(data)
        return data


def content_digest(data: bytes) -> str:
    """Hex digest that names a content."""
    return hashlib.sha256(data).hexdigest()


def _short(text: str) -> str:
    return text if len(text) <= 80 else f"{text[:77]}..."
