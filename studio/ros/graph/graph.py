"""The ROS graph of a domain, kept by a thread: its nodes, topics, services and actions."""

from __future__ import annotations

import time
from collections import OrderedDict
from typing import TYPE_CHECKING, NamedTuple, Self

from studio.ros.condition import Condition
from studio.ros.graph.endpoints import GraphTable, Taken
from studio.ros.names import action_part, check_full_name, is_hidden
from studio.ros.tokens import EndpointKind, tokens_of_domain
from studio.ros.wire.zenoh import ReadingThread, Sample, live_tokens, token_change, watch_tokens

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.ros.graph.endpoints import GraphEndpoint, GraphNode
    from studio.ros.wire.bridges.bridge import Bridge
    from studio.ros.wire.session import WireSession

_GOAL = action_part("", "send_goal")
_GOAL_TYPE = "_SendGoal"
NamesAndTypes = list[tuple[str, list[str]]]
"""What rclpy returns for topics, services and actions: names in order, each with its types."""
CHECK_TIMEOUT_S = 1.0
SETTLE_TIMEOUT_S = 3.0
_WITHDRAWN_MAX = 10_000
"""Own tokens that were taken back, of which samples may still come."""
NamesAndType = list[tuple[str, str]]
"""Names in order, each with its type."""


