"""EffortDisplay: how hard the joints of a robot push, as arrows round their axes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from studio.displays.colour_maps import RAINBOW, mapped
from studio.displays.display import Status, TopicRole, frame_and_stamp, reading_fields
from studio.displays.drawing import NO_TURN, Arrows, Lines, Placed, link_frame
from studio.displays.history import Entry, HistoryDisplay
from studio.displays.properties import Property, length, switch
from studio.displays.selection import Fact, Item, box_of, index_of, number_fact
from studio.displays.turning import FAR, drawable, shortest_turn, turned
from studio.errors import DisplayMessageError, RobotError
from studio.robot.urdf_text import robot_from_urdf
from studio.robot.values import JointType

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    from studio.displays.display import Reason, Received
    from studio.displays.drawing import Shape
    from studio.displays.properties import Value
    from studio.displays.selection import Picked
    from studio.displays.turning import Floats
    from studio.robot.values import Joint, Robot
    from studio.ros.types.classes import MessageValue
    from studio.ros.types.library import TypeLibrary

_DESCRIPTION: Final = "description"
_DESCRIPTION_LETTERS_MAX: Final = 4_000_000
_NO_DESCRIPTION: Final = (
    "No robot description has come, which has the axes of the joints: it is expected on the "
    "topic robot_description beside the joint states."
)
_OTHER_JOINTS: Final = "The robot description has none of the joints in the joint states."
RINGS_MAX: Final = 1000
"""Limit for one message: more would make the view slow."""
_JOINTS: Final = "Joints"
_ROUND: Final = (JointType.REVOLUTE, JointType.CONTINUOUS)
_UP: Final = np.array([0.0, 0.0, 1.0])
_LEAST: Final = 0.05
# As in RViz, 30 of 32 points of a circle, which begins at the head of its arrow.
_CIRCLE_RAD: Final = np.arange(30) * (2.0 * np.pi / 32)


class Efforts(NamedTuple):
    """Names of joints and the effort of each, N m; shape (N,)."""

    joints: tuple[str, ...]
    efforts: Floats


class Ring(NamedTuple):
    """The axis of a joint in the frame of its child link, and its effort."""

    joint: str
    frame: str
    axis: Floats
    effort: float
    share: float


class EffortDisplay(HistoryDisplay[Efforts]):
    """Draws the last efforts about the axes of the joints of a robot description."""

    KIND = "Effort"
    DOC = "How hard the joints of a robot push, as arrows round their axes."
    ICON = "joints"
    TOPICS = (
        TopicRole("", ("sensor_msgs/msg/JointState",), newest_only=False),
        TopicRole(
            _DESCRIPTION, ("std_msgs/msg/String",), beside="/robot_description", latched=True
        ),
    )
    PROPERTIES = (
        Property("Alpha", "number", 1.0, "How opaque the arrows are.", 0.0, 1.0),
        length("Width", 0.02, "How thick the arrows are."),
        Property("Scale", "number", 1.0, "How large the arrows are.", 0.0, 1000.0),
        Property("History Length", "whole", 1, "How many messages are shown.", 1, 100),
        Property("TF Prefix", "text", "", "What stands before the names of links on /tf."),
    )
    SETTINGS_MAX = 10_000
    KEEPS = "History Length"

    def __init__(self, types: TypeLibrary, values: Mapping[str, Value] | None = None) -> None:
        super().__init__(types, values)
        self._robot: Robot | None = None

    def properties(self) -> tuple[Property, ...]:
        """Return a switch, too, for each joint that can have a ring."""
        joints = () if self._robot is None else self._robot.joints.values()
        turning = (one.name for one in joints if one.type in _ROUND)
        return (*self.PROPERTIES, *(_switch_of(name) for name in turning))

    def take(self, received: Received, role: str = "") -> None:
        """Take in joint states, or the description of the robot.

        Raises:
            StudioError: It cannot be read.
        """
        if role == _DESCRIPTION:
            self._robot = self._described(received)
            self.changed("")
        else:
            super().take(received)

    def read(self, received: Received) -> Entry[Efforts] | None:
        """Return the efforts, if there is one for each joint."""
        message = self.decode(received)
        names, efforts = tuple(message.name), np.array(message.effort, dtype=np.float64)
        if len(names) != len(efforts):
            return self.refuse(*_why_none(len(names), len(efforts)))
        if len(efforts) and not drawable(efforts[:, None]).any():
            return self.refuse(
                "not_finite", f"None of the {len(names):,} efforts is finite and below 1e12."
            )
        return Entry(*frame_and_stamp(message.header), Efforts(names, efforts))

    def shapes(self, content: Efforts) -> dict[str, Shape]:
        """Return nothing in the frame of the message: each joint has a frame of its own."""
        del content
        return {}

    def groups(self, entry: Entry[Efforts]) -> dict[str, Placed]:
        """Return a ring for each joint that turns, in the frame of its child link."""
        rings = self._rings(entry.content)
        return {
            str(number): Placed(ring.frame, entry.stamp_ns, self._ring(ring))
            for number, ring in enumerate(rings)
        }

    def parts_picked(self, content: Efforts, picked: Picked) -> Sequence[str]:
        """Return the joint whose ring it is."""
        rings = self._rings(content)
        number = index_of(picked.path)
        return (rings[number].joint,) if 0 <= number < len(rings) else ()

    def part_item(self, entry: Entry[Efforts], path: str, part: str) -> Item | None:
        """Return one joint."""
        for number, ring in enumerate(self._rings(entry.content)):
            if ring.joint == part:
                box = box_of(self._ring(ring))
                return Item("joint", part, f"{path}/{number}", ring.frame, entry.stamp_ns, box)
        return None

    def part_facts(
        self, content: Efforts, part: str, message: MessageValue | None
    ) -> tuple[Fact, ...]:
        """Return its effort, and where it is and how fast if the message says so."""
        if part not in content.joints:
            return ()
        at = content.joints.index(part)
        joint = self._robot.joints.get(part) if self._robot is not None else None
        found = [Fact("name", part), number_fact("effort", float(content.efforts[at]), "N m")]
        if joint is not None and joint.limit is not None:
            found.append(number_fact("limit.effort", joint.limit.effort, "N m"))
        for name, unit in (("position", "rad"), ("velocity", "rad/s")):
            numbers = () if message is None else getattr(message, name)
            if at < len(numbers):
                found.append(number_fact(name, float(numbers[at]), unit))
        return tuple(found)

    def statuses(self) -> tuple[Status, ...]:
        """Return a status, too, if it is unknown where the joints are."""
        newest = self.newest
        if newest is None:
            return super().statuses()
        if self._robot is None:
            return (Status("warn", "empty", _NO_DESCRIPTION), *super().statuses())
        if not any(name in self._robot.joints for name in newest.content.joints):
            return (Status("warn", "empty", _OTHER_JOINTS), *super().statuses())
        return super().statuses()

    def _described(self, received: Received) -> Robot:
        with reading_fields(received.type_name):
            text = str(self.decode(received).data)
        if len(text) > _DESCRIPTION_LETTERS_MAX:
            reason = f"a robot description of {len(text):,} letters is too long"
            raise DisplayMessageError(received.type_name, reason)
        try:
            return robot_from_urdf(text)
        except RobotError as error:
            reason = f"it is no robot description: {str(error).rstrip('.')}"
            raise DisplayMessageError(received.type_name, reason) from error

    def _rings(self, content: Efforts) -> list[Ring]:
        joints = {} if self._robot is None else self._robot.joints
        efforts = dict(zip(content.joints, content.efforts.tolist(), strict=True))
        found = (
            (joints.get(name), effort) for name, effort in efforts.items() if abs(effort) <= FAR
        )
        made = [
            self._ring_of(joint, effort)
            for joint, effort in found
            if joint is not None and self.values.get(f"{_JOINTS}/{joint.name}", True)
        ]
        return [ring for ring in made if ring is not None][:RINGS_MAX]

    def _ring_of(self, joint: Joint, effort: float) -> Ring | None:
        axis = np.array(joint.axis, dtype=np.float64)
        size = float(np.linalg.norm(axis)) if drawable(axis[None]).all() else 0.0
        if joint.type not in _ROUND or size == 0:
            return None
        most = joint.limit.effort if joint.limit is not None else 0.0
        share = min(abs(effort) / most, 1.0) if 0 < most <= FAR else abs(effort)
        frame = link_frame(joint.child, str(self.values["TF Prefix"]))
        return Ring(joint.name, frame, axis / size, effort, share + _LEAST)

    def _ring(self, ring: Ring) -> dict[str, Shape]:
        """Return a part of a circle about an axis, from the head of its arrow on."""
        width_m, alpha = self.number("Width"), self.number("Alpha")
        radius_m = _LEAST + ring.share * self.number("Scale") / 2
        if radius_m > FAR:
            return {}
        sign = -1.0 if ring.effort > 0 else 1.0
        around = radius_m * np.stack(
            (-sign * np.sin(_CIRCLE_RAD), np.cos(_CIRCLE_RAD), np.zeros(_CIRCLE_RAD.size)), axis=1
        )
        head = np.array([[0.0, radius_m, 0.0], [sign * 2.0 * width_m, radius_m, 0.0]])
        points = _about(ring.axis, np.concatenate((around, head)))
        colour = mapped(np.array([1.0 - ring.share]), RAINBOW)[0]
        pieces = np.stack((points[:-3], points[1:-2]), axis=1)
        shapes: dict[str, Shape] = {"ring": Lines(pieces, colour, width_m, alpha)}
        if width_m:
            ends = points[None, -2:]
            shapes["head"] = Arrows(ends, colour, 0.0, 4.0 * width_m, 2.0 * width_m, alpha)
        return shapes

    def _property(self, name: str) -> Property:
        if name.startswith(f"{_JOINTS}/"):
            return _switch_of(name.removeprefix(f"{_JOINTS}/"))
        return super()._property(name)


def _switch_of(joint: str) -> Property:
    return switch(f"{_JOINTS}/{joint}", "Whether the effort of this joint is shown.", on=True)


def _about(axis: Floats, around_z: Floats) -> NDArray[np.float32]:
    """Return points (N, 3) about z as they are about another axis, float32."""
    turn = shortest_turn(_UP, axis) if axis @ _UP < 1.0 else np.array(NO_TURN)
    return turned(np.tile(turn, (len(around_z), 1)), around_z).astype(np.float32)


def _why_none(names: int, efforts: int) -> tuple[Reason, str]:
    if not efforts:
        return "empty", "The joint states carry no efforts: their publisher sends positions only."
    sentence = (
        f"The joint states carry {names:,} names and {efforts:,} efforts: as many are needed."
    )
    return "bad_message", sentence
