"""The nodes by which the studio publishes a robot, and the positions of its joints."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING, Final

from studio.nodes.joint_state_publisher import JointStatePublisher
from studio.nodes.robot_state_publisher import RobotStatePublisher
from studio.ros.parameters.parameter import Parameter

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from studio.robot.kinematics import Kinematics
    from studio.robot.values import Robot
    from studio.ros.node.node import Node

_DESCRIPTION: Final = "robot_description"
_PREFIX: Final = "frame_prefix"


class RobotOut:
    """Publishes one robot; thread-safe.

    Args:
        node: That publishes it.
        rivals: Returns the nodes of others that publish a robot, too.
        end: Ends the node.
    """

    def __init__(
        self, node: Node, rivals: Callable[[], list[str]], end: Callable[[Node], object]
    ) -> None:
        self._node, self.rivals, self._end = node, rivals, end
        self._publisher = RobotStatePublisher(node)
        self.place = self._publisher.place
        self._turn = threading.Lock()
        """Held while the robot or the prefix changes."""
        self._described: tuple[str, Robot, Kinematics] | None = None
        node.declare_parameter(_DESCRIPTION, "")
        node.declare_parameter(_PREFIX, "")
        node.add_post_set_parameters_callback(self._take)

    def describe(self, urdf: str, robot: Robot, kinematics: Kinematics) -> None:
        """Publish this robot from now on, on topics and as a parameter."""
        self._node.set_parameters([Parameter(_DESCRIPTION, value=urdf)])
        with self._turn:
            self._described = urdf, robot, kinematics
            self._publisher.describe(urdf, robot, kinematics)

    def _take(self, parameters: Sequence[Parameter]) -> None:
        """Put another prefix before all frames, as upstream's node does at run time."""
        prefixes = [one.value for one in parameters if one.name == _PREFIX]
        with self._turn:
            for prefix in prefixes:
                self._publisher.set_prefix(prefix)
            if prefixes and self._described is not None:
                self._publisher.describe(*self._described)

    def close(self) -> None:
        """Publish it no more."""
        self._end(self._node)


class JointsOut:
    """Publishes joint positions; arguments as of `RobotOut`."""

    def __init__(
        self, node: Node, rivals: Callable[[], list[str]], end: Callable[[Node], object]
    ) -> None:
        self._node, self.rivals, self._end = node, rivals, end
        self.publish = JointStatePublisher(node).publish

    def close(self) -> None:
        """Publish them no more."""
        self._end(self._node)
