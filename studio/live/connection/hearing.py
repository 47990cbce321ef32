"""JointsIn and DescriptionIn: what the wire tells of a robot, kept until the loop takes it."""

from __future__ import annotations

import threading
import time
from typing import TYPE_CHECKING, Final, NamedTuple

from studio.live.connection.following import Following
from studio.nodes.joint_reading import JointReading
from studio.nodes.link_transforms import LinkTransform
from studio.nodes.robot_state_publisher import LATCHED
from studio.ros.duration import NANOSECONDS
from studio.ros.qos import QoSProfile, ReliabilityPolicy

if TYPE_CHECKING:
    from studio.live.connection.link import WireLink
    from studio.robot.kinematics import Kinematics
    from studio.robot.values import Robot
    from studio.ros.types.classes import MessageValue

STRING: Final = "std_msgs/msg/String"
_EVERY: Final = QoSProfile(depth=100)
_EVENTS: Final = QoSProfile(depth=1000)
_SENSORS: Final = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)


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

    @property
    def stamp_ns(self) -> int:
        """When what was collected last was measured, as a joint state tells it; 0: nobody did."""
        return self._following.stamp_ns

    def _take(self, state: MessageValue) -> None:
        if len(state.name) == len(state.position):
            stamp = state.header.stamp
            positions = dict(zip(state.name, state.position.tolist(), strict=True))
            self._following.take(positions, stamp.sec * NANOSECONDS + stamp.nanosec)

    def _take_tf(self, message: MessageValue) -> None:
        transforms = map(_link_transform, message.transforms)
        if positions := self._reading.positions(transforms):
            self._following.take(positions)


class Place(NamedTuple):
    """Where a parameter is."""

    node: str
    name: str


class DescriptionIn:
    """Hears the description of a robot; the newest is kept until it is taken.

    Args:
        link: By which it is heard.
        topic: That tells it, or that tells of changed parameters.
        parameter: That has it.
        first: What the parameter is now.
    """

    def __init__(
        self, link: WireLink, topic: str, parameter: Place | None = None, first: str = ""
    ) -> None:
        self.source = f"{parameter.node} {parameter.name}" if parameter else topic
        self._parameter = parameter
        self._came = threading.Condition()
        self._newest: str | None = first or None
        self.close = (
            link.subscribe("rcl_interfaces/msg/ParameterEvent", topic, self._take_event, _EVENTS)
            if parameter
            else link.subscribe(STRING, topic, self._take, LATCHED)
        )

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
        self._keep(message.data)

    def _take_event(self, event: MessageValue) -> None:
        if self._parameter is None or event.node != self._parameter.node:
            return
        for one in (*event.new_parameters, *event.changed_parameters):
            if one.name == self._parameter.name:
                self._keep(one.value.string_value)

    def _keep(self, text: str) -> None:
        with self._came:
            self._newest = text
            self._came.notify_all()


def _link_transform(stamped: MessageValue) -> LinkTransform:
    at, turn = stamped.transform.translation, stamped.transform.rotation
    return LinkTransform(
        stamped.header.frame_id,
        stamped.child_frame_id,
        (at.x, at.y, at.z),
        (turn.w, turn.x, turn.y, turn.z),
    )
