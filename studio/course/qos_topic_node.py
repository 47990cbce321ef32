"""Quality of service: a reliable and volatile topic, /reliable_topic; who comes late has missed it.

Try: start it, wait, then `studio topic echo /reliable_topic`: one waits for the next message, up to
ten seconds. Started with `--ros-args -p
qos_overrides./reliable_topic.publisher.durability:=transient_local` it keeps up to ten messages,
which are there at once.
"""

from __future__ import annotations

import studio.ros.client as rclpy
from studio.course.running import until_stopped
from studio.ros.client import DurabilityPolicy, Node, QoSProfile, ReliabilityPolicy
from studio.ros.messages.std_msgs.msg import String
from studio.ros.node.qos_overriding_options import QoSOverridingOptions, QoSPolicyKind


class QoSTopicNode(Node):
    """Publishes rarely; a parameter decides whether late subscribers get earlier messages."""

    def __init__(self) -> None:
        super().__init__("qos_topic_node")
        qos_profile = QoSProfile(
            depth=10,
            reliability=ReliabilityPolicy.RELIABLE,
            durability=DurabilityPolicy.VOLATILE,
        )
        self.publisher = self.create_publisher(
            String,
            "reliable_topic",
            qos_profile,
            qos_overriding_options=QoSOverridingOptions([QoSPolicyKind.DURABILITY]),
        )
        self.i = 0
        self.timer = self.create_timer(10.0, self.publish_next)
        self.publish_next()

    def publish_next(self) -> None:
        """Send a message."""
        self.publisher.publish(String(data=f"reliably: {self.i}"))
        self.i += 1


def main(args: list[str] | None = None) -> None:
    """Run until stopped."""
    with until_stopped(args):
        rclpy.spin(QoSTopicNode())


if __name__ == "__main__":
    main()
