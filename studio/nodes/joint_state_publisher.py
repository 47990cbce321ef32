"""JointStatePublisher: publishes the positions of a robot's joints on `joint_states`.

Try: `studio run joint_state_publisher joint_state_publisher robot.urdf`, then
`studio topic hz /joint_states`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from studio.errors import RobotError, SettingsError
from studio.nodes.robot_state_publisher import LATCHED, run_with_urdf
from studio.robot.kinematics import Kinematics
from studio.robot.urdf_text import robot_from_urdf
from studio.ros.client import Node
from studio.ros.messages import message
from studio.ros.qos import QoSProfile

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from studio.ros.types.classes import MessageValue

_QUEUE: Final = QoSProfile(depth=10)


class JointStatePublisher:
    """Publishes `joint_states` by a node; how often is its owner's affair."""

    def __init__(self, node: Node) -> None:
        self._node = node
        types = node.wire.types
        self._state = types.message("sensor_msgs/msg/JointState")
        self._header = types.message("std_msgs/msg/Header")
        self._out = node.create_publisher(self._state, "joint_states", _QUEUE)

    def publish(self, positions: Mapping[str, float]) -> None:
        """Publish positions, rad or m by name, with the time that it is now."""
        stamp = self._node.get_clock().now().to_msg()
        self._out.publish(
            self._state(
                header=self._header(stamp=stamp),
                name=list(positions),
                position=list(positions.values()),
            )
        )


class JointStateNode(Node):
    """The node that upstream's program is without a window: all joints at zero, at a rate.

    The robot is that of a file, or the one that comes on `robot_description`.

    Raises:
        SettingsError: The parameter `rate` is not above 0.
    """

    def __init__(self, urdf: str = "") -> None:
        super().__init__("joint_state_publisher")
        self._publisher = JointStatePublisher(self)
        self._positions: dict[str, float] = {}
        rate_hz = self.declare_parameter("rate", 10).value
        if not rate_hz > 0:
            raise SettingsError(f"rate is {rate_hz}: it must be above 0.")
        if urdf:
            self._positions = _at_zero(urdf)
        else:
            text = message("std_msgs/msg/String")
            self.create_subscription(text, "robot_description", self._take, LATCHED)
        self.create_timer(1 / rate_hz, self._publish)

    def _take(self, description: MessageValue) -> None:
        try:
            self._positions = _at_zero(description.data)
        except RobotError as error:
            self.get_logger().error(f"The description was not taken: {error}")

    def _publish(self) -> None:
        if self._positions:
            self._publisher.publish(self._positions)


def _at_zero(urdf: str) -> dict[str, float]:
    """Return every movable joint at zero, or as near as its limits let it."""
    kinematics = Kinematics(robot_from_urdf(urdf))
    return dict(zip(kinematics.movable, kinematics.zero_positions().tolist(), strict=True))


def main(args: Sequence[str] | None = None) -> None:
    """Run until a signal ends the process."""
    run_with_urdf(JointStateNode, args)


if __name__ == "__main__":
    main()
