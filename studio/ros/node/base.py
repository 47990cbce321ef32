"""NodeBase: a node's name on the wire, its work and its end, and what it asks about others."""

from __future__ import annotations

import threading
import time
from functools import cached_property
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from studio.errors import DestroyedError, NodeNameNonExistentError, UnknownTypeError
from studio.ros.names import as_namespace, check_node_name, expand, logger_name
from studio.ros.node.clock import Clock, ClockType
from studio.ros.node.drain import Source
from studio.ros.node.logger import Logger, get_logger
from studio.ros.node.work import MutuallyExclusiveCallbackGroup
from studio.ros.profiles import NO_HASH
from studio.ros.qos import as_profile
from studio.ros.tokens import DataKey, EndpointKind, EndpointToken, NodeToken, gid_of
from studio.ros.wire.bridges.side import BridgeSide, DeclaredT

if TYPE_CHECKING:
    from collections.abc import Callable
    from contextlib import AbstractContextManager

    from studio.ros.graph.endpoints import GraphEndpoint
    from studio.ros.graph.graph import Graph, NamesAndTypes
    from studio.ros.node.arguments import NodeArguments
    from studio.ros.node.context import Context
    from studio.ros.node.executors import Executor
    from studio.ros.node.work import CallbackGroup, Work
    from studio.ros.qos import QoSProfile
    from studio.ros.wire.session import WireSession
    from studio.ros.wire.zenoh import Declaration


_CHECK_EVERY_S = 0.05
node_listeners: list[Callable[[NodeBase], None]] = []
"""Called with each node of this process as it begins to be made; for who looks after programs."""
_Value = TypeVar("_Value")


class Hideable(Generic[_Value]):
    """A property that an attribute of the same name hides: users name theirs as they like."""

    def __init__(self, get: Callable[[Any], _Value]) -> None:
        self._get = get
        self.__doc__ = get.__doc__

    def __get__(self, owner: object, kind: type | None = None) -> _Value:
        return self._get(owner)


