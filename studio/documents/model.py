"""The robot of a document on its way from parts to the scene: only what changed moves on."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from studio.documents.joints import JointPositions
from studio.robot.assembly import Assembly, Change
from studio.robot.kinematics import Kinematics
from studio.robot.meshes.textured import mesh_uris
from studio.robot.values import Robot

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Set

    from studio.description.values import Expansion, Part
    from studio.problems import Problem
    from studio.robot.kinematics import Floats
    from studio.scene import DocumentScene


@dataclass(frozen=True, slots=True)
class Taken:
    """What a run came to in the model."""

    structural: bool
    problems: tuple[Problem, ...]
    """All problems of the robot now."""
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
        self.posed: Callable[[tuple[str, ...], Floats], None] = lambda _links, _poses: None
        """Called with the links and their poses whenever they were moved, before that is sent."""
        self._meshes: dict[str, tuple[str, ...]] = {}

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
        self.scene.show(change.robot, change.changed_links | self._axes_of(change))
        self.pose()
        new_meshes = self._note_meshes(change)
        return Taken(change.structural, change.problems, new_meshes)

    def _note_meshes(self, change: Change) -> bool:
        """Look at the meshes of the links that changed; whether any is other than before."""
        links = change.robot.links
        known = self._meshes
        meshes = {name: known[name] for name in links if name in known}
        for name in links:
            if name in change.changed_links or name not in known:
                meshes[name] = tuple(mesh_uris(links[name]))
        self._meshes = meshes
        return meshes != known

    def pose(self) -> None:
        """Send the links to where the joint positions put them."""
        links = self.kinematics.link_names
        poses = self.kinematics.wxyz_xyz(self.joints.values)
        self.scene.set_poses(links, poses)
        self.posed(links, poses)
        self.scene.flush()

    def mesh_uris(self) -> Set[str]:
        """Every mesh that the robot names, in the order of its links."""
        return dict.fromkeys(uri for _, uri in self._meshes_by_link()).keys()

    def mesh_users(self) -> dict[str, Part]:
        """For each mesh, the first link that names it, as it was written."""
        users: dict[str, Part] = {}
        for link, uri in self._meshes_by_link():
            if part := self.assembly.part(f"link:{link}"):
                users.setdefault(uri, part)
        return users

    def _meshes_by_link(self) -> Iterator[tuple[str, str]]:
        for link in self.robot.links.values():
            for uri in mesh_uris(link):
                yield link.name, uri

    def _axes_of(self, change: Change) -> frozenset[str]:
        """Links whose drawn joint axis changed: the children of the changed joints."""
        joints = change.robot.joints
        return frozenset(joints[name].child for name in change.changed_joints if name in joints)
