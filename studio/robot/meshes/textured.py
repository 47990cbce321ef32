"""Primitives with an image on them: how they are named, and their shapes of unit size.

A textured box, cylinder or sphere is drawn as a mesh of unit size, scaled by its node. Its URI is
`textured-<shape>:<URI of the image>`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from studio.robot.values import Box, Cylinder, Mesh, Sphere

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from studio.robot.values import Geometry, Link, Material, Vector3

_SCHEME = "textured-"
_AROUND = 48
_UP = 24
_QUAD = np.array([0, 1, 2, 0, 2, 3])
_SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])


def textured_uri(geometry: Geometry, material: Material | None) -> str:
    """Return the URI of a primitive with an image on it; empty when it has none, or is a mesh."""
    if material is None or not material.texture_uri or isinstance(geometry, Mesh):
        return ""
    return f"{_SCHEME}{type(geometry).__name__.lower()}:{material.texture_uri}"


def split_textured(uri: str) -> tuple[str, str]:
    """Return a textured primitive's shape and image; for a mesh file "" and the URI."""
    if not uri.startswith(_SCHEME):
        return "", uri
    shape, _, image = uri.removeprefix(_SCHEME).partition(":")
    return shape, image


def mesh_uris(link: Link, *, collisions: bool = True) -> Iterator[str]:
    """Yield every mesh file and textured primitive that a link is drawn with."""
    for visual in link.visuals:
        if isinstance(visual.geometry, Mesh):
            yield visual.geometry.uri
        elif uri := textured_uri(visual.geometry, visual.material):
            yield uri
    for collision in link.collisions if collisions else ():
        if isinstance(collision.geometry, Mesh):
            yield collision.geometry.uri


def scale_of(geometry: Geometry) -> Vector3:
    """Return the scale of a unit shape."""
    match geometry:
        case Box(size_m):
            return size_m
        case Cylinder(radius_m, length_m):
            return (2 * radius_m, 2 * radius_m, length_m)
        case Sphere(radius_m):
            return (2 * radius_m, 2 * radius_m, 2 * radius_m)
        case Mesh():
            return geometry.scale


def unit_shape(shape: str) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Corners (3 M, 3) and image coordinates (3 M, 2) of a shape of size 1, centred.

    The image covers each side of a box, goes once round a cylinder and a sphere, and lies flat on
    the ends of a cylinder.

    Raises:
        KeyError: There is no such shape.
    """
    corners, uv = {"box": _box, "cylinder": _cylinder, "sphere": _sphere}[shape]()
    return corners.astype(np.float32), uv.astype(np.float32)


def _box() -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    sides = [
        (np.array(right), np.array(up))
        for right, up in (
            ((0, 1, 0), (0, 0, 1)),
            ((0, -1, 0), (0, 0, 1)),
            ((-1, 0, 0), (0, 0, 1)),
            ((1, 0, 0), (0, 0, 1)),
            ((0, 1, 0), (-1, 0, 0)),
            ((0, 1, 0), (1, 0, 0)),
        )
    ]
    around = 2 * _SQUARE[_QUAD] - 1
    corners = [
        (np.cross(right, up) + around[:, :1] * right + around[:, 1:] * up) / 2
        for right, up in sides
    ]
    return np.concatenate(corners), np.tile(_SQUARE[_QUAD], (6, 1))


def _cylinder() -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    angle = np.linspace(0, 2 * np.pi, _AROUND + 1)
    ring = np.stack([np.cos(angle), np.sin(angle)], axis=1) / 2
    side, side_uv = _wrapped(np.stack([ring, ring], axis=1), np.array([-0.5, 0.5]))
    ends = [_end(ring, 0.5), _end(ring[::-1], -0.5)]
    return (
        np.concatenate([side, *(corners for corners, _ in ends)]),
        np.concatenate([side_uv, *(uv for _, uv in ends)]),
    )


def _end(ring: NDArray[np.float64], z: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return one end as a fan round its middle."""
    flat = np.stack([np.zeros_like(ring[:-1]), ring[:-1], ring[1:]], axis=1).reshape(-1, 2)
    return np.column_stack([flat, np.full(len(flat), z)]), flat + 0.5


def _sphere() -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    angle = np.linspace(0, 2 * np.pi, _AROUND + 1)
    height = np.linspace(-np.pi / 2, np.pi / 2, _UP + 1)
    ring = np.stack([np.cos(angle), np.sin(angle)], axis=1) / 2
    rings = ring[:, None, :] * np.cos(height)[None, :, None]
    return _wrapped(rings, np.sin(height) / 2)


def _wrapped(
    rings: NDArray[np.float64], z: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return a grid of quads: `rings` (around + 1, levels, 2) at heights `z`, image once round."""
    around, levels = rings.shape[0] - 1, len(z)
    points = np.concatenate(
        [rings, np.broadcast_to(z[None, :, None], (around + 1, levels, 1))], axis=2
    )
    grid = np.stack(
        np.meshgrid(np.linspace(0, 1, around + 1), np.linspace(0, 1, levels), indexing="ij"), axis=2
    )

    def quads(values: NDArray[np.float64]) -> NDArray[np.float64]:
        four = [values[:-1, :-1], values[1:, :-1], values[1:, 1:], values[:-1, 1:]]
        stacked = np.stack(four, axis=2).reshape(-1, 4, values.shape[2])
        return stacked[:, _QUAD].reshape(-1, values.shape[2])

    return quads(points), quads(grid)
