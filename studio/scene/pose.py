"""Poses of URDF as viser takes them."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import TYPE_CHECKING

from studio.robot.rotations import rows_of_turn, wxyz_from_matrices
from studio.tf.rotations import turned

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from studio.robot.values import Origin, Vector3
    from studio.scene.node import Quaternion


@lru_cache(maxsize=1 << 12)  # an edit turns few of the shapes that it draws
def wxyz_from_rpy(rpy_rad: Vector3) -> Quaternion:
    """Unit quaternion of fixed-axis roll, pitch, yaw; angles that are no numbers count as 0."""
    roll, pitch, yaw = (angle / 2 if math.isfinite(angle) else 0.0 for angle in rpy_rad)
    cr, cp, cy = math.cos(roll), math.cos(pitch), math.cos(yaw)
    sr, sp, sy = math.sin(roll), math.sin(pitch), math.sin(yaw)
    return (
        cr * cp * cy + sr * sp * sy,
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
    )


def rows_from_rpy(rpy_rad: Vector3) -> tuple[Vector3, Vector3, Vector3]:
    """The rotation matrix of fixed-axis roll, pitch, yaw, row by row."""
    roll, pitch, yaw = (angle if math.isfinite(angle) else 0.0 for angle in rpy_rad)
    cosines = math.cos(roll), math.cos(pitch), math.cos(yaw)
    return rows_of_turn(cosines, (math.sin(roll), math.sin(pitch), math.sin(yaw)))


def wxyz_and_position(origin: Origin) -> tuple[Quaternion, Vector3]:
    """The pose of an `<origin>`."""
    return wxyz_from_rpy(origin.rpy), origin.xyz


def wxyz_and_translation(a_from_b: NDArray[np.float64]) -> tuple[Quaternion, Vector3]:
    """The pose of a matrix (4, 4)."""
    w, x, y, z = wxyz_from_matrices(a_from_b[:3, :3]).tolist()
    at_x, at_y, at_z = a_from_b[:3, 3].tolist()
    return (w, x, y, z), (at_x, at_y, at_z)


def rotated(wxyz: Quaternion, point: Vector3) -> Vector3:
    """A point turned about the origin by a quaternion of length 1."""
    return turned(wxyz, *point)
