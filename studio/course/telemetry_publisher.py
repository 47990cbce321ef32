"""Telemetry: a message of one's own type, CustomTelemetry, on /telemetry.

Try: `studio demos telemetry_publisher`, then `studio interface show
my_robot_interfaces/msg/CustomTelemetry` and `studio topic echo /telemetry --field status`.
"""

from __future__ import annotations

import math

import studio.ros.client as rclpy
from studio.course.running import until_stopped
from studio.ros.client import Node
from studio.ros.messages.my_robot_interfaces.msg import CustomTelemetry


class TelemetryPublisher(Node):
    """Tells twice a second how a robot does while its battery runs down."""

    def __init__(self) -> None:
        super().__init__("telemetry_publisher")
        self.publisher = self.create_publisher(CustomTelemetry, "telemetry", 10)
        self.timer = self.create_timer(0.5, self.publish_telemetry)
        self.seconds = 0.0

    def publish_telemetry(self) -> None:
        """Send how it does now; the battery is charged every ten minutes."""
        msg = CustomTelemetry()
        msg.header.stamp = self.get_clock().now().to_msg()
        msg.header.frame_id = "base_link"
        msg.battery_voltage = 12.6 - 2.0 * (self.seconds % 600) / 600
        msg.speed = 0.5 + 0.3 * math.sin(self.seconds / 5)
        msg.temperature = 30.0 + 10.0 * msg.speed
        msg.status = "ok" if msg.battery_voltage > 11.0 else "battery low"
        self.publisher.publish(msg)
        self.seconds += 0.5


def main(args: list[str] | None = None) -> None:
    """Publish until stopped."""
    with until_stopped(args):
        rclpy.spin(TelemetryPublisher())


if __name__ == "__main__":
    main()
