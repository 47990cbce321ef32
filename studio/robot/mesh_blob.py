"""A loaded mesh as bytes: the form in which it crosses the pipe and lies in the cache."""

from __future__ import annotations

import struct
from dataclasses import dataclass

import msgspec
import numpy as np

from studio.problems import Problem  # noqa: TC001 - msgspec reads it
from studio.robot.loaded_mesh import LoadedMesh
from studio.robot.values import Vector3  # noqa: TC001 - msgspec reads it

BLOB_VERSION = 1
"""Part of the file name in the cache: raise it when the form or what the readers make changes."""
_MAGIC = b"STUDIOMESH\0\1"
_LENGTH = struct.Struct("<I")


@dataclass(frozen=True, slots=True)
class MeshHead:
    """What stands before the arrays of a blob."""

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
    """The mesh and the digests of what it refers to; its arrays look into `blob`, read-only.

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
