"""Broadcasters of transforms, under tf2_ros's names."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final, TypeAlias, cast

from studio.ros.client import DurabilityPolicy, QoSProfile

if TYPE_CHECKING:
    from collections.abc import Sequence

    from studio.ros.client import Node
    from studio.ros.types.classes import MessageValue

    Transforms: TypeAlias = MessageValue | Sequence[MessageValue]

_DEPTH = 100
_TYPE: Final = "tf2_msgs/msg/TFMessage"


class TransformBroadcaster:
    """Tells on /tf where frames are right now."""

    def __init__(self, node: Node, qos: QoSProfile | int | None = None) -> None:
        self._message: Any = node.context.wire.types.message(_TYPE)
        self.pub_tf = node.create_publisher(self._message, "/tf", _DEPTH if qos is None else qos)

    def sendTransform(self, transform: Transforms) -> None:  # noqa: N802  # tf2_ros's name
        """Send one transform (a TransformStamped), or several as one message."""
        self.pub_tf.publish(self._message(transforms=_listed(transform)))


class StaticTransformBroadcaster:
    """Publishes fixed transforms on /tf_static, latched for late subscribers."""

    def __init__(self, node: Node, qos: QoSProfile | None = None) -> None:
        kept = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self._message: Any = node.context.wire.types.message(_TYPE)
        self.pub_tf = node.create_publisher(self._message, "/tf_static", qos or kept)
        self._sent: dict[str, MessageValue] = {}

    def sendTransform(self, transform: Transforms) -> None:  # noqa: N802  # tf2_ros's name
        """Send transforms together with those that were sent before: only one message is kept."""
        self._sent |= {one.child_frame_id: one for one in _listed(transform)}
        self.pub_tf.publish(self._message(transforms=list(self._sent.values())))


def _listed(transform: Transforms) -> list[MessageValue]:
    if isinstance(transform, list | tuple):
        return list(cast("Sequence[MessageValue]", transform))
    return [cast("MessageValue", transform)]
