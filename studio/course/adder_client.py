"""Adder's client: asks /add_two_ints for the sum of two integers, and ends.

Try: `studio demos adder_server` in one terminal, `studio run learning_interface client 41 1` in
another; start the client first, and it waits.
"""

from __future__ import annotations

import sys

import studio.ros.client as rclpy
from studio.course.running import until_stopped
from studio.errors import SettingsError
from studio.ros.client import Node
from studio.ros.messages.learning_interface.srv import AddTwoInts


class adderClient(Node):
    """Sends one request, made of the command line's arguments."""

    def __init__(self, name: str) -> None:
        super().__init__(name)
        self.client = self.create_client(AddTwoInts, "add_two_ints")
        while not self.client.wait_for_service(timeout_sec=1.0):
            self.get_logger().info("service not available, waiting again...")
        self.request = AddTwoInts.Request()

    def send_request(self) -> None:
        """Ask, and do not wait: the answer comes to `future`."""
        self.request.a = int(sys.argv[1])
        self.request.b = int(sys.argv[2])
        self.future = self.client.call_async(self.request)


def main(args: list[str] | None = None) -> None:
    """Ask once."""
    with until_stopped(args):
        if len(sys.argv) < 3:
            raise SettingsError(
                "Two integers are needed: studio run learning_interface client 41 1"
            )
        node = adderClient("service_adder_client")
        node.send_request()
        while rclpy.ok():
            rclpy.spin_once(node)
            if node.future.done():
                response = node.future.result()
                node.get_logger().info(
                    "Result of add_two_ints: for %d + %d = %d"
                    % (node.request.a, node.request.b, response.sum)
                )
                break


if __name__ == "__main__":
    main()
