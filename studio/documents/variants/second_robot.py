"""A second robot beside the one that is edited: worked out from another state, shown as a ghost."""

from __future__ import annotations

import asyncio
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from studio.description.values import Expansion, OpenRequest
from studio.documents.sites import argument_values
from studio.robot.assembly import assembled
from studio.robot.kinematics import Kinematics
from studio.robot.measures import Bounds, box_around
from studio.robot.values import Robot
from studio.scene.graph import STEP

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from studio.description.client import DescriptionWorker
    from studio.documents.model import Model
    from studio.documents.runs import LastRun
    from studio.documents.sites import SiteTable
    from studio.documents.variants.recipes import Recipe
    from studio.documents.workspace import Workspace
    from studio.robot.kinematics import Floats
    from studio.robot.values import Link, Vector3


@dataclass(frozen=True, slots=True, eq=False)
class SecondRobot:
    """The robot of a recipe; one without links if the recipe cannot be run."""

    recipe: Recipe
    robot: Robot
    kinematics: Kinematics
    arguments: Mapping[str, str]
    """Value of each argument, passed or not."""
    files: tuple[str, ...] = ()
    """Every file that was read."""
    fault: str = ""
    """Why there is no robot, a sentence."""


class SecondRobots:
    """Runs recipes in a worker of its own, one after the other; the document's is not disturbed.

    Args:
        workspace: What is run, and what it may read.
        last_run: Made the present robot.
        model: The present robot.
        sites: What its arguments came to.
        take_worker: Gives a worker; asked for at the first run.
    """

    def __init__(
        self,
        workspace: Workspace,
        last_run: LastRun,
        model: Model,
        sites: SiteTable,
        take_worker: Callable[[], DescriptionWorker],
    ) -> None:
        self._workspace, self._last_run, self._model = workspace, last_run, model
        self._sites, self._take_worker = sites, take_worker
        self._worker: DescriptionWorker | None = None

    @property
    def has_present(self) -> bool:
        """Whether any run made a robot."""
        return self._last_run.expansion is not None

    def present(self, recipe: Recipe) -> SecondRobot:
        """Return the robot that is edited, as the last good run made it."""
        model, last = self._model, self._last_run
        values = self._sites.argument_values()
        fault = "The robot as it is now does not run: its last good state is compared."
        return SecondRobot(
            recipe,
            model.robot,
            model.kinematics,
            values,
            last.files,
            fault if last.failed else "",
        )

    async def made(self, recipe: Recipe, overlay: Mapping[str, bytes]) -> SecondRobot:
        """Run a recipe; whatever goes wrong is in the answer."""
        if self._worker is None:
            self._worker = self._take_worker()
        entry, policy = self._workspace.path, self._workspace.policy
        answer = await self._worker.open(
            OpenRequest(entry, recipe.arguments, policy, dict(overlay))
        )
        if isinstance(answer, Expansion):
            return await asyncio.to_thread(_assembled, recipe, answer)
        robot = Robot("")
        return SecondRobot(recipe, robot, Kinematics(robot), {}, answer.files, str(answer.problem))

    async def close(self) -> None:
        """End the worker; the next run takes another."""
        worker, self._worker = self._worker, None
        if worker is not None:
            await worker.close()


def _assembled(recipe: Recipe, expansion: Expansion) -> SecondRobot:
    robot, fault = assembled(expansion)
    values = argument_values(expansion.changed_sites)
    return SecondRobot(recipe, robot, Kinematics(robot), values, expansion.files, fault)


_GAP: Final = 0.25
"""Between two robots side by side, as a share of the wider one's width."""


class Ghost:
    """Shows one second robot over or beside the model's; follows its joints by their names."""

    def __init__(self, model: Model) -> None:
        self._model = model
        self._shown: SecondRobot | None = None
        self._beside = False
        self._alike: tuple[Robot, frozenset[str]] | None = None
        """The robot that the ghost was compared with, and the links that look the same."""

    @property
    def shown(self) -> SecondRobot | None:
        """The robot that it shows."""
        return self._shown

    @property
    def is_visible(self) -> bool:
        """Whether the display settings show it."""
        return bool(self._model.scene.displays()["ghost"]["visible"])

    @property
    def is_beside(self) -> bool:
        """Whether the display settings put it beside the robot, not over it."""
        return bool(self._model.scene.displays()["ghost"]["beside"])

    def show(self, second: SecondRobot | None, *, beside: bool) -> None:
        """Show another robot, or none. Over the first one, what is just like that is left out."""
        ghost = self._model.scene.ghost
        if second is None and self._shown is None:
            return
        if second is not self._shown:
            self._shown, self._alike = second, None
            self._model.posed = self._pose if second else None
            ghost.show(second.robot if second else Robot(""))
        self._beside = beside
        if second is not None:
            ghost.shift(self._offset_m(second) if beside else (0.0, 0.0, 0.0))
        self._model.pose()

    def mesh_bounds(self, uri: str) -> Bounds | None:
        """Return the box of a mesh that either robot has; None when it has not come."""
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
        alike = frozenset[str]() if self._beside else self._same_in_both(second)
        ghost.hide({name for name, pose in there if name in alike and _is_near(pose, here[name])})

    def _same_in_both(self, second: SecondRobot) -> frozenset[str]:
        """Return links that look the same in both robots; cached until either changes."""
        ours = self._model.robot
        if self._alike is None or self._alike[0] is not ours:
            theirs = second.robot.links
            same = (n for n, one in ours.links.items() if n in theirs and _is_alike(one, theirs[n]))
            self._alike = ours, frozenset(same)
        return self._alike[1]

    def _offset_m(self, second: SecondRobot) -> Vector3:
        """Offset to the right of the robot as it faces x; later motion does not change it."""
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
        """Return the robot's joint positions for another one that has some of its joints."""
        positions = self._model.joints.by_name()
        kept = {name: kinematics.clamp(name, positions.get(name, 0.0)) for name in kinematics.free}
        return kinematics.positions_with_mimic(kept)


def _is_alike(one: Link, other: Link) -> bool:
    return one.visuals == other.visuals


def _is_near(one: Floats, other: Floats) -> bool:
    return bool(np.abs(one - other).max() <= STEP)
