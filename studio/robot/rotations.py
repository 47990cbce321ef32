"""Rotations over arrays: the few formulas that kinematics and inertia share."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from studio.tf.rotations import quaternions_from_matrices

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

Floats: TypeAlias = "NDArray[np.float64]"


def matrix_from_rpy(rpy_rad: Floats) -> Floats:
    """Rotations (..., 3, 3) of fixed-axis roll, pitch, yaw (..., 3), as URDF writes them."""
    cosines, sines = np.cos(rpy_rad), np.sin(rpy_rad)
    cr, cp, cy = cosines[..., 0], cosines[..., 1], cosines[..., 2]
    sr, sp, sy = sines[..., 0], sines[..., 1], sines[..., 2]
    return _filled(
        (
            (cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr),
            (sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr),
            (-sp, cp * sr, cp * cr),
        )
    )


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
    """Unit quaternions (..., 4) with w >= 0 of rotations (..., 3, 3)."""
    # Products of many rotations drift from length 1.
    found = unit_vectors(quaternions_from_matrices(rotations.reshape(-1, 3, 3)))
    found[found[:, 0] < 0] *= -1.0
    return found.reshape(*rotations.shape[:-2], 4)


def _filled(rows: Sequence[Sequence[Floats]]) -> Floats:
    """Matrices (..., R, C) of R rows of C arrays (...): a quarter of the time of nested stacks."""
    matrices = np.empty((*rows[0][0].shape, len(rows), len(rows[0])))
    for i, row in enumerate(rows):
        for j, values in enumerate(row):
            matrices[..., i, j] = values
    return matrices
