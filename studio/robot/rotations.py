"""Rotations over arrays: the few formulas that kinematics and inertia share."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

Floats: TypeAlias = "NDArray[np.float64]"


def matrix_from_rpy(rpy_rad: Floats) -> Floats:
    """Rotations (..., 3, 3) of fixed-axis roll, pitch, yaw (..., 3), as URDF writes them."""
    (cr, cp, cy), (sr, sp, sy) = (
        np.moveaxis(one, -1, 0) for one in (np.cos(rpy_rad), np.sin(rpy_rad))
    )
    rows = (
        (cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr),
        (sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr),
        (-sp, cp * sr, cp * cr),
    )
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def unit_vectors(vectors: Floats) -> Floats:
    """Vectors (..., 3) at length 1; a zero vector stays zero."""
    lengths = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return vectors / np.where(lengths > 0, lengths, 1.0)


def cross_matrices(vectors: Floats) -> Floats:
    """Matrices (..., 3, 3) that multiply as the cross product with each vector (..., 3)."""
    x, y, z = np.moveaxis(vectors, -1, 0)
    zero = np.zeros_like(x)
    rows = ((zero, -z, y), (z, zero, -x), (-y, x, zero))
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


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
    s = np.moveaxis(squares, -1, 0)
    rows = ((s[0], wx, wy, wz), (wx, s[1], xy, xz), (wy, xy, s[2], yz), (wz, xz, yz, s[3]))
    candidates = np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)
    best = np.argmax(squares, axis=-1)[..., None, None]
    chosen: Floats = np.take_along_axis(candidates, best, axis=-2)[..., 0, :]
    chosen = chosen / np.linalg.norm(chosen, axis=-1, keepdims=True)
    return np.where(chosen[..., :1] < 0, -chosen, chosen)
