"""JointReading: transforms of a robot's tree in, the joint positions that they show out; pure."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from studio.robot.rotations import matrix_from_rpy, wxyz_from_matrices
from studio.robot.values import JointType

if TYPE_CHECKING:
    from collections.abc import Iterable

    from studio.nodes.link_transforms import LinkTransform
    from studio.robot.kinematics import Floats, Kinematics
    from studio.robot.values import Robot


_LIMIT: Final = 1e12


class _Reading(NamedTuple):
    """What is needed to read one joint."""

    name: str
    parent: str
    slides: bool
    axis: Floats
    joint_from_parent: Floats
    """Rotation (3, 3) at zero."""
    joint_from_parent_wxyz: Floats
    origin_m: Floats
    lower: float
    upper: float


class JointReading:
    """Reads revolute, continuous and prismatic joints; what does not fit their axis is left out.

    Frames may have a prefix, as `r1/wheel`. Of several robots the first that is heard is read, but
    frames without a prefix are the robot's own before all others.
    """

    def __init__(self, robot: Robot, kinematics: Kinematics) -> None:
        self._prefix: str | None = None
        self._by_child: dict[str, _Reading] = {}
        for column, name in enumerate(kinematics.movable):
            joint = robot.joints[name]
            rotation = matrix_from_rpy(np.array(joint.origin.rpy, np.float64)).T
            self._by_child[joint.child] = _Reading(
                name,
                joint.parent,
                joint.type is JointType.PRISMATIC,
                np.array(kinematics.axis_of(name)),
                rotation,
                wxyz_from_matrices(rotation),
                np.array(joint.origin.xyz),
                float(kinematics.lower[column]),
                float(kinematics.upper[column]),
            )

    def positions(self, transforms: Iterable[LinkTransform]) -> dict[str, float]:
        """Position of each joint whose transform is among these, rad or m, by name."""
        found: dict[str, float] = {}
        for one in transforms:
            reading = self._reading_of(one)
            if reading is None or not _is_sound(one):
                continue
            value = _distance_m(reading, one) if reading.slides else _angle_rad(reading, one)
            if math.isfinite(value):
                found[reading.name] = value
        return found

    def _reading_of(self, one: LinkTransform) -> _Reading | None:
        """Of the joint between the two links, if they are those of the robot that is read."""
        link = one.child if one.child in self._by_child else one.child.rpartition("/")[2]
        reading = self._by_child.get(link)
        if reading is None:
            return None
        prefix = one.child.removesuffix(link)
        if one.parent != prefix + reading.parent:
            return None
        if self._prefix is None or not prefix:
            self._prefix = prefix
        return reading if prefix == self._prefix else None


def _is_sound(one: LinkTransform) -> bool:
    """Whether it can be reckoned with; NaN is below nothing."""
    return all(abs(value) < _LIMIT for value in (*one.xyz_m, *one.wxyz))


def _distance_m(reading: _Reading, one: LinkTransform) -> float:
    moved_m = reading.joint_from_parent @ (np.array(one.xyz_m) - reading.origin_m)
    return float(moved_m @ reading.axis)


def _angle_rad(reading: _Reading, one: LinkTransform) -> float:
    """The turn about the axis, as near to the limits as whole turns bring it."""
    w, *vector = _product(reading.joint_from_parent_wxyz, np.array(one.wxyz))
    along = float(np.dot(vector, reading.axis))
    if along == 0 and w == 0:
        return math.nan
    angle = math.remainder(2 * math.atan2(along, float(w)), 2 * math.pi)
    if angle < reading.lower and angle + 2 * math.pi <= reading.upper:
        return angle + 2 * math.pi
    if angle > reading.upper and angle - 2 * math.pi >= reading.lower:
        return angle - 2 * math.pi
    return angle


def _product(left: Floats, right: Floats) -> tuple[float, float, float, float]:
    """Product of two quaternions w, x, y, z."""
    a, b, c, d = left
    w, x, y, z = right
    return (
        a * w - b * x - c * y - d * z,
        a * x + b * w + c * z - d * y,
        a * y - b * z + c * w + d * x,
        a * z + b * y - c * x + d * w,
    )
