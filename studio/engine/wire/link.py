"""WireLink: the connection itself, its nodes, and the thread that carries out their work.

The only file of the engine that imports Zenoh, by way of ros: the desk imports it when it is used.
"""

from __future__ import annotations

import threading
import time
from typing import TYPE_CHECKING, Final

from studio.engine.wire.following import Following
from studio.engine.wire.plan import planned_wire
from studio.errors import CommandError, ExternalShutdownException
from studio.nodes.joint_reading import JointReading
from studio.nodes.joint_state_publisher import JointStatePublisher
from studio.nodes.link_transforms import LinkTransform
from studio.nodes.robot_state_publisher import LATCHED, RobotStatePublisher
from studio.ros.graph.graph import Graph
from studio.ros.messages.shared import types_of
from studio.ros.node.context import Context
from studio.ros.node.executor import SingleThreadedExecutor
from studio.ros.node.node import Node
from studio.ros.parameters.parameter import Parameter
from studio.ros.qos import QoSProfile, ReliabilityPolicy
from studio.ros.wire.opening import open_wire

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.engine.messages.wire import OpenFromWire
    from studio.robot.kinematics import Kinematics
    from studio.robot.values import Robot
    from studio.ros.types.classes import MessageValue
    from studio.settings import WireChoice

_DESCRIPTION: Final = "robot_description"
_STRING: Final = "std_msgs/msg/String"
_WATCH_EVERY_S: Final = 0.25
_EVERY: Final = QoSProfile(depth=100)
_SENSORS: Final = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)


class WireLink:
    """An open connection; made and closed in a thread, for both wait.

    `changed` is called from other threads whenever the connection or who is there changed.

    Raises:
        WireError: There is no way to a router; the sentence says why.
    """

    def __init__(self, choice: WireChoice, changed: Callable[[], None]) -> None:
        settings = planned_wire(choice)
        self._wire = open_wire(settings, choice.router, types_of(settings.profile.distro))
        self._context = Context.over(self._wire, owns_wire=True)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._changed = changed
        self._graph = Graph(self._wire)
        self._graph.on_change(changed)
        self._node = self._new_node("studio")
        self._taken: set[str] = set()
        self.is_connected = True
        self._ended = threading.Event()
        self._threads = [
            threading.Thread(target=target, name=name, daemon=True)
            for target, name in ((self._spin, "wire-spin"), (self._watch, "wire-watch"))
        ]
        for thread in self._threads:
            thread.start()

    @property
    def has_own_router(self) -> bool:
        """Whether the router is one that this process started."""
        return self._wire.router is not None

    @property
    def endpoint(self) -> str:
        """Where the router is."""
        return ", ".join(self._wire.settings.connect)

    @property
    def domain(self) -> int:
        """The ROS domain."""
        return self._wire.domain

    @property
    def distro(self) -> str:
        """Whose wire is spoken."""
        return self._wire.profile.distro

    def node_names(self) -> list[str]:
        """Full names of the nodes of others."""
        return [one.path for one in self._graph.nodes() if one.zid != self._wire.zid]

    def find_robots(self) -> tuple[tuple[str, ...], tuple[str, ...]]:
        """Topics that tell a robot description, and nodes that may have one as a parameter."""
        self._graph.settle()
        topics = [
            name
            for name, types in self._graph.topics()
            if _STRING in types and name.endswith("robot_description")
            if any(one.node.zid != self._wire.zid for one in self._graph.publishers(name))
        ]
        nodes = [name for name in self.node_names() if "robot_state_publisher" in name]
        return tuple(sorted(topics, key=len)), tuple(nodes)

    def robot_out(self) -> RobotOut:
        """Begin to tell a robot.

        Raises:
            CommandError: Another document tells one.
        """
        self._take("robot_state_publisher", "its robot")
        return RobotOut(self, self._new_node("robot_state_publisher"))

    def joints_out(self) -> JointsOut:
        """Begin to tell where joints stand; errors as for `robot_out`."""
        self._take("joint_state_publisher", "its joints")
        return JointsOut(self, self._new_node("joint_state_publisher"))

    def hear_joint_states(self, robot: Robot, kinematics: Kinematics) -> JointsIn:
        """Hear where joints stand from `/joint_states`."""
        return JointsIn(self, robot, kinematics, from_tf=False)

    def hear_tf(self, robot: Robot, kinematics: Kinematics) -> JointsIn:
        """Hear where joints stand from `/tf`."""
        return JointsIn(self, robot, kinematics, from_tf=True)

    def hear_description(self, wanted: OpenFromWire) -> DescriptionIn:
        """Hear a robot's description; what is latched comes at once."""
        return DescriptionIn(self, wanted.topic)

    def subscribe(
        self, type_name: str, topic: str, take: Callable[[MessageValue], None], qos: QoSProfile
    ) -> Callable[[], None]:
        """Hear a topic, in the thread of the link; gives what ends that."""
        kind = self._wire.types.message(type_name)
        subscription = self._node.create_subscription(kind, topic, take, qos)

        def end() -> None:
            self._node.destroy_subscription(subscription)

        return end

    def let_go(self, node: Node) -> None:
        """End a node of a document."""
        self._executor.remove_node(node)
        self._taken.discard(node.get_name())
        node.destroy_node()

    def close(self) -> None:
        """End all nodes, the session, and the router if it is ours."""
        self._ended.set()
        self._graph.close()
        self._context.shutdown()
        self._executor.shutdown()
        for thread in self._threads:
            thread.join()

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

    def _watch(self) -> None:
        """Notice that the router went away or came back; Zenoh joins it again by itself."""
        while not self._ended.wait(_WATCH_EVERY_S):
            is_there = bool(list(self._wire.zenoh.info.routers_zid()))
            if is_there is not self.is_connected:
                self.is_connected = is_there
                self._changed()


