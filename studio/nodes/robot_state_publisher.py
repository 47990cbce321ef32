"""RobotStatePublisher: publishes a robot's description and its transforms, as upstream does.

Try: `studio run robot_state_publisher robot_state_publisher robot.urdf`, then
`studio topic echo --once /tf_static`.
"""

from __future__ import annotations

import sys
import threading
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

import studio.ros.client as rclpy
from studio.errors import ExternalShutdownException, SettingsError, StudioError, UnreadableFileError
from studio.nodes.link_transforms import LinkTransforms
from studio.robot.urdf_text import robot_from_urdf
from studio.ros.client import Node
from studio.ros.columns.transforms import TransformCodec
from studio.ros.duration import NANOSECONDS
from studio.ros.messages import message
from studio.ros.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from studio.tf.transforms import TransformColumns

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from studio.nodes.link_transforms import LinkTransform
    from studio.robot.kinematics import Kinematics
    from studio.robot.values import Robot
    from studio.ros.parameters.parameter import Parameter
    from studio.ros.types.classes import MessageValue


_NANOSECONDS = 1_000_000_000


class StatePace:
    """Lets each joint through at most at a frequency, by the stamps of the messages.

    A message passes whole when its least recently published joint is due, as upstream does it.

    Args:
        frequency_hz: Above 0.
        ignore_stamps: Let everything through.
    """

    def __init__(self, frequency_hz: float, *, ignore_stamps: bool = False) -> None:
        self.frequency_hz, self.ignore_stamps = frequency_hz, ignore_stamps
        self._published_ns: dict[str, int] = {}
        self._last_now_ns = 0

    def is_due(self, joints: Iterable[str], stamp_ns: int, now_ns: int) -> bool:
        """Return whether a message is to be published; it counts as published then.

        A clock that went back, as a simulation's does when it begins again, forgets all before.
        """
        if now_ns < self._last_now_ns:
            self._published_ns.clear()
        self._last_now_ns = now_ns
        names = tuple(joints)
        oldest_ns = min((self._published_ns.get(name, 0) for name in names), default=0)
        interval_ns = int(_NANOSECONDS / self.frequency_hz)
        if not self.ignore_stamps and stamp_ns < oldest_ns + interval_ns and oldest_ns:
            return False
        self._published_ns |= dict.fromkeys(names, stamp_ns)
        return True


LATCHED: Final = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
_DYNAMIC: Final = QoSProfile(depth=100)
_SENSORS: Final = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)
FREQUENCY_HZ: Final = 20.0
_DESCRIPTION: Final = "robot_description"
_FREQUENCY: Final = "publish_frequency"
_IGNORE: Final = "ignore_timestamp"
_PREFIX: Final = "frame_prefix"
_NAMES: Final = (_DESCRIPTION, _FREQUENCY, _IGNORE, _PREFIX)


class RobotStatePublisher:
    """Publishes `robot_description`, `/tf_static` and `/tf` by a node; thread-safe.

    Positions come by `place`, or after `listen` from `joint_states`.
    """

    def __init__(self, node: Node, frame_prefix: str = "") -> None:
        self._node, self._prefix = node, frame_prefix
        types = node.wire.types
        self._text = types.message("std_msgs/msg/String")
        kind = types.message("tf2_msgs/msg/TFMessage")
        self._description_out = node.create_publisher(self._text, "robot_description", LATCHED)
        self._static_out = node.create_publisher(kind, "/tf_static", LATCHED)
        self._dynamic_out = node.create_publisher(kind, "/tf", _DYNAMIC)
        self._codec, self._turn = TransformCodec(), threading.Lock()
        self._transforms: LinkTransforms | None = None
        self._pace = StatePace(FREQUENCY_HZ)

    def describe(
        self, urdf: str, robot: Robot | None = None, kinematics: Kinematics | None = None
    ) -> None:
        """Publish this robot from now on; the parsed text may be given, too.

        Raises:
            RobotError: The text is no robot that ROS would take; then nothing changed.
        """
        shown = robot or robot_from_urdf(urdf)
        self._transforms = LinkTransforms(shown, self._prefix, kinematics)
        self._description_out.publish(self._text(data=urdf))
        self._static_out.publish(self._written(self._transforms.fixed(), self._now_ns()))

    def place(self, positions: Mapping[str, float], stamp_ns: int | None = None) -> None:
        """Publish the poses of links, by joint positions in rad or m; stamp None: now."""
        if self._transforms is None:
            return
        moved = self._transforms.moved(positions)
        if moved:
            at_ns = self._now_ns() if stamp_ns is None else stamp_ns
            self._dynamic_out.publish(self._written(moved, at_ns))

    def set_prefix(self, frame_prefix: str) -> None:
        """Put this before the names of frames from the next description on."""
        self._prefix = frame_prefix

    def set_pace(self, frequency_hz: float, *, ignore_stamps: bool) -> None:
        """Take at most that many positions in a second."""
        self._pace = StatePace(frequency_hz, ignore_stamps=ignore_stamps)

    def listen(self) -> None:
        """Take positions from `joint_states`."""
        states = self._node.wire.types.message("sensor_msgs/msg/JointState")
        self._node.create_subscription(states, "joint_states", self._take, _SENSORS)

    def _take(self, state: MessageValue) -> None:
        names: list[str] = state.name
        if len(names) != len(state.position):
            if len(state.position):
                self._node.get_logger().warning(
                    f"A joint state names {len(names)} joints and has {len(state.position)} "
                    "positions: it was left out.",
                    throttle_duration_sec=1.0,
                )
            return
        stamp = state.header.stamp
        stamp_ns = stamp.sec * NANOSECONDS + stamp.nanosec
        if self._pace.is_due(names, stamp_ns, self._now_ns()):
            self.place(dict(zip(names, state.position.tolist(), strict=True)), stamp_ns)

    def _now_ns(self) -> int:
        return self._node.get_clock().now().nanoseconds

    def _written(self, transforms: Sequence[LinkTransform], stamp_ns: int) -> bytearray:
        """Return one message, written without an object for each transform."""
        count = len(transforms)
        columns = TransformColumns(
            tuple(one.parent for one in transforms),
            tuple(one.child for one in transforms),
            np.full(count, stamp_ns, np.int64),
            np.array([one.xyz_m for one in transforms], np.float64).reshape(count, 3),
            np.array([one.wxyz for one in transforms], np.float64).reshape(count, 4),
        )
        with self._turn:
            return self._codec.encode(columns)


