"""WireLink: an open connection, its nodes, and the thread that does their work.

It imports Zenoh (through `ros`), so it is imported when the first connection is made.
"""

from __future__ import annotations

import logging
import threading
from functools import partial
from typing import TYPE_CHECKING, Final

from studio.errors import CommandError, ExternalShutdownException, NotServedError
from studio.live.connection.plan import planned_wire
from studio.live.connection.robot_publishers import JointsOut, RobotOut
from studio.ros.messages import types_of
from studio.ros.node.context import Context
from studio.ros.node.executors import SingleThreadedExecutor
from studio.ros.node.node import Node
from studio.ros.node.raw_subscription import RawSubscription
from studio.ros.node.topic_statistics import TopicStatistics
from studio.ros.wire.session import RouterWatch, open_wire

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.live.topics.request import Fit
    from studio.live.topics.subscription import Stream
    from studio.ros.graph.endpoints import GraphNode
    from studio.ros.graph.graph import Graph
    from studio.ros.types.library import TypeLibrary
    from studio.ros.wire.settings import WireSettings
    from studio.settings import WireChoice

_log = logging.getLogger(__name__)
_ANSWER_S: Final = 3.0
_DESCRIPTION: Final = "/robot_description"
_JOINT_STATES: Final = "/joint_states"
_STRING: Final = "std_msgs/msg/String"


