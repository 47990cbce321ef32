"""The Graph: what stands under which name now, told to viser by the smallest messages that do."""

# pyright: reportPrivateUsage=false
from __future__ import annotations

from typing import TYPE_CHECKING, Any

from viser import _messages

if TYPE_CHECKING:
    from contextlib import AbstractContextManager

    from studio.robot.values import Vector3
    from studio.scene.host import HostedServer
    from studio.scene.node import Node, Quaternion

_PROPS: dict[type[Any], type[Any]] = {
    _messages.FrameMessage: _messages.FrameProps,
    _messages.BoxMessage: _messages.BoxProps,
    _messages.CylinderMessage: _messages.CylinderProps,
    _messages.IcosphereMessage: _messages.IcosphereProps,
    _messages.MeshMessage: _messages.MeshProps,
    _messages.GlbMessage: _messages.GlbProps,
    _messages.LabelMessage: _messages.LabelProps,
    _messages.ArrowMessage: _messages.ArrowProps,
    _messages.GridMessage: _messages.GridProps,
}


class Graph:
    """Names are viser's: `/` between parent and child; a parent is put before its children."""

    def __init__(self, server: HostedServer) -> None:
        self._server = server
        self._nodes: dict[str, Node] = {}

    def __contains__(self, name: str) -> bool:
        return name in self._nodes

    def atomic(self) -> AbstractContextManager[None]:
        """Within: all that is told reaches every page in one frame."""
        return self._server.atomic()

    def put(self, name: str, node: Node) -> None:
        """Let `node` stand under `name`; what is as it was is not sent."""
        old = self._nodes.get(name)
        if old == node:
            return
        self._nodes[name] = node
        if old is None or old.kind is not node.kind or old.content != node.content:
            self._create(name, node)
            return
        if old.props != node.props:
            # Always all of them: viser keeps one message per set of names.
            self._tell(_messages.SceneNodeUpdateMessage(name, dict(node.props)))
        if old.wxyz != node.wxyz:
            self.turn(name, node.wxyz)
        if old.position != node.position:
            self.shift(name, node.position)
        if old.visible is not node.visible:
            self._tell(_messages.SetSceneNodeVisibilityMessage(name, node.visible))

    def drop(self, name: str) -> None:
        """Remove one node; its children are dropped before it."""
        if self._nodes.pop(name, None) is not None:
            self._tell(_messages.RemoveSceneNodeMessage(name))

    def turn(self, name: str, wxyz: Quaternion) -> None:
        """Turn a node in its parent."""
        self._tell(_messages.SetOrientationMessage(name, wxyz))

    def shift(self, name: str, position: Vector3) -> None:
        """Put a node at a place in its parent, m."""
        self._tell(_messages.SetPositionMessage(name, position))

    def _create(self, name: str, node: Node) -> None:
        # What was said of an earlier node of that name must not be replayed onto this one.
        self._server.get_message_buffer().remove_entity_state_from_buffer("scene", name)
        props = _PROPS[node.kind](**node.props, **node.arrays)
        self._tell(node.kind(name, props))  # pyright: ignore[reportCallIssue]
        self.turn(name, node.wxyz)
        self.shift(name, node.position)
        self._tell(_messages.SetSceneNodeVisibilityMessage(name, node.visible))

    def _tell(self, message: _messages.Message) -> None:
        self._server.queue_message(message)