class RobotStateNode(Node):
    """The node that upstream's program is: its parameters, and positions from `joint_states`."""

    def __init__(self, urdf: str = "") -> None:
        super().__init__("robot_state_publisher")
        self._publisher = RobotStatePublisher(self)
        self.declare_parameter(_DESCRIPTION, urdf)
        self.declare_parameter(_FREQUENCY, FREQUENCY_HZ)
        self.declare_parameter(_IGNORE, False)  # noqa: FBT003  # as in rclpy
        self.declare_parameter(_PREFIX, "")
        self._take({name: self.get_parameter(name).value for name in _NAMES})
        self.add_on_set_parameters_callback(self._on_set)
        self._publisher.listen()

    def _on_set(self, parameters: list[Parameter]) -> MessageValue:
        """Take other parameters at run time, all or none."""
        result = message("rcl_interfaces/msg/SetParametersResult")
        wanted = {name: self.get_parameter(name).value for name in _NAMES}
        changed = {one.name: one.value for one in parameters if one.name in _NAMES}
        try:
            if changed:
                self._take(wanted | changed)
        except StudioError as error:
            return result(successful=False, reason=str(error))
        return result(successful=True)

    def _take(self, values: dict[str, Any]) -> None:
        """Act on all parameters.

        Raises:
            RobotError: The description is none.
            SettingsError: The frequency is none, or there is no description.
        """
        if not values[_FREQUENCY] > 0:
            raise SettingsError(f"{_FREQUENCY} is {values[_FREQUENCY]}: it must be above 0.")
        if not values[_DESCRIPTION].strip():
            raise SettingsError(
                f"{_DESCRIPTION} is empty: name a URDF file, or give the text by "
                f"--ros-args -p {_DESCRIPTION}:=..."
            )
        robot = robot_from_urdf(values[_DESCRIPTION])
        self._publisher.set_pace(values[_FREQUENCY], ignore_stamps=values[_IGNORE])
        self._publisher.set_prefix(values[_PREFIX])
        self._publisher.describe(values[_DESCRIPTION], robot)


def _read_urdf(arguments: Sequence[str]) -> str:
    """Return the text of the file that the first argument names; empty: none does.

    Raises:
        UnreadableFileError: It cannot be read.
    """
    named = arguments[0] if arguments and not arguments[0].startswith("-") else ""
    try:
        return Path(named).read_text(encoding="utf-8") if named else ""
    except (OSError, ValueError) as error:
        raise UnreadableFileError(named, f"cannot be read ({error}).") from error


def run_with_urdf(node: Callable[[str], Node], args: Sequence[str] | None) -> None:
    """Run a node, made of the URDF that the first argument names, until a signal ends it."""
    given = sys.argv[1:] if args is None else list(args)
    urdf = _read_urdf(given)
    with rclpy.init(args=given), suppress(KeyboardInterrupt, ExternalShutdownException):
        rclpy.spin(node(urdf))


def main(args: Sequence[str] | None = None) -> None:
    """Run until a signal ends the process."""
    run_with_urdf(RobotStateNode, args)


if __name__ == "__main__":
    main()
