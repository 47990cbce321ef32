"""Publishers as a graph knows them."""

from __future__ import annotations

from studio.ros.graph.endpoints import GraphEndpoint, GraphNode
from studio.ros.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from studio.ros.tokens import EndpointKind

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
