"""RobotOut and JointsOut: a node each that tells one robot, or where its joints stand."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING, Final

from studio.nodes.joint_state_publisher import JointStatePublisher
from studio.nodes.robot_state_publisher import RobotStatePublisher
from studio.ros.parameters.parameter import Parameter

if TYPE_CHECKING:
    from collections.abc import Sequence

    from studio.live.connection.link import WireLink
    from studio.robot.kinematics import Kinematics
    from studio.robot.values import Robot
    from studio.ros.node.node import Node

_DESCRIPTION: Final = "robot_description"
_PREFIX: Final = "frame_prefix"


class RobotOut:
    """Tells one robot; any thread."""

    def __init__(self, link: WireLink, node: Node) -> None:
        self._link, self._node = link, node
        self._publisher = RobotStatePublisher(node)
        self.place = self._publisher.place
        self._turn = threading.Lock()
        """Of who edits the robot and who sets the prefix."""
        self._told: tuple[str, Robot, Kinematics] | None = None
        node.declare_parameter(_DESCRIPTION, "")
        node.declare_parameter(_PREFIX, "")
        node.add_post_set_parameters_callback(self._take)

    def describe(self, urdf: str, robot: Robot, kinematics: Kinematics) -> None:
        """Tell this robot from now on, by topics and as a parameter."""
        self._node.set_parameters([Parameter(_DESCRIPTION, value=urdf)])
        with self._turn:
            self._told = urdf, robot, kinematics
            self._publisher.describe(urdf, robot, kinematics)

    def _take(self, parameters: Sequence[Parameter]) -> None:
        """Put another prefix before all frames, as upstream's node does at run time."""
        prefixes = [one.value for one in parameters if one.name == _PREFIX]
        with self._turn:
            for prefix in prefixes:
                self._publisher.set_prefix(prefix)
            if prefixes and self._told is not None:
                self._publisher.describe(*self._told)

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
