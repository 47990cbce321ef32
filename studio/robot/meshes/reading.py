"""A mesh file to a LoadedMesh: picks the reader, welds, encodes. Runs in the robot worker."""

from __future__ import annotations

import hashlib
from typing import TYPE_CHECKING, Final, TypeVar

import numpy as np

from studio.errors import StudioError
from studio.robot.meshes.collada import read_collada
from studio.robot.meshes.files import encode_texture
from studio.robot.meshes.glb import write_glb
from studio.robot.meshes.gltf import read_gltf
from studio.robot.meshes.loaded_mesh import LoadedMesh
from studio.robot.meshes.obj import read_obj
from studio.robot.meshes.stl import read_stl
from studio.robot.meshes.surfaces import Appearance, Surface, bounds
from studio.robot.meshes.textured import unit_shape
from studio.robot.meshes.welding import Welded, weld

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from numpy.typing import NDArray

    from studio.robot.meshes.files import MeshFiles
    from studio.robot.meshes.surfaces import Floats
    from studio.robot.values import Vector3

Number = TypeVar("Number", np.float32, np.uint8)


def _read_ply(files: MeshFiles) -> list[Surface]:
    from studio.robot.meshes.ply import read_ply  # noqa: PLC0415 - trimesh takes half a second

    return read_ply(files)


_READERS: Final[dict[str, Callable[[MeshFiles], list[Surface]]]] = {
    ".stl": read_stl,
    ".stlb": read_stl,
    ".dae": read_collada,
    ".obj": read_obj,
    ".gltf": read_gltf,
    ".glb": read_gltf,
    ".ply": _read_ply,
}
MESH_SUFFIXES: Final = frozenset(_READERS)
"""In lower case, with their dot."""


def read_mesh(files: MeshFiles) -> LoadedMesh:
    """Read a whole mesh; afterwards `files` has the digests of what it refers to.

    Raises:
        MeshError: It cannot be shown.
    """
    suffix = files.path.suffix
    reader = _READERS.get(suffix.lower())
    if reader is None:
        known = ", ".join(one.removeprefix(".") for one in _READERS)
        raise files.fault(f'"{suffix}" is no mesh format that is read: use {known}.')
    try:
        return _finish(files, reader(files))
    except StudioError:
        raise
    except MemoryError as error:
        raise files.fault("it needs more memory than a mesh may take: simplify it.") from error
    except Exception as error:  # a hostile file must not end the worker with the queue behind it
        reason = f"it cannot be read ({type(error).__name__}: {error})."
        raise files.fault(reason) from error


def read_textured(files: MeshFiles, shape: str) -> LoadedMesh:
    """Return a primitive of unit size with the image `files` on it.

    Raises:
        MeshError: It is no image that can be shown.
    """
    texture = encode_texture(files, files.path.name, files.data)
    if texture is None:
        raise files.fault("it is no image that can be put on a shape.")
    positions, uv = unit_shape(shape)
    return _finish(files, [Surface(positions, uv=uv, appearance=Appearance(texture=texture))])


def _finish(files: MeshFiles, surfaces: list[Surface]) -> LoadedMesh:
    whole = [one.drawable() for one in _merged(surfaces)]
    lost = sum(one.triangle_count for one in surfaces) - sum(one.triangle_count for one in whole)
    if lost:
        files.warn(
            "impossible-triangles",
            f"{lost:,} triangles with impossible coordinates (NaN, infinite) were left out.",
        )
    pieces = [(weld(one), one.appearance) for one in whole if one.triangle_count]
    if not pieces:
        raise files.fault("it holds no triangle that can be drawn.")
    own = any(appearance is not None or welded.colors is not None for welded, appearance in pieces)
    vertices = np.concatenate([welded.vertices for welded, _ in pieces])
    return LoadedMesh(
        _digest_of_all(files),
        vertices,
        _joined_faces([welded for welded, _ in pieces]),
        write_glb(pieces) if own else b"",
        _bounds_m(vertices),
        tuple(files.problems),
    )


def _merged(surfaces: list[Surface]) -> Iterable[Surface]:
    """Merge the surfaces of one appearance: each costs the browser a draw call."""
    groups: dict[tuple[Appearance | None, bool, bool, bool], list[Surface]] = {}
    for one in surfaces:
        key = (one.appearance, one.normals is None, one.uv is None, one.colors is None)
        groups.setdefault(key, []).append(one)
    return [_joined(group) for group in groups.values()]


def _joined(group: list[Surface]) -> Surface:
    if len(group) == 1:
        return group[0]
    return Surface(
        np.concatenate([one.positions for one in group]),
        _concatenated([one.normals for one in group]),
        _concatenated([one.uv for one in group]),
        _concatenated([one.colors for one in group]),
        group[0].appearance,
    )


def _joined_faces(pieces: list[Welded]) -> NDArray[np.uint32]:
    counts = np.array([0, *(len(one.vertices) for one in pieces)], dtype=np.uint32)
    starts = np.cumsum(counts, dtype=np.uint32)[:-1]
    return np.concatenate([one.faces + start for one, start in zip(pieces, starts, strict=True)])


def _digest_of_all(files: MeshFiles) -> str:
    if not files.references:
        return files.digest
    all_of_them = "\n".join((files.digest, *sorted(files.references.values())))
    return hashlib.sha256(all_of_them.encode()).hexdigest()


def _bounds_m(vertices: Floats) -> tuple[Vector3, Vector3]:
    (left, front, bottom), (right, back, top) = bounds(vertices)
    return (left, front, bottom), (right, back, top)


def _concatenated(arrays: list[NDArray[Number] | None]) -> NDArray[Number] | None:
    """Concatenate them, or return None: surfaces of one group have the same streams."""
    given = [one for one in arrays if one is not None]
    return np.concatenate(given) if given else None
