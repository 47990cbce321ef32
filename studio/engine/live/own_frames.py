"""OwnFrames: the frames of the document's own robot, told to its buffer as TF would."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING, Final

import numpy as np

from studio.tf.columns import Transforms
from studio.tf.rotations import matrices_from_poses, poses_from_matrices

if TYPE_CHECKING:
    from studio.engine.model import Model
    from studio.robot.kinematics import Floats, Kinematics
    from studio.robot.values import Robot
    from studio.tf.buffer import TransformBuffer

PUBLISHER: Final = "this robot"


class OwnFrames:
    """Tells where the links stand, for all times, as long as nobody on the wire tells of them.

    `leave_to_others` may be called in any thread: it has to be before the others' transform is
    taken in, for a static one is told only once.
    """

    def __init__(self, model: Model, buffer: TransformBuffer) -> None:
        self._model, self._buffer = model, buffer
        self._lock = threading.Lock()
        self._kinematics: Kinematics | None = None
        self._values: Floats = np.empty(0)
        self._rooted: Robot | None = None
        self._root = ""
        self._children: frozenset[str] = frozenset()
        self._told_by_others: frozenset[str] = frozenset()

    @property
    def root(self) -> str:
        """The robot's root link; empty before there is a robot."""
        if self._rooted is not self._model.robot:
            self._rooted = self._model.robot
            children = {joint.child for joint in self._rooted.joints.values()}
            self._root = next((one for one in self._rooted.links if one not in children), "")
        return self._root

    @property
    def links(self) -> tuple[str, ...]:
        """All its links."""
        return self._model.kinematics.link_names

    def leave_to_others(self, children: frozenset[str]) -> None:
        """Tell no more of frames that the wire tells of."""
        if children <= self._told_by_others:
            return
        with self._lock:
            self._told_by_others |= children
            self._buffer.drop(children & self._children)
            self._children -= children

    def take_back(self) -> None:
        """Tell of all again: nobody is heard any more."""
        with self._lock:
            self._told_by_others, self._children = frozenset(), frozenset()
            self._kinematics = None

    def step(self) -> None:
        """Tell what changed since the last step."""
        robot, kinematics = self._model.robot, self._model.kinematics
        values = self._model.joints.values
        if kinematics is self._kinematics and np.array_equal(values, self._values):
            return
        poses = kinematics.wxyz_xyz(values)
        with self._lock:
            self._kinematics, self._values = kinematics, values.copy()
            columns = _transforms(robot, kinematics.link_names, poses, self._told_by_others)
            children = frozenset(columns.children)
            self._buffer.drop(self._children - children)
            self._children = children
            self._buffer.put(columns, static=True, publisher=PUBLISHER)


def _transforms(
    robot: Robot, links: tuple[str, ...], root_from_links: Floats, left_out: frozenset[str]
) -> Transforms:
    """The pose of each link in its parent."""
    place = {name: at for at, name in enumerate(links)}
    edges = [
        (one.parent, one.child)
        for one in robot.joints.values()
        if one.parent in place and one.child in place and one.child not in left_out
    ]
    parents = tuple(parent for parent, _ in edges)
    children = tuple(child for _, child in edges)
    root_from_all = matrices_from_poses(root_from_links)
    root_from_parents = root_from_all[[place[name] for name in parents]]
    root_from_children = root_from_all[[place[name] for name in children]]
    if not edges:
        return Transforms((), (), np.empty(0, np.int64), np.empty((0, 3)), np.empty((0, 4)))
    poses = poses_from_matrices(np.linalg.inv(root_from_parents) @ root_from_children)
    stamps_ns = np.zeros(len(edges), np.int64)
    return Transforms(parents, children, stamps_ns, poses[:, 4:], poses[:, :4])
