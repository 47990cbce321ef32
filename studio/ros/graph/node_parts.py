"""NodeParts: what a node has, grouped and in the order of `ros2 node info`."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from studio.ros.names import is_hidden
from studio.ros.tokens import EndpointKind

if TYPE_CHECKING:
    from studio.ros.graph.endpoints import GraphEndpoint, GraphNode
    from studio.ros.graph.graph import Graph

_GOALS = "/_action/send_goal"
NamesAndType = list[tuple[str, str]]
"""Names in order, each with its type."""


class NodeParts(NamedTuple):
    """Each group has what is not hidden, or all of it."""

    subscribers: NamesAndType
    publishers: NamesAndType
    service_servers: NamesAndType
    service_clients: NamesAndType
    action_servers: NamesAndType
    action_clients: NamesAndType


def parts_of(graph: Graph, node: GraphNode, *, hidden: bool) -> NodeParts:
    """Group what a node has; `hidden` names too, such as the topics that actions are made of."""
    ends = graph.endpoints_of(node)

    def of(kind: EndpointKind) -> list[GraphEndpoint]:
        return [end for end in ends if end.kind is kind]

    return NodeParts(
        _plain(of(EndpointKind.SUBSCRIPTION), hidden=hidden),
        _plain(of(EndpointKind.PUBLISHER), hidden=hidden),
        _plain(of(EndpointKind.SERVICE), hidden=hidden),
        _plain(of(EndpointKind.CLIENT), hidden=hidden),
        _actions(of(EndpointKind.SERVICE)),
        _actions(of(EndpointKind.CLIENT)),
    )


def _plain(ends: list[GraphEndpoint], *, hidden: bool) -> NamesAndType:
    return sorted({(end.name, end.type_name) for end in ends if hidden or not is_hidden(end.name)})


def _actions(ends: list[GraphEndpoint]) -> NamesAndType:
    return sorted(
        (end.name.removesuffix(_GOALS), end.type_name.removesuffix("_SendGoal"))
        for end in ends
        if end.name.endswith(_GOALS)
    )
