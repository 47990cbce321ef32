"""ToolPublisher: the publisher of a tool of the 3D view.

It imports Zenoh (through `ros`), so it is imported when it is first used.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from studio.live.panels.requests import wire_name
from studio.ros.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from studio.ros.type_lookup import known_message
from studio.ros.types.convert import from_dict

if TYPE_CHECKING:
    from studio.live.connection.link import WireLink
    from studio.live.panels.tool_publishing import TopicSettings

_HISTORY: Final = {
    "System Default": HistoryPolicy.SYSTEM_DEFAULT,
    "Keep Last": HistoryPolicy.KEEP_LAST,
    "Keep All": HistoryPolicy.KEEP_ALL,
}
_RELIABILITY: Final = {
    "System Default": ReliabilityPolicy.SYSTEM_DEFAULT,
    "Reliable": ReliabilityPolicy.RELIABLE,
    "Best Effort": ReliabilityPolicy.BEST_EFFORT,
}
_DURABILITY: Final = {
    "System Default": DurabilityPolicy.SYSTEM_DEFAULT,
    "Volatile": DurabilityPolicy.VOLATILE,
    "Transient Local": DurabilityPolicy.TRANSIENT_LOCAL,
}


class ToolPublisher:
    """Publishes on one topic; made and closed in a thread.

    Raises:
        StudioError: The name of the topic is not valid, or its type is not known.
    """

    def __init__(self, link: WireLink, settings: TopicSettings) -> None:
        self.link, self.settings = link, settings
        self.name = wire_name(settings.topic)
        why: list[str] = []
        self._kind = known_message(link.node, self.name, settings.message_type, why.append)
        profile = QoSProfile(
            depth=settings.depth,
            history=_HISTORY[settings.history],
            reliability=_RELIABILITY[settings.reliability],
            durability=_DURABILITY[settings.durability],
        )
        self._publisher = link.node.create_publisher(self._kind, self.name, profile)
        self.has_sent = False

    def subscriptions(self) -> int:
        """Count who subscribes to the topic."""
        return self._publisher.get_subscription_count()

    def send(self, values: dict[str, Any]) -> None:
        """Publish a message of these fields."""
        self.has_sent = True
        self._publisher.publish(from_dict(self._kind, values))

    def close(self) -> None:
        """Publish nothing any more."""
        self.link.node.destroy_publisher(self._publisher)
