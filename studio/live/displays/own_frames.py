"""OwnFrames: puts the frames of the document's own robot into the TF buffer."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from studio.tf.forest import FRAMES_MAX
from studio.tf.transforms import TransformColumns, plain_name

if TYPE_CHECKING:
    from collections.abc import Collection, Container

    from studio.displays.posed_robot import PosedRobot
    from studio.robot.kinematics import Floats, Kinematics
    from studio.robot.values import Robot
    from studio.tf.buffer import TransformBuffer
    from studio.tf.transforms import Numbers

PUBLISHER: Final = "this robot"


class OwnFrames:
    """Sets the poses of the links, valid at all times, as long as nobody publishes them in ROS.

    `leave_to_others` is thread-safe: it is called before the others' transforms are taken in, for
    a static one is sent only once.
    """

    def __init__(self, robot: PosedRobot, buffer: TransformBuffer) -> None:
        self._robot, self._buffer = robot, buffer
        self._lock = threading.Lock()
        self._kinematics: Kinematics | None = None
        self._values: Floats = np.empty(0)
        self._edges: _Edges | None = None
        self._last: Floats = np.empty((0, 7))
        """The pose of each edge that was set last."""
        self._rooted: Robot | None = None
        self._root = ""
        self._children: frozenset[str] = frozenset()
        self._others: dict[str, str] = {}
        """GID of the publisher by frame."""

    @property
    def root(self) -> str:
        """The robot's root link; empty before there is a robot."""
        if self._rooted is not self._robot.robot:
            self._rooted = self._robot.robot
            self._root = self._rooted.root
        return self._root

    @property
    def links(self) -> tuple[str, ...]:
        """The names of all links."""
        return self._robot.kinematics.link_names

    def leave_to_others(self, names: tuple[str, ...], who: str = "") -> None:
        """Leave frames to `who`, who publishes them in ROS."""
        if all(name in self._others for name in names):
            return
        children = frozenset(map(plain_name, names))
        with self._lock:
            own = children & self._children
            # Names without end must not fill the memory.
            is_full = len(self._others) >= FRAMES_MAX
            self._others |= dict.fromkeys(own if is_full else children, who)
            if own:
                self._buffer.drop(own)
                self._children -= own
                self._edges = None

    def take_back(self) -> None:
        """Set all frames again: nobody is subscribed any more."""
        with self._lock:
            self._others, self._children = {}, frozenset()
            self._kinematics = self._edges = None

    def take_back_from(self, gone: Collection[str]) -> None:
        """Set the frames again whose publishers are gone; thread-safe."""
        with self._lock:
            free = {child for child, who in self._others.items() if who in gone}
            if not free:
                return
            for child in free:
                del self._others[child]
            self._buffer.drop(free & {one.child for one in self._robot.robot.joints.values()})
            self._kinematics = self._edges = None

    def step(self) -> None:
        """Set what changed since the last step."""
        kinematics, values = self._robot.kinematics, self._robot.joints.values
        if kinematics is self._kinematics and np.array_equal(values, self._values):
            return
        parent_from_links = kinematics.wxyz_xyz_in_parents(values)
        with self._lock:
            if kinematics is not self._kinematics or self._edges is None:
                self._find_edges(kinematics.link_names)
            self._kinematics, self._values = kinematics, values.copy()
            self._put(parent_from_links)

    def _find_edges(self, links: tuple[str, ...]) -> None:
        before = self._edges
        self._edges = _edges_of(self._robot.robot, links, self._others)
        if before is None or before[:2] != self._edges[:2]:
            self._last = np.full((len(self._edges.children), 7), np.nan)
        children = frozenset(self._edges.children)
        self._buffer.drop(self._children - children)
        self._children = children

    def _put(self, parent_from_links: Floats) -> None:
        """Set the edges that moved: of a large robot few do."""
        edges = self._edges
        if edges is None or not edges.children:
            return
        poses = parent_from_links[edges.rows]
        moved = np.flatnonzero((poses != self._last).any(axis=1))
        if moved.size:
            self._last[moved] = poses[moved]
            self._buffer.put(edges.transforms(moved, poses), static=True, publisher=PUBLISHER)


class _Edges(NamedTuple):
    """The parent and child of each edge, and the index of each child among the links."""

    parents: tuple[str, ...]
    children: tuple[str, ...]
    rows: Numbers

    def transforms(self, some: Numbers, poses: Floats) -> TransformColumns:
        rows: list[int] = some.tolist()
        return TransformColumns(
            tuple(self.parents[row] for row in rows),
            tuple(self.children[row] for row in rows),
            np.zeros(len(rows), np.int64),
            poses[some, 4:],
            poses[some, :4],
        )


def _edges_of(robot: Robot, links: tuple[str, ...], left_out: Container[str]) -> _Edges:
    place = {name: at for at, name in enumerate(links)}
    edges = [
        (one.parent, one.child)
        for one in robot.joints.values()
        if one.parent in place and one.child in place and one.child not in left_out
    ]
    return _Edges(
        tuple(parent for parent, _ in edges),
        tuple(child for _, child in edges),
        np.array([place[child] for _, child in edges], np.int64),
    )
