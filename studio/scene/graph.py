"""The Graph: which node has which name, and the smallest messages to viser that keep it so."""

# pyright: reportPrivateUsage=false

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING, Any
from urllib.parse import quote

import numpy as np
from viser import _messages

from studio.scene.node import (
    ArrowProps,
    BatchedAxesProps,
    CameraFrustumProps,
    GlbProps,
    ImageProps,
    LabelProps,
    LineSegmentsProps,
    PointCloudProps,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Container, Sequence
    from contextlib import AbstractContextManager

    from numpy.typing import NDArray

    from studio.robot.values import Vector3
    from studio.scene.host import HostedServer
    from studio.scene.node import Node, Quaternion

PROPS_OF: dict[type[Any], type[Any]] = {
    _messages.FrameMessage: _messages.FrameProps,
    _messages.BoxMessage: _messages.BoxProps,
    _messages.CylinderMessage: _messages.CylinderProps,
    _messages.IcosphereMessage: _messages.IcosphereProps,
    _messages.MeshMessage: _messages.MeshProps,
    _messages.GlbMessage: GlbProps,
    _messages.LabelMessage: LabelProps,
    _messages.ArrowMessage: ArrowProps,
    _messages.GridMessage: _messages.GridProps,
    _messages.PointCloudMessage: PointCloudProps,
    _messages.LineSegmentsMessage: LineSegmentsProps,
    _messages.BatchedAxesMessage: BatchedAxesProps,
    _messages.BatchedMeshesMessage: _messages.BatchedMeshesProps,
    _messages.ImageMessage: ImageProps,
    _messages.CameraFrustumMessage: CameraFrustumProps,
}
ROBOT = "/robot"
GRID = "/grid"
GHOST = "/ghost"
LIVE = "/live"
_KEPT = "!*'()"  # what encodeURIComponent of the page leaves as it is, beside quote's own
STEP = 1e-6
"""Absolute: metres, and parts of a unit quaternion; a smaller move is none."""


class Graph:
    """Names are viser's: `/` between parent and child; a parent is put before its children."""

    def __init__(self, server: HostedServer) -> None:
        self._server = server
        self._nodes: dict[str, Node] = {}
        self._created: dict[str, dict[str, Any]] = {}  # props in the message that made each node

    def __contains__(self, name: str) -> bool:
        return name in self._nodes

    def atomic(self) -> AbstractContextManager[None]:
        """Within this context, all changes reach every page in one frame."""
        return self._server.atomic()

    def put(self, name: str, node: Node) -> None:
        """Give `node` the name `name`; what has not changed is not sent."""
        old = self._nodes.get(name)
        if old == node:
            return
        self._nodes[name] = node
        if old is None or old.kind is not node.kind or old.content != node.content:
            self._create(name, node)
            return
        # Always all of them: viser keeps one message per set of names.
        if old.stream != node.stream:
            self._update(name, {**node.props, **node.flowing})
        elif old.props != node.props:
            self._update(name, dict(node.props))
        if old.wxyz != node.wxyz:
            self.turn(name, node.wxyz)
        if old.position != node.position:
            self.shift(name, node.position)
        if old.visible is not node.visible:
            self._queue(_messages.SetSceneNodeVisibilityMessage(name, node.visible))

    def drop(self, name: str) -> None:
        """Remove one node; its children are dropped before it."""
        if self._nodes.pop(name, None) is not None:
            del self._created[name]
            self._queue(_messages.RemoveSceneNodeMessage(name))

    def turn(self, name: str, wxyz: Quaternion) -> None:
        """Turn a node in its parent."""
        self._queue(_messages.SetOrientationMessage(name, wxyz))

    def shift(self, name: str, position: Vector3) -> None:
        """Put a node at a place in its parent, m."""
        self._queue(_messages.SetPositionMessage(name, position))

    def _create(self, name: str, node: Node) -> None:
        # Messages about an earlier node of that name must not be replayed onto this one.
        self._server.get_message_buffer().remove_entity_state_from_buffer("scene", name)
        made = PROPS_OF[node.kind](**node.props, **node.arrays, **node.flowing)
        self._created[name] = vars(made)
        self._queue(node.kind(name, made))  # pyright: ignore[reportCallIssue]
        self.turn(name, node.wxyz)
        self.shift(name, node.position)
        self._queue(_messages.SetSceneNodeVisibilityMessage(name, node.visible))

    def _update(self, name: str, values: dict[str, Any]) -> None:
        """Change properties in place.

        The message that made the node is replayed to new pages: it has to hold the node as it is
        now, or a cloud that streams would be replayed twice, first as it was in the beginning.
        The same arrays in two messages of one frame are sent once.
        """
        self._queue(_messages.SceneNodeUpdateMessage(name, values))
        self._created[name].update(values)

    def _queue(self, message: _messages.Message) -> None:
        self._server.queue_message(message)


def link_node(link: str) -> str:
    """Return the node that carries the pose of a link."""
    return f"{ROBOT}/{_quoted(link)}"


def ghost_node(link: str) -> str:
    """Return the node that carries the pose of a link of the ghost."""
    return f"{GHOST}/{_quoted(link)}"


def live_node(display_id: str, *parts: str) -> str:
    """Return the name of a display's root, of a path's group in it, or of a shape in that."""
    # An empty name would stand for the node above it.
    return "/".join((LIVE, *(_quoted(part) or "%" for part in (display_id, *parts))))


@lru_cache(maxsize=1 << 14)
def _quoted(part: str) -> str:
    return quote(part, safe=_KEPT)


class PoseWriter:
    """Remembers what was sent last for each link; `forget` what was removed or made again."""

    def __init__(self, graph: Graph, node_of: Callable[[str], str] = link_node) -> None:
        self._graph, self._node_of = graph, node_of
        self._names: tuple[str, ...] = ()
        self._nodes: tuple[str, ...] = ()
        self._sent = np.full((0, 7), np.nan)

    def write(
        self,
        link_names: Sequence[str],
        wxyz_xyz: NDArray[np.floating],
        drawn: Container[str],
    ) -> None:
        """Send one atomic batch with the links that moved.

        Args:
            link_names: L names.
            wxyz_xyz: Shape (L, 7): quaternion w, x, y, z, then x, y, z in metres, in the root
                frame. Rows that are not finite are left where they were.
            drawn: The links that stand in the scene; others are skipped.
        """
        poses = np.asarray(wxyz_xyz, dtype=np.float64)
        if self._names != link_names:
            self._rename(tuple(link_names))
        near: NDArray[np.bool_] = np.abs(poses - self._sent) <= STEP  # NaN, never sent, is not
        far = np.logical_not(near) & np.isfinite(poses).all(axis=1, keepdims=True)
        rows: list[int] = np.flatnonzero(far.any(axis=1)).tolist()
        if not rows:
            return
        turned: NDArray[np.bool_] = np.logical_or.reduce(far[:, :4], axis=1)
        shifted: NDArray[np.bool_] = np.logical_or.reduce(far[:, 4:], axis=1)
        how = zip(turned[rows].tolist(), shifted[rows].tolist(), strict=True)
        with self._graph.atomic():
            for row, pose, (turns, shifts) in zip(rows, poses[rows].tolist(), how, strict=True):
                if self._names[row] in drawn:
                    self._send(self._nodes[row], pose, turns=turns, shifts=shifts)
                    # What was not sent is not forgotten, or many small moves would be lost.
                    part = slice(0 if turns else 4, 7 if shifts else 4)
                    self._sent[row, part] = pose[part]

    def _send(self, node: str, pose: list[float], *, turns: bool, shifts: bool) -> None:
        w, qx, qy, qz, x, y, z = pose
        if turns:
            self._graph.turn(node, (w, qx, qy, qz))
        if shifts:
            self._graph.shift(node, (x, y, z))

    def forget(self, link: str) -> None:
        """Send the pose of this link again next time."""
        if link in self._names:
            self._sent[self._names.index(link)] = np.nan

    def _rename(self, names: tuple[str, ...]) -> None:
        """Keep what was sent for the links that stay."""
        last = dict(zip(self._names, self._sent, strict=True))
        unknown = np.full(7, np.nan)
        self._names = names
        self._nodes = tuple(self._node_of(name) for name in names)
        self._sent = np.array([last.get(name, unknown) for name in names]).reshape(-1, 7)
