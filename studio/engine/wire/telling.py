"""RobotOut and JointsOut: a node each that tells one robot, or where its joints stand."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from studio.nodes.joint_state_publisher import JointStatePublisher
from studio.nodes.robot_state_publisher import RobotStatePublisher
from studio.ros.parameters.parameter import Parameter

if TYPE_CHECKING:
    from studio.engine.wire.link import WireLink
    from studio.robot.kinematics import Kinematics
    from studio.robot.values import Robot
    from studio.ros.node.node import Node

_DESCRIPTION: Final = "robot_description"


class RobotOut:
    """Tells one robot; any thread."""

    def __init__(self, link: WireLink, node: Node) -> None:
        self._link, self._node = link, node
        self._publisher = RobotStatePublisher(node)
        self.place = self._publisher.place
        node.declare_parameter(_DESCRIPTION, "")

    def describe(self, urdf: str, robot: Robot, kinematics: Kinematics) -> None:
        """Tell this robot from now on, by topics and as a parameter."""
        self._node.set_parameters([Parameter(_DESCRIPTION, value=urdf)])
        self._publisher.describe(urdf, robot, kinematics)

    def rivals(self) -> list[str]:
        """Nodes of others that tell a robot, too."""
        return self._link.publishers("/robot_description")

    def close(self) -> None:
        """Tell it no more."""
        self._link.let_go(self._node)


class JointsOut:
    """Tells where joints stand; any thread."""

    def __init__(self, link: WireLink, node: Node) -> None:
        self._link, self._node = link, node
        self.tell = JointStatePublisher(node).tell

    def rivals(self) -> list[str]:
        """Nodes of others that tell joints, too."""
        return self._link.publishers("/joint_states")

    def close(self) -> None:
        """Tell it no more."""
        self._link.let_go(self._node)
