"""OwnModel: publishes the rover's description and transforms while nobody else does."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.description.evaluator.stock_xacro import export_urdf
from studio.description.values import ReadPolicy
from studio.nodes.robot_state_publisher import RobotStateNode
from studio.settings import repository_or_wheel

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from studio.ros.client import Executor, Node

_PACKAGE = "rover_description"


class OwnModel:
    """Runs a robot_state_publisher beside the rover, unless a studio publishes its model."""

    def __init__(self, executor: Executor, urdf: str) -> None:
        self._executor, self._urdf = executor, urdf
        self._publisher: RobotStateNode | None = None

    def check(self, rover: Node) -> None:
        """Start to publish, or leave it to others who do; called every second."""
        if is_published_by_others(rover, "/robot_description"):
            if self._publisher is not None:
                rover.get_logger().info("Another node publishes the robot's description.")
                self._publisher.destroy_node()
                self._publisher = None
        elif self._publisher is None:
            self._publisher = RobotStateNode(self._urdf)
            self._executor.add_node(self._publisher)


def is_published_by_others(rover: Node, topic: str) -> bool:
    """Whether a process that is no rover publishes a topic: two rovers would both fall silent."""
    rovers = {node.zid for node in rover.graph.nodes() if node.name == rover.get_name()}
    rovers.add(rover.wire.zid)
    return any(one.node.zid not in rovers for one in rover.graph.publishers(topic))


def model_file() -> Path:
    """Return the rover's xacro, as it comes with the studio."""
    return repository_or_wheel("models") / _PACKAGE / "urdf" / "rover.urdf.xacro"


def urdf_of(file: Path, arguments: Mapping[str, str]) -> str:
    """Expand the rover's xacro; what lies beside it in its package may be read, nothing else.

    Raises:
        DescriptionError: It cannot be expanded.
    """
    package = file.resolve().parents[1]
    policy = ReadPolicy((str(package),), {_PACKAGE: (str(package),)}, {})
    return export_urdf(str(file.resolve()), arguments, policy)
