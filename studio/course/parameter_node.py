"""Parameter node: a robot's name and its highest speed, as parameters.

Try: `studio demos parameter_node`, then `studio param list /parameter_node`,
`studio param set /parameter_node max_velocity 0.5` and `... max_velocity -1.5`, which is refused.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import studio.ros.client as rclpy
from studio.course.running import until_stopped
from studio.ros.client import Node
from studio.ros.messages.rcl_interfaces.msg import SetParametersResult

if TYPE_CHECKING:
    from studio.ros.parameters.parameter import Parameter


class ParameterNode(Node):
    """Declares parameters, and checks new values."""

    def __init__(self) -> None:
        super().__init__("parameter_node")
        self.declare_parameter("robot_name", "turtlebot")
        self.declare_parameter("max_velocity", 1.0)
        robot_name = self.get_parameter("robot_name").value
        max_velocity = self.get_parameter("max_velocity").value
        use_sim_time = self.get_parameter("use_sim_time").value
        self.get_logger().info(f"Robot name: {robot_name}")
        self.get_logger().info(f"Max velocity: {max_velocity}")
        self.get_logger().info(f"Use sim time: {use_sim_time}")
        self.add_on_set_parameters_callback(self.parameter_callback)

    def parameter_callback(self, params: list[Parameter]) -> SetParametersResult:
        """Refuse a speed below zero, and log the rest."""
        for param in params:
            if param.name == "max_velocity" and param.value < 0:
                return SetParametersResult(successful=False, reason="max_velocity is below zero")
            self.get_logger().info(f"Parameter {param.name} changed to {param.value}")
        return SetParametersResult(successful=True)


def main(args: list[str] | None = None) -> None:
    """Run until stopped."""
    with until_stopped(args):
        rclpy.spin(ParameterNode())


if __name__ == "__main__":
    main()
