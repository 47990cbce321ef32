"""Transforms for tests, and a second opinion on them that shares nothing with the buffer."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from studio.tf.transforms import TransformColumns

if TYPE_CHECKING:
    from collections.abc import Sequence

S = 1_000_000_000
Vector = tuple[float, ...]
Matrix = list[list[float]]


class Told(NamedTuple):
    """One transform, at a time in ns."""

    parent: str
    child: str
    stamp_ns: int = 0
    xyz: Vector = (0.0, 0.0, 0.0)
    wxyz: Vector = (1.0, 0.0, 0.0, 0.0)


def columns(*rows: Told) -> TransformColumns:
    """What a message of these holds."""
    return TransformColumns(
        tuple(row.parent for row in rows),
        tuple(row.child for row in rows),
        np.array([row.stamp_ns for row in rows], np.int64),
        np.array([row.xyz for row in rows], np.float64).reshape(-1, 3),
        np.array([row.wxyz for row in rows], np.float64).reshape(-1, 4),
    )


def about_z(angle_rad: float) -> Vector:
    """A turn to the left, as a quaternion."""
    return (math.cos(angle_rad / 2), 0.0, 0.0, math.sin(angle_rad / 2))


@dataclass
class HandClock:
    """A clock that goes when it is told to."""

    now_ns: int = 1000 * S

    def __call__(self) -> int:
        return self.now_ns


@dataclass
class PlainTransforms:
    """Lists of transforms, composed one after the other by what schools teach."""

    edges: dict[str, tuple[str, list[Told]]] = field(
        default_factory=dict[str, tuple[str, list[Told]]]
    )

    def add(self, told: Told) -> None:
        """Keep one; stamps of an edge come in their order."""
        self.edges.setdefault(told.child, (told.parent, []))[1].append(told)

    def root_from(self, frame: str, stamp_ns: int | None) -> tuple[str, Matrix]:
        """The root, and the matrix from there to the frame; None takes the newest of each."""
        product = [[float(row == column) for column in range(4)] for row in range(4)]
        while frame in self.edges:
            frame, rows = self.edges[frame]
            product = multiplied(_matrix(*_at(rows, stamp_ns)), product)
        return frame, product

    def fixed_from(self, fixed: str, frame: str, stamp_ns: int | None) -> Matrix:
        """The matrix that expresses points of a frame in the fixed frame."""
        fixed_root, root_from_fixed = self.root_from(fixed, stamp_ns)
        root, root_from_frame = self.root_from(frame, stamp_ns)
        assert root == fixed_root
        return multiplied(_inverse(root_from_fixed), root_from_frame)


def matrix_of(wxyz_xyz: Sequence[float]) -> Matrix:
    """The matrix of a pose."""
    return _matrix(tuple(wxyz_xyz[4:]), tuple(wxyz_xyz[:4]))


def multiplied(left: Matrix, right: Matrix) -> Matrix:
    """The product of two matrices (4, 4)."""
    return [
        [sum(left[row][k] * right[k][column] for k in range(4)) for column in range(4)]
        for row in range(4)
    ]


def _at(rows: list[Told], stamp_ns: int | None) -> tuple[Vector, Vector]:
    if stamp_ns is None or len(rows) == 1:
        return rows[-1].xyz, rows[-1].wxyz
    for before, after in itertools.pairwise(rows):
        if before.stamp_ns <= stamp_ns <= after.stamp_ns:
            share = (stamp_ns - before.stamp_ns) / (after.stamp_ns - before.stamp_ns)
            pairs = zip(before.xyz, after.xyz, strict=True)
            return (
                tuple(one + share * (other - one) for one, other in pairs),
                slerp(before.wxyz, after.wxyz, share),
            )
    raise AssertionError(stamp_ns)


def slerp(start: Vector, end: Vector, share: float) -> Vector:
    """Turn from start as far about the axis that leads to the end: of the relative turn."""
    w, x, y, z = _product(end, (start[0], *(-part for part in start[1:])))
    if w < 0:
        w, x, y, z = -w, -x, -y, -z
    sine = math.sqrt(x * x + y * y + z * z)
    if sine < 1e-14:
        return start
    angle = math.atan2(sine, w) * share
    by = math.sin(angle) / sine
    return _product((math.cos(angle), x * by, y * by, z * by), start)


def _product(a: Vector, b: Vector) -> Vector:
    return (
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
        a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
        a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
    )


def _matrix(xyz: Vector, wxyz: Vector) -> Matrix:
    """Column by column: where the quaternion turns the axes, q e q*."""
    back = (wxyz[0], *(-part for part in wxyz[1:]))
    axes = ((0.0, 1.0, 0.0, 0.0), (0.0, 0.0, 1.0, 0.0), (0.0, 0.0, 0.0, 1.0))
    turned = [_product(_product(wxyz, axis), back)[1:] for axis in axes]
    rows = [[turned[column][row] for column in range(3)] + [xyz[row]] for row in range(3)]
    return [*rows, [0.0, 0.0, 0.0, 1.0]]


def _inverse(matrix: Matrix) -> Matrix:
    turned = [[matrix[column][row] for column in range(3)] for row in range(3)]
    rows = [
        [*turned[row], -sum(turned[row][k] * matrix[k][3] for k in range(3))] for row in range(3)
    ]
    return [*rows, [0.0, 0.0, 0.0, 1.0]]