class NodeBase:
    """The basis of a node, which creates nothing; users derive from `Node`."""

    def __init__(
        self, node_name: str, namespace: str, context: Context, arguments: NodeArguments
    ) -> None:
        self._context = context
        self._wire: WireSession = context.wire
        self._executor: Executor | None = None
        self._was_spun = False
        self._default_group: CallbackGroup = MutuallyExclusiveCallbackGroup()
        self._lock = threading.RLock()
        self._all_work: list[Work] = []
        self._ends: list[Callable[[], None]] = []
        self._destroyed = False
        self._clock = Clock(clock_type=ClockType.ROS_TIME)
        name = check_node_name(arguments.node_name or node_name)
        space = as_namespace(arguments.namespace or namespace)
        self._remapped = arguments.remapped
        self._token = NodeToken(
            self._wire.domain, self._wire.zid, self._wire.next_id(), space, name
        )
        self._shown = self._wire.own_tokens.show(str(self._token))
        for listener in node_listeners:
            listener(self)
        context.on_close(self.destroy_node)

    # Students name attributes of their nodes as they like: what is cached here they may hide.
    @cached_property
    def wire(self) -> WireSession:
        """The session that it shares with the other nodes of the process."""
        return self._wire

    @cached_property
    def context(self) -> Context:
        """The context, shared with the other nodes of the process."""
        return self._context

    @Hideable
    def graph(self) -> Graph:
        """The graph, which all nodes of the process share."""
        return self._context.graph

    @Hideable
    def token(self) -> NodeToken:
        """Its liveliness token."""
        return self._token

    @property
    def executor(self) -> Executor | None:
        """The executor that carries out its work, None until it spins."""
        return self._executor

    @executor.setter
    def executor(self, executor: Executor | None) -> None:
        before, self._executor = self._executor, executor
        self._was_spun = self._was_spun or executor is not None
        if before is not None and before is not executor:
            before.remove_node(self)

    @property
    def default_callback_group(self) -> CallbackGroup:
        """The group of all that names none: one piece at a time."""
        return self._default_group

    @property
    def all_work(self) -> list[Work]:
        """Its work: subscriptions, timers, services, clients and others."""
        with self._lock:
            return list(self._all_work)

    def get_name(self) -> str:
        """Return its name without the namespace."""
        return self._token.name

    def get_namespace(self) -> str:
        """Return its namespace, `/` or `/ns`."""
        return self._token.namespace

    def get_fully_qualified_name(self) -> str:
        """Return namespace and name, `/ns/name`."""
        return self._token.path

    def get_logger(self) -> Logger:
        """Return its logger, named `ns.name`."""
        return get_logger(logger_name(self._token.path))

    def get_clock(self) -> Clock:
        """Return its clock, which /clock sets if `use_sim_time` is true."""
        return self._clock

    def resolve_service_name(self, service: str, *, only_expand: bool = False) -> str:
        """Return the full name of a service of this node.

        Raises:
            RosNameError: No service can be named so.
        """
        return self.resolve_topic_name(service, only_expand=only_expand)

    def resolve_topic_name(self, topic: str, *, only_expand: bool = False) -> str:
        """Return the full name of a topic of this node, as remappings make it unless only expanded.

        Raises:
            RosNameError: No topic can be named so.
        """
        full = expand(topic, self._token.namespace, self._token.name)
        return full if only_expand else self._remapped(full, self._token)

    def add_work(self, work: Work) -> None:
        """Add work of any kind to the node's own; it is destroyed with the node.

        Raises:
            DestroyedError: The node was destroyed.
        """
        with self._lock:
            is_late = self._destroyed
            if not is_late:
                self._all_work.append(work)
                work.home = self
                if isinstance(work, Source):
                    self._context.drain.add(work)
        if is_late:
            work.destroy()  # what it declared would outlive the node
            self._refuse_destroyed()
        executor = self._executor
        if executor is not None:
            executor.adopt(work)
            if work.home is not self:  # it was destroyed by another thread meanwhile
                executor.forget(work)

    def remove_work(self, work: Work) -> bool:
        """Destroy a piece of work; whether it was the node's."""
        with self._lock:
            if work not in self._all_work:
                return False
            self._all_work.remove(work)
        work.home = None
        executor = self._executor
        if executor is not None:
            executor.forget(work)
        if isinstance(work, Source):
            self._context.forget_source(work)
        work.destroy()
        return True

    def announce(self, work: Work) -> None:
        """Notify the node's executor that work is ready; thread-safe."""
        executor = self._executor
        if executor is not None:
            executor.announce(work)

    def on_destroy(self, callback: Callable[[], None]) -> None:
        """Call back once before the node's own things are taken back, the last ones first."""
        with self._lock:
            self._ends.append(callback)

    def forget_destroy(self, callback: Callable[[], None]) -> None:
        """Do not call back; harmless when it was not to be."""
        with self._lock:
            if callback in self._ends:
                self._ends.remove(callback)

    def destroy_node(self) -> None:
        """Take back all that is its own, and then itself; again is harmless."""
        with self._lock:
            if self._destroyed:
                return
            self._destroyed = True
            ends, self._ends = self._ends, []
        for end in reversed(ends):
            end()
        for work in self.all_work:
            self.remove_work(work)
        if self._executor is not None:
            self._executor.remove_node(self)
        self._context.forget_close(self.destroy_node)
        if not self._wire.zenoh.is_closed():
            self._shown.undeclare()

    def get_node_names(self) -> list[str]:
        """Name all nodes without their namespaces."""
        return [node.name for node in self._context.graph.nodes()]

    def get_node_names_and_namespaces(self) -> list[tuple[str, str]]:
        """Return name and namespace of all nodes."""
        return [(node.name, node.namespace) for node in self._context.graph.nodes()]

    def get_fully_qualified_node_names(self) -> list[str]:
        """Return the full names of all nodes."""
        return [node.path for node in self._context.graph.nodes()]

    def get_topic_names_and_types(
        self,
        no_demangle: bool = False,  # noqa: FBT001, FBT002 - rclpy's
    ) -> NamesAndTypes:
        """Return all topics, each with its types."""
        del no_demangle
        return self._context.graph.topics()

    def get_service_names_and_types(self) -> NamesAndTypes:
        """Return all services, each with its types."""
        return self._context.graph.services()

    def get_publishers_info_by_topic(
        self,
        topic_name: str,
        no_mangle: bool = False,  # noqa: FBT001, FBT002 - rclpy's
    ) -> list[GraphEndpoint]:
        """Return the publishers of a topic."""
        del no_mangle
        return self._context.graph.publishers(self.resolve_topic_name(topic_name))

    def get_subscriptions_info_by_topic(
        self,
        topic_name: str,
        no_mangle: bool = False,  # noqa: FBT001, FBT002 - rclpy's
    ) -> list[GraphEndpoint]:
        """Return the subscriptions of a topic."""
        del no_mangle
        return self._context.graph.subscriptions(self.resolve_topic_name(topic_name))

    def get_publisher_names_and_types_by_node(
        self,
        node_name: str,
        node_namespace: str,
        no_demangle: bool = False,  # noqa: FBT001, FBT002
    ) -> NamesAndTypes:
        """Return the topics that a node publishes, each with its types."""
        del no_demangle
        return self._of_node(EndpointKind.PUBLISHER, node_name, node_namespace)

    def get_subscriber_names_and_types_by_node(
        self,
        node_name: str,
        node_namespace: str,
        no_demangle: bool = False,  # noqa: FBT001, FBT002
    ) -> NamesAndTypes:
        """Return the topics that a node subscribes to, each with its types."""
        del no_demangle
        return self._of_node(EndpointKind.SUBSCRIPTION, node_name, node_namespace)

    def get_service_names_and_types_by_node(
        self, node_name: str, node_namespace: str
    ) -> NamesAndTypes:
        """Return the services of a node, each with its types."""
        return self._of_node(EndpointKind.SERVICE, node_name, node_namespace)

    def get_client_names_and_types_by_node(
        self, node_name: str, node_namespace: str
    ) -> NamesAndTypes:
        """Return the services that a node calls, each with its types."""
        return self._of_node(EndpointKind.CLIENT, node_name, node_namespace)

    def get_node_names_and_namespaces_with_enclaves(self) -> list[tuple[str, str, str]]:
        """Return name, namespace and enclave of all nodes."""
        return [(one.name, one.namespace, one.enclave) for one in self._context.graph.nodes()]

    def wait_for_node(self, fully_qualified_node_name: str, timeout: float) -> bool:
        """Wait until a node is there, or that many seconds; whether it is."""
        end_s = time.monotonic() + timeout
        while fully_qualified_node_name not in self.get_fully_qualified_node_names():
            if time.monotonic() >= end_s:
                return False
            time.sleep(_CHECK_EVERY_S)
        return True

    def count_publishers(self, topic_name: str) -> int:
        """Count the publishers of a topic."""
        return self._count(EndpointKind.PUBLISHER, topic_name)

    def count_subscribers(self, topic_name: str) -> int:
        """Count the subscriptions of a topic."""
        return self._count(EndpointKind.SUBSCRIPTION, topic_name)

    def count_services(self, service_name: str) -> int:
        """Count the servers of a service."""
        return self._count(EndpointKind.SERVICE, service_name)

    def count_clients(self, service_name: str) -> int:
        """Count the clients of a service."""
        return self._count(EndpointKind.CLIENT, service_name)

    def endpoint(
        self,
        kind: EndpointKind,
        type_name: str,
        name: str,
        qos: QoSProfile | int,
        type_hash: str | None = None,
    ) -> Endpoint:
        """Make an endpoint of this node with a number of its own; its user shows it.

        A type whose hash is given, as others show it, need not be known here; an empty one is that
        of a type that DDS tells by name only.

        Raises:
            RosNameError: It cannot be named so.
            UnknownTypeError: The type, or what it is made of, is not known.
            DestroyedError: The node was destroyed.
        """
        self._refuse_destroyed()
        wire, full_name = self._wire, self.resolve_topic_name(name)
        known_hash = type_hash or self._own_hash(type_name, is_unknown_fine=type_hash is not None)
        token = EndpointToken(
            self._token, wire.next_id(), kind, full_name, type_name, known_hash, as_profile(qos)
        )
        return Endpoint(wire, token, lambda: self._context.graph)

    def _own_hash(self, type_name: str, *, is_unknown_fine: bool) -> str:
        wire = self._wire
        try:
            return wire.profile.type_hash(wire.types.hash_of(type_name))
        except UnknownTypeError:
            if is_unknown_fine:
                return NO_HASH
            raise

    def _refuse_destroyed(self) -> None:
        if self._destroyed:
            raise DestroyedError(f"node {self._token.path}")

    def _of_node(self, kind: EndpointKind, name: str, namespace: str) -> NamesAndTypes:
        """Return the names of ends of a kind that a node has, each with its types.

        Raises:
            NodeNameNonExistentError: There is no such node.
        """
        path = f"{namespace.rstrip('/')}/{name}"
        nodes = [one for one in self._context.graph.nodes() if one.path == path]
        if not nodes:
            raise NodeNameNonExistentError(path)
        found: dict[str, set[str]] = {}
        for node in nodes:
            for end in self._context.graph.endpoints_of(node):
                if end.kind is kind:
                    found.setdefault(end.name, set()).add(end.type_name)
        return [(topic, sorted(found[topic])) for topic in sorted(found)]

    def _count(self, kind: EndpointKind, name: str) -> int:
        return self._context.graph.count(kind, self.resolve_topic_name(name))


