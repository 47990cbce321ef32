"""Thermometer: a temperature on /temperature, every second.

Try: `studio demos temperature_publisher temperature_subscriber`, then
`studio topic echo /temperature --field temperature`.
"""

from __future__ import annotations

import math
import random

import studio.ros.client as rclpy
from studio.course.running import until_stopped
from studio.ros.client import Node
from studio.ros.messages.sensor_msgs.msg import Temperature


class TemperaturePublisher(Node):
    """A room that warms and cools within five minutes, with a sensor's noise."""

    def __init__(self) -> None:
        super().__init__("temperature_publisher")
        self.publisher = self.create_publisher(Temperature, "temperature", 10)
        self.timer = self.create_timer(1.0, self.publish_temperature)
        self.seconds = 0

    def publish_temperature(self) -> None:
        """Send what the sensor reads now."""
        msg = Temperature()
        msg.header.stamp = self.get_clock().now().to_msg()
        msg.header.frame_id = "thermometer"
        swing = 6.0 * math.sin(math.tau * self.seconds / 300)
        msg.temperature = 22.0 + swing + random.gauss(0.0, 0.1)
        msg.variance = 0.01
        self.publisher.publish(msg)
        self.seconds += 1


def main(args: list[str] | None = None) -> None:
    """Measure until stopped."""
    with until_stopped(args):
        rclpy.spin(TemperaturePublisher())


if __name__ == "__main__":
    main()
