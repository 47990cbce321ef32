"""The ROS graph as the page shows it: nodes, what connects them, and the details of one node."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Final, Literal, Protocol

from studio.protocol.commands import Commands, Scope
from studio.protocol.graph import (
    LINKS_MAX,
    NODES_MAX,
    EndView,
    GetGraph,
    GetNode,
    GraphAnswer,
    GraphLinkView,
    GraphNodeView,
    NodeAnswer,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from studio.live.connection.link import WireLink
    from studio.live.connection.ros_connection import RosConnection
    from studio.ros.graph.endpoints import GraphEndpoint, GraphNode
    from studio.ros.graph.graph import Graph, NamesAndTypes


class AnswersGraph(Protocol):
    """A system whose graph is asked for."""

    async def graph(self, command: GetGraph, /) -> GraphAnswer:
        """Return the graph; nothing if it is the version known."""
        ...

    async def node(self, command: GetNode, /) -> NodeAnswer:
        """Return the topics, services and actions of a node."""
        ...


class GraphViews:
    """Views of the connection's graph; empty without a connection."""

    def __init__(self, wire: RosConnection) -> None:
        self._wire = wire

    async def graph(self, command: GetGraph) -> GraphAnswer:
        """Return the graph; nothing if it is the version known."""
        link = self._wire.current
        if link is None or link.graph.version == command.known:
            known = -1 if link is None else command.known
            return GraphAnswer(
                request=command.request, version=known, nodes=(), links=(), other_count=0, more=0
            )
        return await asyncio.to_thread(_answer, link, command.request)

    async def node(self, command: GetNode) -> NodeAnswer:
        """Return the topics, services and actions of a node."""
        link = self._wire.current
        if link is None:
            return node_answer(command, 0, {})
        return await asyncio.to_thread(_node, link.graph, command)


def _answer(link: WireLink, request: int) -> GraphAnswer:
    graph = link.graph
    # A change during the answer is in the next one.
    version = graph.version
    nodes = _nodes(graph.nodes(), link.zid)
    shown = nodes[:NODES_MAX]
    links = _links(graph, {one.name: at for at, one in enumerate(shown)})
    more = len(nodes) - len(shown) + max(0, len(links) - LINKS_MAX)
    return GraphAnswer(
        request=request,
        version=version,
        nodes=tuple(shown),
        links=tuple(links[:LINKS_MAX]),
        other_count=len(link.node_names()),
        more=more,
    )


def _nodes(found: Iterable[GraphNode], own: str) -> list[GraphNodeView]:
    """Return one view for all nodes of the same name, sorted."""
    by_name: dict[str, list[GraphNode]] = {}
    for one in found:
        by_name.setdefault(one.path, []).append(one)
    return [
        GraphNodeView(
            name=name,
            count=len(same),
            own=all(one.zid == own for one in same),
            bridge=", ".join(dict.fromkeys(one.bridge for one in same if one.bridge)),
        )
        for name, same in by_name.items()
    ]


def _links(graph: Graph, places: Mapping[str, int]) -> list[GraphLinkView]:
    def of(
        kind: Literal["topic", "service", "action"],
        found: NamesAndTypes,
        ends: tuple[Callable[[str], Iterable[str]], Callable[[str], Iterable[str]]],
    ) -> list[GraphLinkView]:
        return [_link(kind, name, types, ends, places) for name, types in found]

    return [
        *of("topic", graph.topics(), (_paths(graph.publishers), _paths(graph.subscriptions))),
        *of("service", graph.services(), (_paths(graph.clients), _paths(graph.servers))),
        *of(
            "action",
            graph.actions(),
            (
                lambda name: (one.path for one in graph.action_clients(name)),
                lambda name: (one.path for one in graph.action_servers(name)),
            ),
        ),
    ]


def _paths(ends: Callable[[str], list[GraphEndpoint]]) -> Callable[[str], Iterable[str]]:
    return lambda name: (end.node.path for end in ends(name))


def _link(
    kind: Literal["topic", "service", "action"],
    name: str,
    types: list[str],
    ends: tuple[Callable[[str], Iterable[str]], Callable[[str], Iterable[str]]],
    places: Mapping[str, int],
) -> GraphLinkView:
    from studio.ros.names import is_hidden  # noqa: PLC0415

    sources, targets = (
        tuple(sorted({places[path] for path in paths(name) if path in places})) for paths in ends
    )
    return GraphLinkView(
        kind=kind,
        name=name,
        types=tuple(types),
        sources=sources,
        targets=targets,
        hidden=is_hidden(name),
    )


def _node(graph: Graph, command: GetNode) -> NodeAnswer:
    from studio.ros.graph.graph import parts_of  # noqa: PLC0415 - imports zenoh

    same = [one for one in graph.nodes() if one.path == command.name]
    parts = parts_of(graph, same[0], hidden=False)._asdict() if same else {}
    return node_answer(command, len(same), parts)


def node_answer(
    command: GetNode, count: int, parts: Mapping[str, list[tuple[str, str]]]
) -> NodeAnswer:
    """Return the answer about so many nodes of a name, with what they have by its kind."""

    def ends(group: str) -> tuple[EndView, ...]:
        return tuple(EndView(name=name, type=kind) for name, kind in parts.get(group, ()))

    return NodeAnswer(
        request=command.request,
        name=command.name,
        count=count,
        subscribers=ends("subscribers"),
        publishers=ends("publishers"),
        service_servers=ends("service_servers"),
        service_clients=ends("service_clients"),
        action_servers=ends("action_servers"),
        action_clients=ends("action_clients"),
    )


COMMANDS: Final = Commands[AnswersGraph](Scope.ROS)
COMMANDS.viewer(GetGraph, lambda one, c, _: one.graph(c), same_for_all=True)
COMMANDS.viewer(GetNode, lambda one, c, _: one.node(c), same_for_all=True)
