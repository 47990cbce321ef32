"""Service server: /add_two_ints of example_interfaces.

Try: `studio demos service_server_node`, then
`studio service call /add_two_ints example_interfaces/srv/AddTwoInts "{a: 1, b: 2}"`.
"""

from __future__ import annotations

import studio.ros.client as rclpy
from studio.course.running import until_stopped
from studio.ros.client import Node
from studio.ros.messages.example_interfaces.srv import AddTwoInts


class ServiceServerNode(Node):
    """Serves sums."""

    def __init__(self) -> None:
        super().__init__("service_server_node")
        self.srv = self.create_service(AddTwoInts, "add_two_ints", self.add_two_ints_callback)
        self.get_logger().info("Service Server Node initialized")

    def add_two_ints_callback(
        self, request: AddTwoInts.Request, response: AddTwoInts.Response
    ) -> AddTwoInts.Response:
        """Add two integers."""
        response.sum = request.a + request.b
        self.get_logger().info(f"Returning {request.a} + {request.b} = {response.sum}")
        return response


def main(args: list[str] | None = None) -> None:
    """Serve until stopped."""
    with until_stopped(args):
        rclpy.spin(ServiceServerNode())


if __name__ == "__main__":
    main()
