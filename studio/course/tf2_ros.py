"""Broadcasters of transforms, under tf2_ros's names."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.ros.client import DurabilityPolicy, Node, QoSProfile
from studio.ros.messages.geometry_msgs.msg import TransformStamped
from studio.ros.messages.tf2_msgs.msg import TFMessage

if TYPE_CHECKING:
    from collections.abc import Sequence

_DEPTH = 100


class TransformBroadcaster:
    """Tells on /tf where frames are right now."""

    def __init__(self, node: Node, qos: QoSProfile | int | None = None) -> None:
        self.pub_tf = node.create_publisher(TFMessage, "/tf", _DEPTH if qos is None else qos)

    def sendTransform(  # noqa: N802  # tf2_ros's name
        self, transform: TransformStamped | Sequence[TransformStamped]
    ) -> None:
        """Send one transform, or several as one message."""
        self.pub_tf.publish(TFMessage(transforms=_listed(transform)))


class StaticTransformBroadcaster:
    """Publishes fixed transforms on /tf_static, latched for late subscribers."""

    def __init__(self, node: Node, qos: QoSProfile | None = None) -> None:
        kept = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.pub_tf = node.create_publisher(TFMessage, "/tf_static", qos or kept)
        self._sent: dict[str, TransformStamped] = {}

    def sendTransform(  # noqa: N802  # tf2_ros's name
        self, transform: TransformStamped | Sequence[TransformStamped]
    ) -> None:
        """Send transforms together with those that were sent before: only one message is kept."""
        self._sent |= {one.child_frame_id: one for one in _listed(transform)}
        self.pub_tf.publish(TFMessage(transforms=list(self._sent.values())))


def _listed(transform: TransformStamped | Sequence[TransformStamped]) -> list[TransformStamped]:
    return [transform] if isinstance(transform, TransformStamped) else list(transform)
