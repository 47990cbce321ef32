"""Adder: the service /add_two_ints of learning_interface.

Try: `studio demos adder_server`, then
`studio service call /add_two_ints learning_interface/srv/AddTwoInts "{a: 41, b: 1}"`.
"""

from __future__ import annotations

import studio.ros.client as rclpy
from studio.course.running import until_stopped
from studio.ros.client import Node
from studio.ros.messages.learning_interface.srv import AddTwoInts


class adderServer(Node):
    """Serves sums."""

    def __init__(self, name: str) -> None:
        super().__init__(name)
        self.srv = self.create_service(AddTwoInts, "add_two_ints", self.adder_callback)

    def adder_callback(
        self, request: AddTwoInts.Request, response: AddTwoInts.Response
    ) -> AddTwoInts.Response:
        """Add two integers."""
        response.sum = request.a + request.b
        self.get_logger().info("Incoming request\na: %d b: %d" % (request.a, request.b))
        return response


def main(args: list[str] | None = None) -> None:
    """Serve until stopped."""
    with until_stopped(args):
        rclpy.spin(adderServer("service_adder_server"))


if __name__ == "__main__":
    main()
