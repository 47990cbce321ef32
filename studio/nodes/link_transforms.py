"""LinkTransforms: joint positions of a robot in, the transforms of its tree out; pure."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from studio.robot.kinematics import Kinematics
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
    """The transforms of one robot, as robot_state_publisher tells them.

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
        """Those that no joint position changes."""
        return self._told(self._still, np.zeros(len(self._column)))

    def moved(self, positions: Mapping[str, float]) -> list[LinkTransform]:
        """Those of the joints whose positions are given (rad or m, by name), and of followers.

        A follower that is given too stands where that says; unknown names and positions that are
        no numbers are left out. Limits are not looked at.
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
        return self._told([self._moving[name] for name in known], values)

    def _told(self, joints: list[tuple[Joint, int]], positions: Floats) -> list[LinkTransform]:
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
    """The joints that mimic, each behind the one that it mimics."""
    ordered: dict[str, Joint] = {}
    for name in movable:
        chain: list[Joint] = []
        joint = robot.joints.get(name)
        while joint is not None and joint.mimic is not None and joint.name not in ordered:
            chain.append(joint)
            joint = robot.joints.get(joint.mimic.joint)
        ordered |= {one.name: one for one in reversed(chain)}
    return list(ordered.values())
