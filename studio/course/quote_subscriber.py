"""Quote subscriber: logs what comes on /amazing_quote.

Try: `studio demos quote_subscriber`, then publish a quote of your own:
`studio topic pub /amazing_quote pkg_with_interfaces/msg/AmazingQuote "{quote: Know thyself}"`.
"""

from __future__ import annotations

import studio.ros.client as rclpy
from studio.course.running import until_stopped
from studio.ros.client import Node
from studio.ros.messages.pkg_with_interfaces.msg import AmazingQuote


class AmazingQuoteSubscriberNode(Node):
    """Logs each quote and its author."""

    def __init__(self) -> None:
        super().__init__("amazing_quote_subscriber_node")
        self.amazing_quote_subscriber = self.create_subscription(
            msg_type=AmazingQuote,
            topic="/amazing_quote",
            callback=self.amazing_quote_subscriber_callback,
            qos_profile=1,
        )

    def amazing_quote_subscriber_callback(self, msg: AmazingQuote) -> None:
        """Log a quote."""
        self.get_logger().info(
            f"I have received the most amazing of quotes. It says '{msg.quote}'. It was thought by "
            f"the genius -- {msg.philosopher_name}. This latest quote had the id = {msg.id}."
        )


def main(args: list[str] | None = None) -> None:
    """Run until stopped."""
    with until_stopped(args):
        rclpy.spin(AmazingQuoteSubscriberNode())


if __name__ == "__main__":
    main()
