"""What displays hear, without a wire: topics that tests speak on, and those who publish them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.ros.graph.endpoints import GraphEndpoint, GraphNode
from studio.ros.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from studio.ros.tokens import EndpointKind
from tests.support.display_messages import NOW_NS

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.ros.node.samples import MessageInfo, RawCallback

NODE = GraphNode("ab", 0, "", "/", "talker", "/talker")


def publisher(
    type_name: str, *, reliable: bool = True, latched: bool = False, token: str = "t"
) -> GraphEndpoint:
    """Somebody who publishes."""
    qos = QoSProfile(
        depth=1,
        reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE,
    )
    return GraphEndpoint(token, NODE, EndpointKind.PUBLISHER, "/topic", type_name, "", qos)


def info_from(gid: bytes = b"\x00" * 16, at_ns: int = NOW_NS) -> MessageInfo:
    """What is known of a message."""
    return {
        "source_timestamp": at_ns,
        "received_timestamp": at_ns,
        "publication_sequence_number": 1,
        "reception_sequence_number": None,
        "publisher_gid": gid,
    }


class HeardTopics:
    """Whoever hears a topic takes what is said on it."""

    def __init__(self) -> None:
        self.takers: dict[str, RawCallback] = {}
        self.asked: list[tuple[str, str, QoSProfile]] = []
        self.before_hearing: Callable[[], None] = lambda: None

    def hear(
        self, type_name: str, topic: str, take: RawCallback, qos: QoSProfile
    ) -> Callable[[], None]:
        """As the link does."""
        self.before_hearing()
        self.asked.append((type_name, topic, qos))
        self.takers[topic] = take

        def end() -> None:
            if self.takers.get(topic) is take:
                del self.takers[topic]

        return end

    def say(self, topic: str, data: bytes, gid: bytes = b"\x00" * 16) -> None:
        """A message comes."""
        self.takers[topic](data, info_from(gid))
