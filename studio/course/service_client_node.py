"""Service client: asks /add_two_ints of example_interfaces, and ends.

Try: `studio demos service_server_node`, then
`studio run my_robot_package service_client_node 20 22` in another terminal.
"""

from __future__ import annotations

import sys

import studio.ros.client as rclpy
from studio.course.running import until_stopped
from studio.ros.client import Node
from studio.ros.messages.example_interfaces.srv import AddTwoInts


class ServiceClientNode(Node):
    """Asks, and spins until the answer is there."""

    def __init__(self) -> None:
        super().__init__("service_client_node")
        self.cli = self.create_client(AddTwoInts, "add_two_ints")
        while not self.cli.wait_for_service(timeout_sec=1.0):
            self.get_logger().info("Service not available, waiting again...")
        self.req = AddTwoInts.Request()
        self.get_logger().info("Service Client Node initialized")

    def send_request(self, a: int, b: int) -> AddTwoInts.Response:
        """Return the answer, once it is there."""
        self.req.a = a
        self.req.b = b
        self.future = self.cli.call_async(self.req)
        rclpy.spin_until_future_complete(self, self.future)
        return self.future.result()


def main(args: list[str] | None = None) -> None:
    """Ask once, for the sum of two arguments of the command line."""
    with until_stopped(args):
        node = ServiceClientNode()
        a = int(sys.argv[1]) if len(sys.argv) > 1 else 1
        b = int(sys.argv[2]) if len(sys.argv) > 2 else 2
        response = node.send_request(a, b)
        node.get_logger().info(f"Result of {a} + {b} = {response.sum}")


if __name__ == "__main__":
    main()
