"""Bridges to DDS as values, as a session makes them of what bridges tell."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.ros.graph.endpoints import GraphEndpoint, GraphNode
from studio.ros.qos import QoSProfile
from studio.ros.tokens import EndpointKind
from studio.ros.wire.bridges.admin import Rules, Settings
from studio.ros.wire.bridges.bridge import Bridge, BridgedEnd

if TYPE_CHECKING:
    from studio.ros.wire.bridges.dialect import RouteKind

STRING = "std_msgs/msg/String"


def bridge(  # noqa: PLR0913 - the parts of one value
    *nodes: str,
    ends: tuple[BridgedEnd, ...] = (),
    settings: Settings | None = None,
    withheld: tuple[tuple[RouteKind, str], ...] = (),
    is_used: bool = True,
    twin: str = "",
    name: str = "robot",
    participant: str = "0110aa",
    hosts: tuple[str, ...] = ("robot",),
) -> Bridge:
    """A bridge with nodes of these names, all of one participant, which is of Cyclone DDS."""
    return Bridge(
        zid="b0b0b0",
        name=name,
        version="1.10.0",
        settings=settings or started(),
        hosts=hosts,
        nodes=tuple((participant, path) for path in nodes),
        ends=ends,
        withheld=withheld,
        is_used=is_used,
        twin=twin,
    )


def started(
    domain: int = 0,
    namespace: str = "/",
    *,
    localhost_only: bool = False,
    rules: Rules | None = None,
    slowed: tuple[tuple[str, float], ...] = (),
) -> Settings:
    """How a bridge was started."""
    return Settings(domain, namespace, "zenoh_bridge_ros2dds", localhost_only, rules, slowed)


def bridged_end(
    name: str,
    node: str = "/talker",
    *,
    kind: EndpointKind = EndpointKind.PUBLISHER,
    type_name: str = STRING,
    type_hash: str = "",
    qos: QoSProfile | None = None,
) -> BridgedEnd:
    """An end of a node on DDS."""
    identity = f"b0b0b0/0110aa{node}/{kind}{name}"
    found = qos or QoSProfile(depth=10)
    return BridgedEnd(identity, kind, name, type_name, type_hash, found, node, "0110aa")


def graph_end(end: BridgedEnd) -> GraphEndpoint:
    """The same as the graph has it, behind the bridge `robot`."""
    return GraphEndpoint.behind(end, GraphNode.behind(bridge(end.node), "0110aa", end.node))