class RobotOut:
    """Tells one robot; any thread."""

    def __init__(self, link: WireLink, node: Node) -> None:
        self._link, self._node = link, node
        self._publisher = RobotStatePublisher(node)
        self.place = self._publisher.place
        node.declare_parameter(_DESCRIPTION, "")

    def describe(self, urdf: str, robot: Robot, kinematics: Kinematics) -> None:
        """Tell this robot from now on, by topics and as a parameter."""
        self._node.set_parameters([Parameter(_DESCRIPTION, value=urdf)])
        self._publisher.describe(urdf, robot, kinematics)

    def close(self) -> None:
        """Tell it no more."""
        self._link.let_go(self._node)


class JointsOut:
    """Tells where joints stand; any thread."""

    def __init__(self, link: WireLink, node: Node) -> None:
        self._link, self._node = link, node
        self.tell = JointStatePublisher(node).tell

    def close(self) -> None:
        """Tell it no more."""
        self._link.let_go(self._node)


class JointsIn:
    """Hears where joints stand; the loop collects it."""

    def __init__(
        self, link: WireLink, robot: Robot, kinematics: Kinematics, *, from_tf: bool
    ) -> None:
        self._following = Following(time.monotonic, kinematics.movable)
        self._kinematics = kinematics
        self._reading = JointReading(robot, kinematics)
        self.collect, self.state = self._following.collect, self._following.state
        self.rate_hz, self.strangers = self._following.rate_hz, self._following.strangers
        self.close = (
            link.subscribe("tf2_msgs/msg/TFMessage", "/tf", self._take_tf, _EVERY)
            if from_tf
            else link.subscribe("sensor_msgs/msg/JointState", "/joint_states", self._take, _SENSORS)
        )

    def fit(self, robot: Robot, kinematics: Kinematics) -> None:
        """Go on with the robot as it is now."""
        if kinematics is not self._kinematics:
            if kinematics.movable != self._kinematics.movable:
                self._following.fit(kinematics.movable)
            self._kinematics = kinematics
            self._reading = JointReading(robot, kinematics)

    def _take(self, state: MessageValue) -> None:
        if len(state.name) == len(state.position):
            self._following.take(dict(zip(state.name, state.position.tolist(), strict=True)))

    def _take_tf(self, message: MessageValue) -> None:
        transforms = map(_link_transform, message.transforms)
        if positions := self._reading.positions(transforms):
            self._following.take(positions)


class DescriptionIn:
    """Hears the description of a robot; the newest is kept until it is taken."""

    def __init__(self, link: WireLink, topic: str) -> None:
        self.source = topic
        self._came = threading.Condition()
        self._newest: str | None = None
        self.close = link.subscribe(_STRING, topic, self._take, LATCHED)

    def first(self, timeout_s: float) -> str | None:
        """Wait for a text; None when none came."""
        with self._came:
            self._came.wait_for(lambda: self._newest is not None, timeout_s)
        return self.newest()

    def newest(self) -> str | None:
        """What came since the last time; None: nothing."""
        with self._came:
            taken, self._newest = self._newest, None
        return taken

    def _take(self, message: MessageValue) -> None:
        with self._came:
            self._newest = message.data
            self._came.notify_all()


def _link_transform(stamped: MessageValue) -> LinkTransform:
    at, turn = stamped.transform.translation, stamped.transform.rotation
    return LinkTransform(
        stamped.header.frame_id,
        stamped.child_frame_id,
        (at.x, at.y, at.z),
        (turn.w, turn.x, turn.y, turn.z),
    )
