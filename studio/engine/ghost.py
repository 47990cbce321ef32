"""The ghost of a document: a second robot in its scene, its joints where those of the first are."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from studio.robot.measures import Bounds, box_around
from studio.robot.values import Robot

if TYPE_CHECKING:
    from studio.engine.model import Model
    from studio.engine.second_robot import SecondRobot
    from studio.robot.values import Vector3

_GAP: Final = 0.25
"""Between two robots side by side, of the width of the wider one."""


class Ghost:
    """Shows one second robot over or beside the model's; follows its joints by their names."""

    def __init__(self, model: Model) -> None:
        self._model = model
        self._shown: SecondRobot | None = None
        model.posed = self._pose

    @property
    def shown(self) -> SecondRobot | None:
        """What it shows."""
        return self._shown

    def show(self, second: SecondRobot | None, *, beside: bool) -> None:
        """Show another robot, or none."""
        ghost = self._model.scene.ghost
        if second is not self._shown:
            self._shown = second
            ghost.show(second.robot if second else Robot(""))
        if second is not None:
            ghost.shift(self._offset_m(second) if beside else (0.0, 0.0, 0.0))
            self._pose()
        self._model.scene.flush()

    def mesh_bounds(self, uri: str) -> Bounds | None:
        """The box of a mesh that either robot has; None when it has not come."""
        mesh = self._model.scene.mesh(uri)
        return mesh.bounds_m if mesh else None

    def _pose(self) -> None:
        second = self._shown
        if second is None or not second.robot.links:
            return
        kinematics, positions = second.kinematics, self._model.joints.by_name()
        kept = {
            name: kinematics.clamp(name, positions[name])
            for name in kinematics.free
            if name in positions
        }
        poses = kinematics.wxyz_xyz(kinematics.positions_with_mimic(kept))
        self._model.scene.ghost.set_poses(kinematics.link_names, poses)

    def _offset_m(self, second: SecondRobot) -> Vector3:
        """To the right of the robot, as it faces x: at zero, so that no motion moves it."""
        model = self._model
        here = box_around(
            model.robot, model.kinematics, model.kinematics.zero_positions(), self.mesh_bounds
        )
        there = box_around(
            second.robot, second.kinematics, second.kinematics.zero_positions(), self.mesh_bounds
        )
        right_m, here_m = (here[0][1], here[1][1] - here[0][1]) if here else (-0.5, 1.0)
        left_m, there_m = (there[1][1], there[1][1] - there[0][1]) if there else (0.5, 1.0)
        return (0.0, right_m - left_m - _GAP * max(here_m, there_m), 0.0)
