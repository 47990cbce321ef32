"""Quality of service: keeps its last messages on /reliable_topic for those who come late.

Try: start it, wait, then `studio topic echo /reliable_topic`: up to ten messages that it kept are
there at once. With `--qos-durability volatile` one waits for the next.
"""

from __future__ import annotations

import studio.ros.client as rclpy
from studio.nodes.demos.running import until_stopped
from studio.ros.client import DurabilityPolicy, Node, QoSProfile, ReliabilityPolicy
from studio.ros.messages.std_msgs.msg import String


class QoSTopicNode(Node):
    """Publishes rarely; a late subscriber that asks for it gets the last message nevertheless."""

    def __init__(self) -> None:
        super().__init__("qos_topic_node")
        qos_profile = QoSProfile(
            depth=10,
            reliability=ReliabilityPolicy.RELIABLE,
            durability=DurabilityPolicy.TRANSIENT_LOCAL,
        )
        self.publisher = self.create_publisher(String, "reliable_topic", qos_profile)
        self.i = 0
        self.timer = self.create_timer(10.0, self.publish_next)
        self.publish_next()

    def publish_next(self) -> None:
        """Send a message that is kept."""
        self.publisher.publish(String(data=f"kept for you: {self.i}"))
        self.i += 1


def main(args: list[str] | None = None) -> None:
    """Run until stopped."""
    with until_stopped(args):
        rclpy.spin(QoSTopicNode())


if __name__ == "__main__":
    main()
