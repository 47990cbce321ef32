"""Points adder's client: two points twice a second; an answer that takes longer is given up.

Try: `studio demos add_points_server add_points_client`; stop the server with Ctrl-Z and go on
with `fg`: the client gives up waiting, asks again, and is answered again.
"""

from __future__ import annotations

import random
from typing import TYPE_CHECKING, Any

import studio.ros.client as rclpy
from studio.course.running import until_stopped
from studio.ros.client import Future, Node
from studio.ros.messages.pkg_with_interfaces.srv import AddPoints

if TYPE_CHECKING:
    from studio.ros.messages.geometry_msgs.msg import Point


class AddPointsServiceClientNode(Node):
    """Asks by a timer, and never waits within a callback."""

    def __init__(self) -> None:
        super().__init__("add_points_service_client")
        self.service_client = self.create_client(srv_type=AddPoints, srv_name="/add_points")
        while not self.service_client.wait_for_service(timeout_sec=1.0):
            self.get_logger().info(f"Service {self.service_client.srv_name} not available.")
        self.future: Future[Any] | None = None
        self.timer = self.create_timer(0.5, self.timer_callback)

    def timer_callback(self) -> None:
        """Ask for the sum of two points; the question before is given up if it is still open."""
        request = AddPoints.Request()
        for point in (request.a, request.b):
            point.x, point.y, point.z = (random.uniform(0, 100) for _ in range(3))
        if self.future is not None and not self.future.done():
            self.future.cancel()
            self.get_logger().warn("The answer took too long: it was given up.")
        self.get_logger().info(f"Adding {_text(request.a)} and {_text(request.b)}")
        self.future = self.service_client.call_async(request)
        self.future.add_done_callback(self.process_response)

    def process_response(self, future: Future[Any]) -> None:
        """Log the answer; a cancelled request, or one without a server, has none."""
        if future.cancelled() or future.exception() is not None:
            self.get_logger().info("The response was None.")
        else:
            self.get_logger().info(f"The result was {_text(future.result().result)}")


def _text(point: Point) -> str:
    return f"({point.x:.2f}, {point.y:.2f}, {point.z:.2f})"


def main(args: list[str] | None = None) -> None:
    """Ask until stopped."""
    with until_stopped(args):
        rclpy.spin(AddPointsServiceClientNode())


if __name__ == "__main__":
    main()
