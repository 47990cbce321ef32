"""The ghost of a document: a second robot in its scene, its joints where those of the first are."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from studio.robot.measures import Bounds, box_around
from studio.robot.values import Robot
from studio.scene.graph import STEP

if TYPE_CHECKING:
    from studio.documents.model import Model
    from studio.documents.states.second_robot import SecondRobot
    from studio.robot.kinematics import Floats, Kinematics
    from studio.robot.values import Link, Vector3

_GAP: Final = 0.25
"""Between two robots side by side, of the width of the wider one."""


class Ghost:
    """Shows one second robot over or beside the model's; follows its joints by their names."""

    def __init__(self, model: Model) -> None:
        self._model = model
        self._shown: SecondRobot | None = None
        self._beside = False
        self._alike: tuple[Robot, frozenset[str]] | None = None
        """The robot that the ghost was compared with, and the links that look the same."""
        model.posed = self._pose

    @property
    def shown(self) -> SecondRobot | None:
        """What it shows."""
        return self._shown

    def show(self, second: SecondRobot | None, *, beside: bool) -> None:
        """Show another robot, or none. Over the first one, what is just like that is left out."""
        ghost = self._model.scene.ghost
        if second is None and self._shown is None:
            return
        if second is not self._shown:
            self._shown, self._alike = second, None
            ghost.show(second.robot if second else Robot(""))
        self._beside = beside
        if second is not None:
            ghost.shift(self._offset_m(second) if beside else (0.0, 0.0, 0.0))
        self._model.pose()

    def mesh_bounds(self, uri: str) -> Bounds | None:
        """The box of a mesh that either robot has; None when it has not come."""
        mesh = self._model.scene.mesh(uri)
        return mesh.bounds_m if mesh else None

    def _pose(self, links: tuple[str, ...], wxyz_xyz: Floats) -> None:
        """Put the ghost's links where the joints of the robot put them."""
        second = self._shown
        if second is None or not second.robot.links:
            return
        kinematics, ghost = second.kinematics, self._model.scene.ghost
        poses = kinematics.wxyz_xyz(self._positions(kinematics))
        ghost.set_poses(kinematics.link_names, poses)
        here = dict(zip(links, wxyz_xyz, strict=True))
        there = zip(kinematics.link_names, poses, strict=True)
        alike = frozenset[str]() if self._beside else self._look_alike(second)
        ghost.hide({name for name, pose in there if name in alike and _is_near(pose, here[name])})

    def _look_alike(self, second: SecondRobot) -> frozenset[str]:
        """Links that look the same in both robots; found again only when either changes."""
        ours = self._model.robot
        if self._alike is None or self._alike[0] is not ours:
            theirs = second.robot.links
            same = (
                n for n, one in ours.links.items() if n in theirs and _same_looks(one, theirs[n])
            )
            self._alike = ours, frozenset(same)
        return self._alike[1]

    def _offset_m(self, second: SecondRobot) -> Vector3:
        """To the right of the robot, as it faces x; a motion later does not move it."""
        model = self._model
        low_m, high_m = self._width_m(model.robot, model.kinematics)
        right_m, left_m = self._width_m(second.robot, second.kinematics)
        gap_m = _GAP * max(high_m - low_m, left_m - right_m)
        return (0.0, low_m - left_m - gap_m, 0.0)

    def _width_m(self, robot: Robot, kinematics: Kinematics) -> tuple[float, float]:
        """Least and greatest y of a robot, at zero and as the joints stand."""
        poses = kinematics.zero_positions(), self._positions(kinematics)
        boxes = [box_around(robot, kinematics, pose, self.mesh_bounds) for pose in poses]
        known = [box for box in boxes if box]
        if not known:
            return (-0.5, 0.5)
        return min(low[1] for low, _ in known), max(high[1] for _, high in known)

    def _positions(self, kinematics: Kinematics) -> Floats:
        """Where the joints of the robot stand, for another one that has some of them."""
        positions = self._model.joints.by_name()
        kept = {name: kinematics.clamp(name, positions.get(name, 0.0)) for name in kinematics.free}
        return kinematics.positions_with_mimic(kept)


def _same_looks(one: Link, other: Link) -> bool:
    return one.visuals == other.visuals


def _is_near(one: Floats, other: Floats) -> bool:
    return bool(np.abs(one - other).max() <= STEP)
