"""Quote publisher: an amazing quote on /amazing_quote, every second.

Try: `studio demos quote_publisher quote_subscriber`, then `studio topic echo /amazing_quote`.
"""

from __future__ import annotations

import studio.ros.client as rclpy
from studio.course.running import until_stopped
from studio.ros.client import Node
from studio.ros.messages.pkg_with_interfaces.msg import AmazingQuote


class AmazingQuotePublisherNode(Node):
    """Publishes a message of a type that this system brought along."""

    def __init__(self) -> None:
        super().__init__("amazing_quote_publisher_node")
        self.amazing_quote_publisher = self.create_publisher(
            msg_type=AmazingQuote, topic="/amazing_quote", qos_profile=1
        )
        timer_period: float = 1.0
        self.timer = self.create_timer(timer_period, self.timer_callback)
        self.incremental_id: int = 0

    def timer_callback(self) -> None:
        """Send the quote with the next number."""
        amazing_quote = AmazingQuote()
        amazing_quote.id = self.incremental_id
        amazing_quote.quote = "Use the force, Pikachu!"
        amazing_quote.philosopher_name = "Uncle Ben"
        self.amazing_quote_publisher.publish(amazing_quote)
        self.incremental_id += 1


def main(args: list[str] | None = None) -> None:
    """Run until stopped."""
    with until_stopped(args):
        rclpy.spin(AmazingQuotePublisherNode())


if __name__ == "__main__":
    main()
