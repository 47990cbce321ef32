"""JointStatePublisher: tells where the joints of a robot stand, on `joint_states`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from studio.ros.qos import QoSProfile

if TYPE_CHECKING:
    from collections.abc import Mapping

    from studio.ros.node.node import Node

_QUEUE: Final = QoSProfile(depth=10)


class JointStatePublisher:
    """Publishes `joint_states` by a node; how often is its owner's affair."""

    def __init__(self, node: Node) -> None:
        self._node = node
        types = node.wire.types
        self._state = types.message("sensor_msgs/msg/JointState")
        self._header = types.message("std_msgs/msg/Header")
        self._out = node.create_publisher(self._state, "joint_states", _QUEUE)

    def tell(self, positions: Mapping[str, float]) -> None:
        """Publish positions, rad or m by name, with the time that it is now."""
        stamp = self._node.get_clock().now().to_msg()
        self._out.publish(
            self._state(
                header=self._header(stamp=stamp),
                name=list(positions),
                position=list(positions.values()),
            )
        )