class Graph:
    """The nodes and endpoints of a session's domain, from the moment it is made until `close`.

    Nodes of the session itself are there at once. Of others it begins empty: `settle` waits for
    what stood before, `wait_for` for what is to come.
    """

    def __init__(self, wire: WireSession) -> None:
        self._wire = wire
        self._table = GraphTable()
        self._changed = Condition()
        self._version = 0
        self._listeners: list[Callable[[], None]] = []
        self._withdrawn: OrderedDict[str, None] = OrderedDict()
        self._bridges: tuple[Bridge, ...] = ()
        self._leave_own = wire.own_tokens.follow(self._take_own)
        tokens = watch_tokens(wire.zenoh, tokens_of_domain(wire.domain))
        self._thread = ReadingThread("ros-graph", tokens, self._take)
        self._leave_bridges = wire.bridges.on_change(self._take_bridges)
        self._take_bridges()

    def close(self) -> None:
        """Stop watching; again is harmless."""
        self._leave_own()
        self._leave_bridges()
        self._thread.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @property
    def version(self) -> int:
        """A number that grows with every change."""
        return self._version

    @property
    def token_count(self) -> int:
        """The number of nodes and endpoints."""
        return len(self._table)

    @property
    def malformed(self) -> tuple[int, str | None]:
        """The number of malformed tokens, and what was wrong with the last."""
        bridges = self._wire.bridges
        with self._changed:
            count = self._table.malformed + bridges.malformed
            return count, self._table.last_malformed or bridges.last_malformed or None

    def on_change(self, listener: Callable[[], None]) -> Callable[[], None]:
        """Call a listener after each batch of changes, in the graph's thread; return its end.

        It must be quick and raise nothing: it holds up the graph, though nothing else.
        """
        with self._changed:
            self._listeners.append(listener)
        return lambda: self._forget_listener(listener)

    def wait_for(self, condition: Callable[[], bool], timeout_s: float | None = None) -> bool:
        """Wait until a condition on this graph holds; False when it does not in time."""
        with self._changed:
            return self._changed.wait_for(condition, timeout_s)

    def settle(self, timeout_s: float = SETTLE_TIMEOUT_S) -> bool:
        """Wait until all that is alive now is in the graph; False when that takes too long."""
        end_s = time.monotonic() + timeout_s
        is_bridged = self._wire.bridges.settle(timeout_s)
        self._take_bridges()  # their thread may not have come to this graph yet
        alive = set(live_tokens(self._wire.zenoh, tokens_of_domain(self._wire.domain), timeout_s))
        with self._changed:
            return is_bridged and self._changed.wait_for(
                lambda: all(map(self._table.was_seen, alive)), max(0.0, end_s - time.monotonic())
            )

    def nodes(self) -> list[GraphNode]:
        """Return every node, in the order of their paths; two of one name are two."""
        with self._changed:
            return self._table.nodes()

    def node(self, path: str) -> GraphNode | None:
        """Return the node of a path; of several, the first."""
        return next((node for node in self.nodes() if node.path == path), None)

    def duplicate_nodes(self) -> dict[str, int]:
        """Paths that more than one node has, and how many do."""
        paths = [node.path for node in self.nodes()]
        return {path: count for path in sorted(set(paths)) if (count := paths.count(path)) > 1}

    def endpoints_of(self, node: GraphNode) -> list[GraphEndpoint]:
        """Return the endpoints of a node, in the order of their names."""
        with self._changed:
            return self._table.endpoints_of(node)

    def publishers(self, topic: str) -> list[GraphEndpoint]:
        """Return the publishers of a topic; names are fully qualified, here and below."""
        return self._endpoints(EndpointKind.PUBLISHER, topic)

    def subscriptions(self, topic: str) -> list[GraphEndpoint]:
        """Return the subscriptions of a topic."""
        return self._endpoints(EndpointKind.SUBSCRIPTION, topic)

    def servers(self, service: str) -> list[GraphEndpoint]:
        """Return the servers of a service; more than one is a fault of that system."""
        return self._endpoints(EndpointKind.SERVICE, service)

    def clients(self, service: str) -> list[GraphEndpoint]:
        """Return the clients of a service."""
        return self._endpoints(EndpointKind.CLIENT, service)

    def count(self, kind: EndpointKind, name: str) -> int:
        """Count the publishers, subscriptions, servers or clients of a name."""
        with self._changed:
            return self._table.count(kind, name)

    def topics(self) -> NamesAndTypes:
        """Return the topics that have a publisher or subscription, hidden ones too."""
        return self._names_and_types(EndpointKind.PUBLISHER, EndpointKind.SUBSCRIPTION)

    def services(self) -> NamesAndTypes:
        """Return the services that have a server, hidden ones too."""
        return self._names_and_types(EndpointKind.SERVICE)

    def actions(self) -> NamesAndTypes:
        """Return the actions that have a server, known by their services."""
        return action_names_and_types(self.services())

    def action_servers(self, action: str) -> list[GraphNode]:
        """Return the nodes that serve an action."""
        return [found.node for found in self.servers(goal_service(action))]

    def action_clients(self, action: str) -> list[GraphNode]:
        """Return the nodes that have a client of an action."""
        return [found.node for found in self.clients(goal_service(action))]

    def all_of(self, kind: EndpointKind) -> dict[str, tuple[GraphEndpoint, ...]]:
        """Return all endpoints of a kind by name, in no order: much cheaper than one by one."""
        with self._changed:
            return {name: tuple(one.values()) for name, one in self._table.named(kind).items()}

    def endpoint_of_gid(self, gid: bytes) -> GraphEndpoint | None:
        """Return the endpoint that has a GID, None when none is known."""
        with self._changed:
            return self._table.endpoint_of_gid(gid)

    def wait_for_service(
        self, name: str, type_name: str | None = None, timeout_s: float | None = None
    ) -> bool:
        """Wait until a service has a server, of that type if one is given."""
        return self.wait_for(lambda: self.has_server(name, type_name), timeout_s)

    def has_server(self, name: str, type_name: str | None = None) -> bool:
        """Whether a service has a server, of that type if one is given."""
        return any(type_name in {None, server.type_name} for server in self.servers(name))

    def _endpoints(self, kind: EndpointKind, name: str) -> list[GraphEndpoint]:
        check_full_name(name)
        with self._changed:
            return self._table.endpoints(kind, name)

    def _names_and_types(self, *kinds: EndpointKind) -> NamesAndTypes:
        found: dict[str, set[str]] = {}
        with self._changed:
            for kind in kinds:
                for name, same_name in self._table.named(kind).items():
                    types = {one.type_name for one in same_name.values()}
                    found.setdefault(name, set()).update(types)
        return [(name, sorted(found[name])) for name in sorted(found)]

    def _forget_listener(self, listener: Callable[[], None]) -> None:
        with self._changed:
            if listener in self._listeners:
                self._listeners.remove(listener)

    def _take(self, samples: list[Sample]) -> None:
        """Take a batch in; the graph's thread only."""
        with self._changed:
            results = {str(one.key_expr): self._take_one(one) for one in samples}
        uncertain = [token for token, taken in results.items() if taken is Taken.UNCERTAIN]
        alive = {token for token in uncertain if self._is_alive(token)}
        with self._changed:
            for token in uncertain:
                self._table.settle(token, is_alive=token in alive)
            self._version += 1
            self._changed.notify_all()
            listeners = list(self._listeners)
        for listener in listeners:
            listener()

    def _take_bridges(self) -> None:
        """Take in what bridges to DDS show, in their thread."""
        with self._changed:
            bridges = self._wire.bridges.current
            if bridges == self._bridges:
                return  # who waits until the version rests asks for this again and again
            self._bridges = bridges
            self._table.set_bridged(one for one in bridges if one.is_used)
            self._version += 1
            self._changed.notify_all()
            listeners = list(self._listeners)
        for listener in listeners:
            listener()

    @property
    def bridges(self) -> tuple[Bridge, ...]:
        """The bridges to DDS that the session meets, also those of other domains."""
        return self._bridges

    def _take_own(self, token: str, is_alive: bool) -> None:  # noqa: FBT001
        """Take in what the session itself shows; listeners are called when it comes by the wire."""
        with self._changed:
            if is_alive:
                self._table.put(token, sure=True)
            else:
                self._table.delete(token)
                self._withdrawn[token] = None
                if len(self._withdrawn) > _WITHDRAWN_MAX:
                    self._withdrawn.popitem(last=False)
            self._version += 1
            self._changed.notify_all()

    def _take_one(self, sample: Sample) -> Taken:
        token, is_alive = token_change(sample)
        if token in self._wire.own_tokens or token in self._withdrawn:
            return Taken.KNOWN  # it comes later than `_take_own`, perhaps when it is gone again
        return self._table.put(token) if is_alive else self._table.delete(token)

    def _is_alive(self, token: str) -> bool:
        return token in live_tokens(self._wire.zenoh, token, CHECK_TIMEOUT_S)


