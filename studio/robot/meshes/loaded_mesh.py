"""A mesh as it is drawn, as bytes for the pipe and the disk, and the cache on the disk."""

from __future__ import annotations

import contextlib
import os
import struct
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import msgspec
import numpy as np

from studio.files import write_whole
from studio.problems import Problem  # noqa: TC001 - msgspec reads it
from studio.robot.values import Vector3  # noqa: TC001 - msgspec reads it

if TYPE_CHECKING:
    from numpy.typing import NDArray

BLOB_VERSION = 1
"""Part of the file name in the cache: raise it when the form or what the readers make changes."""
_MAGIC = b"STUDIOMESH\0\1"
_LENGTH = struct.Struct("<I")
_SUFFIX = f".v{BLOB_VERSION}.mesh"
_DEFAULT_LIMIT_BYTES = 1 << 30


@dataclass(frozen=True, slots=True, eq=False)
class LoadedMesh:
    """One mesh file, whole and flattened; compare by `digest`. Arrays are read-only.

    Units are applied (COLLADA `<unit>`), `up_axis` is ignored as RViz does, and the `scale` of
    the URDF is not applied: it belongs to the node that draws the mesh.
    """

    digest: str
    """Hex digest of the file and of every file it refers to: equal means drawn the same."""
    vertices: NDArray[np.float32]
    """Shape (N, 3), metres, split at creases, so that smooth normals come out right."""
    faces: NDArray[np.uint32]
    """Shape (M, 3), M > 0, indices into `vertices`."""
    glb: bytes
    """The same triangles with the mesh's own materials, textures and vertex colours; nothing is
    fetched to draw it. Empty when the mesh has no colour of its own (all STL): then the URDF
    material colours it."""
    bounds_m: tuple[Vector3, Vector3]
    """Least and greatest corner."""
    problems: tuple[Problem, ...] = ()
    """Warnings about what is missing, e.g. a texture."""


@dataclass(frozen=True, slots=True)
class MeshHead:
    """The header before the arrays of a blob."""

    digest: str
    """Of the mesh file and all it refers to."""
    references: dict[str, str]
    """Content digest by absolute path of each file it refers to; empty for a missing one."""
    vertex_count: int
    face_count: int
    glb_bytes: int
    bounds_m: tuple[Vector3, Vector3]
    problems: tuple[Problem, ...]


_HEADS = msgspec.msgpack.Decoder(MeshHead)


def pack_mesh(mesh: LoadedMesh, references: dict[str, str]) -> bytes:
    """Magic, length of the head, head, vertices, faces, GLB."""
    head = msgspec.msgpack.encode(
        MeshHead(
            mesh.digest,
            references,
            len(mesh.vertices),
            len(mesh.faces),
            len(mesh.glb),
            mesh.bounds_m,
            mesh.problems,
        )
    )
    head += b" " * (-(len(_MAGIC) + _LENGTH.size + len(head)) % 4)  # arrays stand aligned
    return b"".join(
        (
            _MAGIC,
            _LENGTH.pack(len(head)),
            head,
            np.ascontiguousarray(mesh.vertices, dtype="<f4").data,
            np.ascontiguousarray(mesh.faces, dtype="<u4").data,
            mesh.glb,
        )
    )


def unpack_mesh(blob: bytes) -> tuple[LoadedMesh, dict[str, str]]:
    """Return the mesh and the digests of what it refers to; its arrays view `blob`, read-only.

    Raises:
        ValueError: Cut off, or not such a blob.
    """
    start = len(_MAGIC) + _LENGTH.size
    if blob[: len(_MAGIC)] != _MAGIC or len(blob) < start:
        raise ValueError("This is no cached mesh.")
    (length,) = _LENGTH.unpack_from(blob, len(_MAGIC))
    head = _HEADS.decode(blob[start : start + length].rstrip(b" "))
    at_faces = start + length + 12 * head.vertex_count
    at_glb = at_faces + 12 * head.face_count
    if len(blob) != at_glb + head.glb_bytes:
        raise ValueError("This cached mesh is cut off.")
    vertices = np.frombuffer(blob, "<f4", 3 * head.vertex_count, start + length)
    faces = np.frombuffer(blob, "<u4", 3 * head.face_count, at_faces)
    mesh = LoadedMesh(
        head.digest,
        vertices.reshape(-1, 3),
        faces.reshape(-1, 3),
        blob[at_glb:],
        head.bounds_m,
        head.problems,
    )
    return mesh, head.references


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
        """Return the name of a mesh file with this content: the suffix chooses its reader."""
        return f"{digest}{shape and f'.{shape}'}{path.suffix.lower()}"

    def read(self, name: str) -> tuple[LoadedMesh, dict[str, str]] | None:
        """Return the mesh and what it refers to, or None; a broken file is removed."""
        file = self._file(name)
        try:
            blob = file.read_bytes()
            os.utime(file)  # recently used files stay
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