def was_spun(node: NodeBase) -> bool:
    """Whether an executor ever had a node; no property of it, which users could not set."""
    return node._was_spun  # pyright: ignore[reportPrivateUsage]


class Endpoint:
    """A token on the wire and the key it stands for.

    Attributes:
        token: As it is shown to all.
        gid: The 16 bytes that name it in every sample.
        key: The data key.
        graph: Gives who is there.
    """

    def __init__(self, wire: WireSession, token: EndpointToken, graph: Callable[[], Graph]) -> None:
        self.wire, self.graph = wire, graph
        self._side: BridgeSide[Any] | None = None
        self.token = token
        self.gid = gid_of(str(token))
        self.key = str(DataKey(wire.domain, token.name, token.type_name, token.type_hash))
        self._shown: Declaration | None = None

    def for_bridges(
        self,
        declare: Callable[[str], DeclaredT],
        lock: AbstractContextManager[object] | None = None,
    ) -> BridgeSide[DeclaredT]:
        """Make the half of this end that bridges to DDS meet; it ends when this one is hidden.

        Args:
            declare: See `BridgeSide`, also for the next.
            lock: Held while what is declared changes.
        """
        bridges = self.wire.bridges
        side = BridgeSide(self.wire.zenoh, bridges, self.token, self.token.name, declare, lock)
        self._side = side
        return side

    def show(self) -> None:
        """Show the token, after what it stands for was declared."""
        self._shown = self.wire.own_tokens.show(str(self.token))

    def hide(self, *declared: Declaration) -> None:
        """Take back the token, then what it stands for; nothing when the session is closed."""
        side, self._side = self._side, None
        if side is not None:
            side.close()
        shown, self._shown = self._shown, None
        if shown is None or self.wire.zenoh.is_closed():
            return
        for one in (shown, *declared):
            one.undeclare()
