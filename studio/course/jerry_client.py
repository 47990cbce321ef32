"""Jerry's client: asks /distance every two seconds how far an obstacle somewhere is from him.

Try: `studio demos jerry_robot jerry_command_publisher jerry_client`, or ask yourself:
`studio service call /distance pkg_with_interfaces/srv/Distance "{x: 3.0, y: 4.0}"`.
"""

from __future__ import annotations

import random
from typing import Any

import studio.ros.client as rclpy
from studio.course.running import until_stopped
from studio.ros.client import Future, Node
from studio.ros.messages.pkg_with_interfaces.srv import Distance

FAR = 10.0


class DistanceClient(Node):
    """Asks by a timer; the answer comes to a callback."""

    def __init__(self) -> None:
        super().__init__("client_node")
        self.client = self.create_client(Distance, "distance")
        while not self.client.wait_for_service(timeout_sec=1.0):
            self.get_logger().info("Waiting for Jerry...")
        self.timer = self.create_timer(2.0, self.ask)

    def ask(self) -> None:
        """Put an obstacle somewhere, and ask how far it is."""
        place = Distance.Request(x=random.uniform(-FAR, FAR), y=random.uniform(-FAR, FAR))

        def answered(future: Future[Any]) -> None:
            if future.exception() is not None:
                self.get_logger().warn(f"No answer. {future.exception()}")
                return
            distance = future.result().distance
            text = f"({place.x:.2f}, {place.y:.2f}) is {distance:.2f} m away from Jerry"
            self.get_logger().info(text)

        self.client.call_async(place).add_done_callback(answered)


def main(args: list[str] | None = None) -> None:
    """Ask until stopped."""
    with until_stopped(args):
        rclpy.spin(DistanceClient())


if __name__ == "__main__":
    main()
