"""The room that shapes take: what a mass can be held against."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from studio.robot.values import Box, Cylinder, Mesh, Sphere

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from studio.robot.loaded_mesh import LoadedMesh
    from studio.robot.values import Collision, Geometry, Visual

    MeshVolumes: TypeAlias = Callable[[str], "Volume | None"]


@dataclass(frozen=True, slots=True)
class Volume:
    """A volume; not exact: of the box around a surface that is not closed, so at most that."""

    volume_m3: float
    is_exact: bool


def shapes_volume(shapes: Sequence[Visual | Collision], of_mesh: MeshVolumes) -> Volume | None:
    """All visuals, or all collisions, of a link; where they overlap, room counts twice.

    Args:
        shapes: Of one link.
        of_mesh: Of a mesh file by its URI, unscaled; None when it is not known.

    Returns:
        None without shapes, and when one of them is not known.
    """
    found = [geometry_volume(shape.geometry, of_mesh) for shape in shapes]
    known = [one for one in found if one is not None]
    if not known or len(known) < len(found):
        return None
    return Volume(math.fsum(one.volume_m3 for one in known), all(one.is_exact for one in known))


def geometry_volume(geometry: Geometry, of_mesh: MeshVolumes) -> Volume | None:
    """Of one shape; arguments as for `shapes_volume`."""
    match geometry:
        case Box((x, y, z)):
            return _exact(x * y * z)
        case Cylinder(radius_m, length_m):
            return _exact(math.pi * radius_m * radius_m * length_m)
        case Sphere(radius_m):
            return _exact(4 / 3 * math.pi * radius_m * radius_m * radius_m)
        case Mesh(uri, (x, y, z)):
            found = of_mesh(uri)
            return found and _finite(Volume(abs(found.volume_m3 * x * y * z), found.is_exact))


def _exact(volume_m3: float) -> Volume | None:
    return _finite(Volume(abs(volume_m3), is_exact=True))


def _finite(found: Volume) -> Volume | None:
    return found if math.isfinite(found.volume_m3) else None


def mesh_volume(mesh: LoadedMesh) -> Volume:
    """What a closed surface encloses, else the box around it.

    Parts that lie inside out count against the others; ones that overlap count twice.
    """
    if is_closed(mesh.vertices, mesh.faces):
        corners = mesh.vertices.astype(np.float64)[mesh.faces]
        corners -= corners[0, 0]  # far from zero the parts would cancel badly
        sixfold = np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2]))
        if sixfold:
            return Volume(abs(float(sixfold)) / 6, is_exact=True)
    low, high = mesh.bounds_m
    return Volume(math.prod(b - a for a, b in zip(low, high, strict=True)), is_exact=False)


def is_closed(vertices: NDArray[np.float32], faces: NDArray[np.uint32]) -> bool:
    """Whether each edge is gone along as often in one direction as in the other.

    Args:
        vertices: Shape (N, 3); vertices at the very same place are one.
        faces: Shape (M, 3), indices into `vertices`.
    """
    place = _places(vertices)[faces]
    begin, end = place.ravel(), np.roll(place, -1, axis=1).ravel()
    edge = np.minimum(begin, end) * np.int64(len(vertices)) + np.maximum(begin, end)
    way = np.sign(end - begin)
    order = np.argsort(edge, kind="stable")
    starts = np.flatnonzero(np.diff(edge[order], prepend=-1))
    return not np.add.reduceat(way[order], starts).any()


def _places(vertices: NDArray[np.float32]) -> NDArray[np.int64]:
    """For each vertex the same number as for all others at its place, (N,)."""
    exact = vertices + np.float32(0.0)  # -0 is 0
    order = np.lexsort(exact.T)
    moved = np.any(np.diff(exact[order], axis=0, prepend=np.nan), axis=1)
    places = np.empty(len(vertices), np.int64)
    places[order] = np.cumsum(moved) - 1
    return places