class NodeParts(NamedTuple):
    """What a node has, grouped; hidden names may be left out."""

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
        _names_of(of(EndpointKind.SUBSCRIPTION), hidden=hidden),
        _names_of(of(EndpointKind.PUBLISHER), hidden=hidden),
        _names_of(of(EndpointKind.SERVICE), hidden=hidden),
        _names_of(of(EndpointKind.CLIENT), hidden=hidden),
        _actions_of(of(EndpointKind.SERVICE)),
        _actions_of(of(EndpointKind.CLIENT)),
    )


def _names_of(ends: list[GraphEndpoint], *, hidden: bool) -> NamesAndType:
    return sorted({(end.name, end.type_name) for end in ends if hidden or not is_hidden(end.name)})


def _actions_of(ends: list[GraphEndpoint]) -> NamesAndType:
    return sorted(
        (end.name.removesuffix(_GOAL), end.type_name.removesuffix("_SendGoal"))
        for end in ends
        if end.name.endswith(_GOAL)
    )


def goal_service(action: str) -> str:
    """Name the service that takes an action's goals."""
    return action + _GOAL


def action_names_and_types(services: list[tuple[str, list[str]]]) -> list[tuple[str, list[str]]]:
    """Find the actions among services; one whose type is no action's is a service only."""
    found = (
        (name.removesuffix(_GOAL), [one.removesuffix(_GOAL_TYPE) for one in _goal_types(types)])
        for name, types in services
        if name.endswith(_GOAL) and len(name) > len(_GOAL)
    )
    return [(name, types) for name, types in found if types]


def _goal_types(types: list[str]) -> list[str]:
    return [one for one in types if "/action/" in one and one.endswith(_GOAL_TYPE)]
