"""Temperature watch: logs what comes on /temperature, and warns where it is too warm or too cold.

Try: `studio demos temperature_subscriber`, then
`studio topic pub /temperature sensor_msgs/msg/Temperature "{temperature: 35.0}"`.
"""

from __future__ import annotations

import studio.ros.client as rclpy
from studio.course.running import until_stopped
from studio.ros.client import Node
from studio.ros.messages.sensor_msgs.msg import Temperature

COLD_C, WARM_C = 18.0, 26.0


class TemperatureSubscriber(Node):
    """Keeps the mean of all temperatures received."""

    def __init__(self) -> None:
        super().__init__("temperature_subscriber")
        self.subscription = self.create_subscription(
            Temperature, "temperature", self.temperature_callback, 10
        )
        self.count = 0
        self.mean = 0.0

    def temperature_callback(self, msg: Temperature) -> None:
        """Log a temperature in degrees Celsius, with the mean so far."""
        self.count += 1
        self.mean += (msg.temperature - self.mean) / self.count
        text = f"{msg.temperature:.1f} C, mean {self.mean:.1f} C of {self.count}"
        if COLD_C <= msg.temperature <= WARM_C:
            self.get_logger().info(text)
        else:
            self.get_logger().warn(f"{text}: outside {COLD_C:.0f} to {WARM_C:.0f} C")


def main(args: list[str] | None = None) -> None:
    """Watch until stopped."""
    with until_stopped(args):
        rclpy.spin(TemperatureSubscriber())


if __name__ == "__main__":
    main()
