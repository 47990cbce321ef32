"""Loaded meshes on disk, by content: a bounded folder of files that are written whole."""

from __future__ import annotations

import contextlib
import os
from pathlib import Path
from typing import TYPE_CHECKING

from studio.files import write_whole
from studio.robot.mesh_blob import BLOB_VERSION, unpack_mesh

if TYPE_CHECKING:
    from studio.robot.loaded_mesh import LoadedMesh

_SUFFIX = f".v{BLOB_VERSION}.mesh"
_DEFAULT_LIMIT_BYTES = 1 << 30


class MeshCache:
    """The cache folder; made when missing, and only slower when it cannot be.

    Args:
        folder: Holds nothing else.
        limit_bytes: The longest unused files go when all are larger.
    """

    def __init__(self, folder: Path, limit_bytes: int = _DEFAULT_LIMIT_BYTES) -> None:
        self.folder, self._limit_bytes = folder, limit_bytes
        with contextlib.suppress(OSError):
            folder.mkdir(parents=True, exist_ok=True, mode=0o700)

    @staticmethod
    def name(path: Path, digest: str, shape: str = "") -> str:
        """What a mesh file with this content is kept under: the suffix chooses its reader."""
        return f"{digest}{shape and f'.{shape}'}{path.suffix.lower()}"

    def read(self, name: str) -> tuple[LoadedMesh, dict[str, str]] | None:
        """The mesh and what it refers to, or None; a broken file is removed."""
        file = self._file(name)
        try:
            blob = file.read_bytes()
            os.utime(file)  # what is used stays
        except OSError:
            return None
        try:
            return unpack_mesh(blob)
        except ValueError:
            with contextlib.suppress(OSError):
                file.unlink()
            return None

    def write(self, name: str, blob: bytes) -> bool:
        """Keep a packed mesh, whole or not at all; a full or read-only disk only costs time."""
        try:
            write_whole(self._file(name), blob, mode=0o600)
        except OSError:
            return False
        return True

    def trim(self) -> None:
        """Remove what was unused for longest until all fits; older versions go first."""
        found = sorted(self._entries())
        surplus = sum(size for _, _, size, _ in found) - self._limit_bytes
        for _, _, size, path in found:
            if surplus <= 0:
                return
            with contextlib.suppress(OSError):
                path.unlink()
                surplus -= size

    def _file(self, name: str) -> Path:
        return self.folder / f"{name}{_SUFFIX}"

    def _entries(self) -> list[tuple[bool, float, int, Path]]:
        """(of this version, time of last use, bytes, path) of each file."""
        entries: list[tuple[bool, float, int, Path]] = []
        with contextlib.suppress(OSError), os.scandir(self.folder) as files:
            for entry in files:
                with contextlib.suppress(OSError):
                    status = entry.stat(follow_symlinks=False)
                    current = entry.name.endswith(_SUFFIX)
                    entries.append((current, status.st_mtime, status.st_size, Path(entry.path)))
        return entries
