"""The robot of a document: from its parts to the scene, where only what changed moves on."""

from __future__ import annotations

import struct
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from studio.robot.assembly import Assembly, Change
from studio.robot.kinematics import Kinematics
from studio.robot.meshes.textured import mesh_uris
from studio.robot.values import Robot

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Set

    from numpy.typing import NDArray

    from studio.description.values import Expansion, Part
    from studio.problems import Problem
    from studio.robot.kinematics import Floats
    from studio.scene import DocumentScene


_JOINTS_FRAME: Final = struct.Struct("<BxxxI")
JOINTS_FRAME_KIND: Final = 1
_POSITION_LIMIT: Final = 1e9
"""rad or m that no robot is at: beyond it poses are no numbers any more."""


class JointPositions:
    """Positions of the movable joints, rad or m, kept by name so that they outlive the model."""

    def __init__(self, kinematics: Kinematics) -> None:
        self._remembered: dict[str, float] = {}
        self._rng = np.random.default_rng()
        self.kinematics = kinematics
        self.adopt(kinematics)

    def adopt(self, kinematics: Kinematics) -> None:
        """Go on with another model: joints of the same name stay where they are, in its limits."""
        before, self.kinematics = self.kinematics, kinematics
        if kinematics is not before and kinematics.reaches_as(before):
            return
        at_zero = zip(kinematics.movable, kinematics.zero_positions(), strict=True)
        kept = {
            name: kinematics.clamp(name, self._remembered.get(name, float(position)))
            for name, position in at_zero
        }
        self._set_all(kinematics.positions_with_mimic(kept))

    def set(self, positions: Mapping[str, float]) -> None:
        """Move some joints, clamped to their limits; unknown and following joints are ignored."""
        free = set(self.kinematics.free)
        asked = {
            name: self.kinematics.clamp(name, value)
            for name, value in positions.items()
            if name in free and np.isfinite(value)
        }
        self._set_all(self.kinematics.positions_with_mimic(self.by_name() | asked))

    def follow(self, positions: Mapping[str, float]) -> None:
        """Take the positions of a running robot, even beyond the limits of the model."""
        free = set(self.kinematics.free)
        reported = {
            name: value
            for name, value in positions.items()
            if name in free and abs(value) < _POSITION_LIMIT
        }
        self._set_all(self.kinematics.positions_with_mimic(self.by_name() | reported))

    def zero(self) -> None:
        """Move all joints to zero, or to the nearest position within the limits."""
        self._set_all(self.kinematics.zero_positions())

    def randomize(self) -> None:
        """Move all joints to random positions within the limits."""
        self._set_all(self.kinematics.random_positions(self._rng))

    def swing(self, time_s: float, start: NDArray[np.float64]) -> None:
        """Move the joints to where they are `time_s` into a swing that began at `start`."""
        self._set_all(self.kinematics.swing(time_s, start))

    def by_name(self) -> dict[str, float]:
        """Position of every movable joint of the model."""
        return dict(zip(self.kinematics.movable, self.values.tolist(), strict=True))

    def frame(self, revision: int) -> bytes:
        """Return positions as a packed frame: kind, 3 pad bytes, revision (u32), float64 each."""
        return _JOINTS_FRAME.pack(JOINTS_FRAME_KIND, revision) + self.values.tobytes()

    def _set_all(self, values: NDArray[np.float64]) -> None:
        self.values = np.ascontiguousarray(values, dtype="<f8")
        self._remembered |= self.by_name()


@dataclass(frozen=True, slots=True)
class Taken:
    """The result of a run, after the model has taken it."""

    structural: bool
    problems: tuple[Problem, ...]
    """All present problems of the robot."""
    new_meshes: bool
    """The robot names other meshes than before."""


class Model:
    """Assembly, kinematics and joint positions of one robot, and the scene that shows it."""

    def __init__(self, scene: DocumentScene) -> None:
        self.scene = scene
        self.assembly = Assembly()
        self.kinematics = Kinematics(Robot(""))
        self.joints = JointPositions(self.kinematics)
        self.revision = 0
        """Counts structural changes."""
        self.posed: Callable[[tuple[str, ...], Floats], None] | None = None
        """Called with the links and their poses whenever they were moved, before that is sent."""
        self._meshes: dict[str, tuple[str, ...]] = {}
        """The meshes of each link."""

    @property
    def robot(self) -> Robot:
        """The last good robot; without links before the first."""
        return self.assembly.robot

    def take(self, expansion: Expansion) -> Taken:
        """Take in a run and show what it changed."""
        self.assembly.rename(expansion.robot_name)
        change = self.assembly.apply(expansion.part_order, expansion.changed_parts)
        if change.kept_last_good:
            return Taken(structural=False, problems=change.problems, new_meshes=False)
        if change.structural or change.changed_joints:
            self.kinematics = (
                Kinematics(change.robot)
                if change.structural
                else self.kinematics.refitted(change.robot, change.changed_joints)
            )
            self.joints.adopt(self.kinematics)
            self.revision += change.structural
        links = change.changed_links | self._axes_of(change)
        self.scene.show(change.robot, links, same_meshes=change.only_numbers)
        self.pose()
        new_meshes = not change.only_numbers and self._note_meshes(change.robot)
        return Taken(change.structural, change.problems, new_meshes)

    def _note_meshes(self, robot: Robot) -> bool:
        """Note which meshes each link names; whether any is other than before."""
        before, links = self._meshes, robot.links.items()
        self._meshes = {name: tuple(mesh_uris(link)) for name, link in links}
        return self._meshes != before

    def pose(self) -> None:
        """Send the links to where the joint positions put them."""
        links = self.kinematics.link_names
        poses = self.kinematics.wxyz_xyz(self.joints.values)
        self.scene.set_poses(links, poses)
        if self.posed is not None:
            self.posed(links, poses)
        self.scene.flush()

    def mesh_uris(self) -> Set[str]:
        """Return every mesh that the robot names, in the order of its links."""
        return dict.fromkeys(uri for uris in self._meshes.values() for uri in uris).keys()

    def mesh_users(self) -> dict[str, Part]:
        """For each mesh, the first link that uses it, as written."""
        users: dict[str, Part] = {}
        for link, uris in self._meshes.items():
            if uris and (part := self.assembly.part(f"link:{link}")):
                for uri in uris:
                    users.setdefault(uri, part)
        return users

    def _axes_of(self, change: Change) -> frozenset[str]:
        """Return links whose drawn joint axis changed: the children of the changed joints."""
        joints = change.robot.joints
        return frozenset(joints[name].child for name in change.changed_joints if name in joints)
