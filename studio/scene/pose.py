"""Poses of URDF as viser takes them."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from studio.robot.values import Origin, Vector3
    from studio.scene.node import Quaternion


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


def wxyz_and_position(origin: Origin) -> tuple[Quaternion, Vector3]:
    """The pose of an `<origin>`."""
    return wxyz_from_rpy(origin.rpy), origin.xyz
