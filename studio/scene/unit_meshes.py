"""Meshes that fit into a cube of 1 m: one of them is drawn many times, each in its own size."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Final, Literal, TypeAlias

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

Kind: TypeAlias = Literal["box", "sphere", "cylinder", "cone"]
_SEGMENTS: Final = 24
"""Of a circle."""


@dataclass(frozen=True, slots=True, eq=False)
class UnitMesh:
    """Triangles; a corner that an edge runs through is there once for each side of the edge.

    Attributes:
        vertices: Shape (V, 3), float32, m; read-only.
        faces: Shape (F, 3), uint32, seen from outside against the clock; read-only.
    """

    vertices: NDArray[np.float32]
    faces: NDArray[np.uint32]


@cache
def unit_mesh(kind: Kind) -> UnitMesh:
    """A box, ball or cylinder around the origin, or a cone from its tip there to its base at z = 1.

    All reach 0.5 m from the z axis.
    """
    vertices, faces = _MAKERS[kind]()
    points = np.array(vertices, dtype=np.float32).reshape(-1, 3)
    triangles = np.array(faces, dtype=np.uint32).reshape(-1, 3)
    points.setflags(write=False)
    triangles.setflags(write=False)
    return UnitMesh(points, triangles)


def _box() -> tuple[NDArray[np.float64], NDArray[np.intp]]:
    """Each side has corners of its own, or its edges would look round."""
    square = np.array([[-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1]]) / 2
    sides: list[NDArray[np.float64]] = []
    for axis in range(3):
        upper = np.roll(square, axis + 1, axis=1)
        sides += [upper, -upper[::-1]]
    return np.concatenate(sides), _quads(np.arange(24).reshape(6, 4))


def _quads(corners: NDArray[np.intp]) -> NDArray[np.intp]:
    """Two triangles for each row of four corners."""
    return np.concatenate([corners[:, [0, 1, 2]], corners[:, [0, 2, 3]]])


def _sphere() -> tuple[NDArray[np.float64], NDArray[np.intp]]:
    """Rings of corners from pole to pole."""
    rings = _SEGMENTS // 2
    polar, turn = np.meshgrid(
        np.linspace(0, np.pi, rings + 1), np.linspace(0, 2 * np.pi, _SEGMENTS, endpoint=False)
    )
    polar, turn = polar.T, turn.T
    points = np.stack([np.sin(polar) * np.cos(turn), np.sin(polar) * np.sin(turn), np.cos(polar)])
    return points.reshape(3, -1).T / 2, _rings(rings + 1)


def _rings(count: int) -> NDArray[np.intp]:
    """Triangles between rings of `_SEGMENTS` corners each, the upper ring first."""
    row, column = np.mgrid[: count - 1, :_SEGMENTS]
    beside = (column + 1) % _SEGMENTS
    upper, lower = row * _SEGMENTS, (row + 1) * _SEGMENTS
    corners = np.stack([upper + column, lower + column, lower + beside, upper + beside], axis=-1)
    return _quads(corners.reshape(-1, 4))


def _circle(z_m: float) -> NDArray[np.float64]:
    turn = np.linspace(0, 2 * np.pi, _SEGMENTS, endpoint=False)
    return np.stack([np.cos(turn) / 2, np.sin(turn) / 2, np.full(_SEGMENTS, z_m)], axis=1)


def _fan(first: int, *, down: bool) -> NDArray[np.intp]:
    """A round plate of corners from `first` on."""
    near = np.arange(1, _SEGMENTS - 1)
    corners = np.stack([np.zeros_like(near), near, near + 1], axis=1) + first
    return corners[:, ::-1] if down else corners


def _cylinder() -> tuple[NDArray[np.float64], NDArray[np.intp]]:
    top, bottom = _circle(0.5), _circle(-0.5)
    faces = [_rings(2), _fan(2 * _SEGMENTS, down=False), _fan(3 * _SEGMENTS, down=True)]
    return np.concatenate([top, bottom, top, bottom]), np.concatenate(faces)


def _cone() -> tuple[NDArray[np.float64], NDArray[np.intp]]:
    """The tip is there once for each segment, so that light runs evenly around it."""
    base, tips = _circle(1.0), np.zeros((_SEGMENTS, 3))
    near = np.arange(_SEGMENTS)
    sides = np.stack([near, near + _SEGMENTS, (near + 1) % _SEGMENTS], axis=1)
    return np.concatenate([base, tips, base]), np.concatenate(
        [sides, _fan(2 * _SEGMENTS, down=False)]
    )


_MAKERS: Final[dict[Kind, Callable[[], tuple[NDArray[np.float64], NDArray[np.intp]]]]] = {
    "box": _box,
    "sphere": _sphere,
    "cylinder": _cylinder,
    "cone": _cone,
}
