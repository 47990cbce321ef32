"""Rotations over arrays: the few formulas that kinematics and inertia share."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

Floats: TypeAlias = "NDArray[np.float64]"


def matrix_from_rpy(rpy_rad: Floats) -> Floats:
    """Rotations (..., 3, 3) of fixed-axis roll, pitch, yaw (..., 3), as URDF writes them."""
    cosines, sines = np.cos(rpy_rad), np.sin(rpy_rad)
    cr, cp, cy = cosines[..., 0], cosines[..., 1], cosines[..., 2]
    sr, sp, sy = sines[..., 0], sines[..., 1], sines[..., 2]
    rows = (
        (cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr),
        (sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr),
        (-sp, cp * sr, cp * cr),
    )
    return _filled(rows)


def unit_vectors(vectors: Floats) -> Floats:
    """Vectors (..., 3) at length 1; a zero vector stays zero."""
    lengths = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return vectors / np.where(lengths > 0, lengths, 1.0)


def cross_matrices(vectors: Floats) -> Floats:
    """Matrices (..., 3, 3) that multiply as the cross product with each vector (..., 3)."""
    x, y, z = vectors[..., 0], vectors[..., 1], vectors[..., 2]
    zero = np.zeros_like(x)
    return _filled(((zero, -z, y), (z, zero, -x), (-y, x, zero)))


def wxyz_from_matrices(rotations: Floats) -> Floats:
    """Unit quaternions (..., 4) with w >= 0 of rotations (..., 3, 3).

    Of the four ways to write it, each row takes the one with the largest divisor (Shepperd).
    """
    m = rotations
    xx, yy, zz = m[..., 0, 0], m[..., 1, 1], m[..., 2, 2]
    squares = np.stack((1 + xx + yy + zz, 1 + xx - yy - zz, 1 - xx + yy - zz, 1 - xx - yy + zz), -1)
    wx, wy, wz = (
        m[..., 2, 1] - m[..., 1, 2],
        m[..., 0, 2] - m[..., 2, 0],
        m[..., 1, 0] - m[..., 0, 1],
    )
    xy, xz, yz = (
        m[..., 0, 1] + m[..., 1, 0],
        m[..., 0, 2] + m[..., 2, 0],
        m[..., 1, 2] + m[..., 2, 1],
    )
    ww, ii, jj, kk = (squares[..., i] for i in range(4))
    candidates = _filled(((ww, wx, wy, wz), (wx, ii, xy, xz), (wy, xy, jj, yz), (wz, xz, yz, kk)))
    best = np.argmax(squares, axis=-1)[..., None, None]
    chosen: Floats = np.take_along_axis(candidates, best, axis=-2)[..., 0, :]
    chosen = chosen / np.linalg.norm(chosen, axis=-1, keepdims=True)
    return np.where(chosen[..., :1] < 0, -chosen, chosen)


def _filled(rows: Sequence[Sequence[Floats]]) -> Floats:
    """Matrices (..., R, C) of R rows of C arrays (...): a quarter of the time of nested stacks."""
    matrices = np.empty((*rows[0][0].shape, len(rows), len(rows[0])))
    for i, row in enumerate(rows):
        for j, values in enumerate(row):
            matrices[..., i, j] = values
    return matrices
