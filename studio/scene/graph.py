"""The Graph: what stands under which name now, told to viser by the smallest messages that do."""

# pyright: reportPrivateUsage=false
from __future__ import annotations

from typing import TYPE_CHECKING, Any

from viser import _messages

from studio.scene import props

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
    _messages.GlbMessage: props.GlbProps,
    _messages.LabelMessage: props.LabelProps,
    _messages.ArrowMessage: props.ArrowProps,
    _messages.GridMessage: _messages.GridProps,
    _messages.PointCloudMessage: props.PointCloudProps,
    _messages.LineSegmentsMessage: props.LineSegmentsProps,
    _messages.BatchedAxesMessage: props.BatchedAxesProps,
    _messages.BatchedMeshesMessage: _messages.BatchedMeshesProps,
    _messages.ImageMessage: props.ImageProps,
    _messages.CameraFrustumMessage: props.CameraFrustumProps,
}


def kinds_of_nodes() -> dict[type[Any], type[Any]]:
    """The properties of each kind of node that is drawn."""
    return dict(_PROPS)


class Graph:
    """Names are viser's: `/` between parent and child; a parent is put before its children."""

    def __init__(self, server: HostedServer) -> None:
        self._server = server
        self._nodes: dict[str, Node] = {}
        self._created: dict[str, dict[str, Any]] = {}  # props in the message that made each node

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
            self._tell(_messages.SetSceneNodeVisibilityMessage(name, node.visible))

    def drop(self, name: str) -> None:
        """Remove one node; its children are dropped before it."""
        if self._nodes.pop(name, None) is not None:
            del self._created[name]
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
        made = _PROPS[node.kind](**node.props, **node.arrays, **node.flowing)
        self._created[name] = vars(made)
        self._tell(node.kind(name, made))  # pyright: ignore[reportCallIssue]
        self.turn(name, node.wxyz)
        self.shift(name, node.position)
        self._tell(_messages.SetSceneNodeVisibilityMessage(name, node.visible))

    def _update(self, name: str, values: dict[str, Any]) -> None:
        """Change properties in place.

        The message that made the node is replayed to who comes later: it tells of the node as it
        is now, or a cloud that streams would be replayed twice, first as it was in the beginning.
        The same arrays in two messages of one frame are sent once.
        """
        self._tell(_messages.SceneNodeUpdateMessage(name, values))
        self._created[name].update(values)

    def _tell(self, message: _messages.Message) -> None:
        self._server.queue_message(message)
