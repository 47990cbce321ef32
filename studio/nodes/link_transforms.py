"""The transforms of a robot's tree from its joint positions, and the positions from them; pure."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from studio.robot.kinematics import Kinematics
from studio.robot.rotations import matrix_from_rpy, wxyz_from_matrices
from studio.robot.values import JointType

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from studio.robot.kinematics import Floats
    from studio.robot.values import Joint, Robot


class LinkTransform(NamedTuple):
    """The pose of frame `child` in frame `parent`: metres, and a unit quaternion."""

    parent: str
    child: str
    xyz_m: tuple[float, float, float]
    wxyz: tuple[float, float, float, float]


class LinkTransforms:
    """The transforms of one robot, as robot_state_publisher publishes them.

    Fixed and planar joints are of the first kind, `fixed`; a joint that moves has a transform once
    its position is known; of floating joints somebody else knows where they are.

    Args:
        robot: Of which every joint holds; `kinematics` is its own, if it is at hand.
        frame_prefix: Put before every frame's name.
    """

    def __init__(
        self, robot: Robot, frame_prefix: str = "", kinematics: Kinematics | None = None
    ) -> None:
        self._kinematics = kinematics or Kinematics(robot)
        self._prefix = frame_prefix
        self._column = {name: index for index, name in enumerate(self._kinematics.movable)}
        row = {name: index for index, name in enumerate(self._kinematics.link_names)}
        self._moving = {
            name: (robot.joints[name], row[robot.joints[name].child])
            for name in self._kinematics.movable
        }
        self._followers = _leaders_first(robot, self._kinematics.movable)
        self._still = [
            (joint, row[joint.child])
            for joint in robot.joints.values()
            if joint.name not in self._moving and joint.type is not JointType.FLOATING
        ]

    def fixed(self) -> list[LinkTransform]:
        """Return those that no joint position changes."""
        return self._at(self._still, np.zeros(len(self._column)))

    def moved(self, positions: Mapping[str, float]) -> list[LinkTransform]:
        """Return those of the joints with given positions (rad or m, by name), and of followers.

        A position given for a follower counts; unknown names and positions that are no numbers are
        left out. Limits do not apply.
        """
        known = {
            name: float(value)
            for name, value in positions.items()
            if name in self._column and np.isfinite(value)
        }
        for follower in self._followers:
            mimic = follower.mimic
            if mimic and mimic.joint in known and follower.name not in known:
                known[follower.name] = mimic.multiplier * known[mimic.joint] + mimic.offset
        values = np.zeros(len(self._column))
        for name, value in known.items():
            values[self._column[name]] = value
        return self._at([self._moving[name] for name in known], values)

    def _at(self, joints: list[tuple[Joint, int]], positions: Floats) -> list[LinkTransform]:
        if not joints:
            return []
        poses = self._kinematics.wxyz_xyz_in_parents(positions)
        rows: list[list[float]] = poses[[row for _, row in joints]].tolist()
        return [
            LinkTransform(self._prefix + joint.parent, self._prefix + joint.child, (x, y, z), wxyz)
            for (joint, _), (*quaternion, x, y, z) in zip(joints, rows, strict=True)
            for wxyz in [_four(quaternion)]
        ]


def _four(values: list[float]) -> tuple[float, float, float, float]:
    w, x, y, z = values
    return w, x, y, z


def _leaders_first(robot: Robot, movable: Iterable[str]) -> list[Joint]:
    """Return the joints that mimic, each behind the one that it mimics."""
    ordered: dict[str, Joint] = {}
    for name in movable:
        chain: list[Joint] = []
        joint = robot.joints.get(name)
        while joint is not None and joint.mimic is not None and joint.name not in ordered:
            chain.append(joint)
            joint = robot.joints.get(joint.mimic.joint)
        ordered |= {one.name: one for one in reversed(chain)}
    return list(ordered.values())


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

    Frames may have a prefix, as `r1/wheel`. Of several robots the first that comes is read, but
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
        """Return the joint between the two links, if it is one of the robot that is read."""
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
    """Return the turn about the axis, as near to the limits as whole turns bring it."""
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