class WireLink:
    """An open connection; made and closed in a thread, for both wait.

    `changed` is called from other threads whenever the connection or the graph changed. `settings`
    are those of ROS's environment and of the choice, unless they are given.

    Raises:
        WireError: The router cannot be reached; the sentence says why.
    """

    def __init__(
        self,
        choice: WireChoice,
        changed: Callable[[], None],
        settings: WireSettings | None = None,
    ) -> None:
        settings = settings or planned_wire(choice)
        self._wire = open_wire(settings, choice.router, types_of(settings.profile.distro))
        self._context = Context.over(self._wire, owns_wire=True)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._graph = self._context.graph
        self._graph.on_change(changed)
        self._node = self._new_node("studio")
        self._taken: set[str] = set()
        # Zenoh joins a router that comes back by itself.
        self._watch = RouterWatch(self._wire, lambda _is_there: changed())
        self._ended = threading.Event()
        self._spinning = threading.Thread(target=self._spin, name="wire-spin", daemon=True)
        self._spinning.start()

    @property
    def is_connected(self) -> bool:
        """Whether the router is there."""
        return self._watch.is_connected

    @property
    def has_own_router(self) -> bool:
        """Whether the router is one that this process started."""
        return self._wire.router is not None

    @property
    def settings(self) -> WireSettings:
        """The settings of the connection, for other nodes that are to use the same router."""
        return self._wire.settings

    @property
    def endpoint(self) -> str:
        """The address of the router."""
        return ", ".join(self._wire.settings.connect)

    @property
    def domain(self) -> int:
        """The ROS domain."""
        return self._wire.domain

    @property
    def distro(self) -> str:
        """The ROS distribution whose types and hashes are used."""
        return self._wire.profile.distro

    @property
    def zid(self) -> str:
        """The Zenoh id of the session, by which the studio's own nodes are recognised."""
        return self._wire.zid

    @property
    def node(self) -> Node:
        """The studio's own node, by which panels act."""
        return self._node

    @property
    def context(self) -> Context:
        """What the studio's nodes share: the session, and the thread that takes in what comes."""
        return self._context

    @property
    def types(self) -> TypeLibrary:
        """All types known on this connection."""
        return self._wire.types

    @property
    def graph(self) -> Graph:
        """The graph of nodes and endpoints."""
        return self._graph

    def other_nodes(self) -> list[GraphNode]:
        """The nodes of others."""
        return [one for one in self._graph.nodes() if one.zid != self._wire.zid]

    def node_names(self) -> list[str]:
        """Full names of the nodes of others."""
        return [one.path for one in self.other_nodes()]

    def publishers(self, topic: str) -> list[str]:
        """Full names of the nodes of others that publish a topic."""
        found = self._graph.publishers(topic)
        return [one.node.path for one in found if one.node.zid != self._wire.zid]

    def find_robots(self) -> tuple[tuple[str, ...], tuple[str, ...]]:
        """Return topics and nodes that may have a robot description, the nodes as a parameter."""
        self._graph.settle()
        topics = [
            name
            for name, types in self._graph.topics()
            if _STRING in types and name.endswith("robot_description")
            if self.publishers(name)
        ]
        nodes = [name for name in self.node_names() if "robot_state_publisher" in name]
        return tuple(sorted(topics, key=len)), tuple(nodes)

    def robot_out(self) -> RobotOut:
        """Start to publish a robot.

        Raises:
            CommandError: Another document publishes one.
        """
        self._take("robot_state_publisher", "its robot")
        return RobotOut(
            self._new_node("robot_state_publisher"),
            partial(self.publishers, _DESCRIPTION),
            self.let_go,
        )

    def joints_out(self) -> JointsOut:
        """Start to publish joint states; errors as for `robot_out`."""
        self._take("joint_state_publisher", "its joints")
        return JointsOut(
            self._new_node("joint_state_publisher"),
            partial(self.publishers, _JOINT_STATES),
            self.let_go,
        )

    def parameter(self, node: str, name: str) -> str:
        """Return the value of a parameter that is a text, empty where it is none; it waits.

        Raises:
            NotServedError: There is no such node, or it has no parameters.
            NoAnswerError: It does not answer.
        """
        kind = self._wire.types.service("rcl_interfaces/srv/GetParameters")
        client = self._node.create_client(kind, f"{node}/get_parameters", timeout_s=_ANSWER_S)
        try:
            if not client.wait_for_service(_ANSWER_S):
                raise NotServedError("service", client.srv_name)
            answer = client.call(kind.Request(names=[name]), timeout_sec=_ANSWER_S)
        finally:
            self._node.destroy_client(client)
        return answer.values[0].string_value if answer.values else ""

    def shown_hash(self, type_name: str) -> str:
        """Return the hash of our definition of a type, as in tokens.

        Raises:
            UnknownTypeError: It is not known.
        """
        return self._wire.profile.type_hash(self._wire.types.hash_of(type_name))

    def receive(self, topic: str, fit: Fit, stream: Stream) -> RawSubscription:
        """Begin to receive a topic for a stream.

        Raises:
            RosNameError: No topic is named so.
            UnknownTypeError: The type is not known here, and its hash neither.
        """
        named = fit.type_name, fit.type_hash
        return RawSubscription(self._node, topic, *named, fit.qos, stream.take)

    def measure(self, topic: str, kept_s: float) -> TopicStatistics:
        """Count what comes on a topic of any type, until nobody asked for `kept_s`.

        The graph does not list it as a subscription.

        Raises:
            RosNameError: The name of the topic is not valid.
        """
        return TopicStatistics(self._context, topic, kept_s)

    def let_go(self, node: Node) -> None:
        """End a node of a document."""
        self._executor.remove_node(node)
        node.destroy_node()
        self._taken.discard(node.get_name())  # last: else two may be there under one name

    def close(self) -> None:
        """End all nodes, the session, and the router if it is ours."""
        self._ended.set()
        self._watch.close()
        self._context.shutdown()
        self._executor.shutdown()
        self._spinning.join()

    def _new_node(self, name: str) -> Node:
        node = Node(name, context=self._context)
        self._executor.add_node(node)
        return node

    def _take(self, name: str, what: str) -> None:
        if name in self._taken:
            raise CommandError(
                f"Another open robot publishes {what} already: turn that off there first."
            )
        self._taken.add(name)

    def _spin(self) -> None:
        while not self._ended.is_set():
            try:
                self._executor.spin_once()
            except ExternalShutdownException:
                return
            except Exception:  # noqa: BLE001 - one message that cannot be used must not end the rest
                _log.exception("What came from the wire could not be used.")
