"""AccelStamped, TwistStamped and Wrench: a linear and an angular vector as arrows."""

from __future__ import annotations

import math
from abc import abstractmethod
from typing import TYPE_CHECKING, Any, ClassVar, Final, NamedTuple

import numpy as np

from studio.displays.display import Status, TopicRole, frame_and_stamp
from studio.displays.drawing import Arrows, Lines
from studio.displays.history import KEPT_MAX, Entry, HistoryDisplay
from studio.displays.poses import NOT_FINITE
from studio.displays.properties import Property, colour_of, length, rgb_of, switch
from studio.displays.turning import drawable, shortest_turn, turned

if TYPE_CHECKING:
    from collections.abc import Mapping

    from studio.displays.display import Received
    from studio.displays.drawing import Shape
    from studio.displays.properties import Value
    from studio.displays.turning import Floats

_SCALE_MAX: Final = 1e6
# Of RViz's arrow of length 1: the head comes on top of it.
_HEAD = 0.3
_SHAFT_THICKNESS, _HEAD_THICKNESS = 0.1, 0.2
# The circle about a turn has 32 parts, of which the head of its arrow hides the first four.
_CIRCLE_RAD = np.arange(4, 33) * (2.0 * np.pi / 32)
_CIRCLE_THICKNESS = 0.05
_UP = np.array([0.0, 0.0, 1.0])
HIDE_SMALL: Final = "Hide Small Values"
_ACCEPT = "Accept NaN Values"


class Vectors(NamedTuple):
    """A linear and an angular vector, in the frame of a message; shapes (3,), float64."""

    straight: Floats
    turning: Floats


class Names(NamedTuple):
    """Names of the two vectors, as `Force` and `Torque`."""

    straight: str
    turning: str


def vector_properties(names: Names) -> tuple[Property, ...]:
    """Properties of the two vectors, with RViz's default values."""
    straight, turning = names
    return (
        Property(f"{straight} Color", "colour", "#cc3333", f"Colour of the {straight.lower()}."),
        Property(f"{turning} Color", "colour", "#cccc33", f"Colour of the {turning.lower()}."),
        Property("Alpha", "number", 1.0, "How opaque the arrows are.", 0.0, 1.0),
        _scale(straight),
        _scale(turning),
        length("Arrow Width", 0.5, "How thick arrows are; what is shorter is not shown."),
        Property("History Length", "whole", 1, "How many messages are shown.", 1, KEPT_MAX),
    )


def scale_of(name: str) -> str:
    """Return the name of the property that gives the length of an arrow."""
    return f"{name} Arrow Scale"


def _scale(name: str) -> Property:
    doc = f"How long the arrow of a {name.lower()} of 1 is."
    return Property(scale_of(name), "number", 2.0, doc, 0.0, _SCALE_MAX, "m")


def vectors_of(straight: Any, turning: Any) -> Vectors | None:  # noqa: ANN401 - messages
    """Return two geometry_msgs/Vector3; None when they cannot be drawn."""
    rows = np.array([[one.x, one.y, one.z] for one in (straight, turning)], dtype=np.float64)
    return Vectors(rows[0], rows[1]) if drawable(rows).all() else None


def lengths_m(vectors: Vectors, names: Names, values: Mapping[str, Value]) -> tuple[float, float]:
    """Return the lengths of the two arrows by the properties."""
    return (
        float(np.linalg.norm(vectors.straight)) * float(values[scale_of(names.straight)]),
        float(np.linalg.norm(vectors.turning)) * float(values[scale_of(names.turning)]),
    )


def too_short(
    vectors: Vectors, names: Names, values: Mapping[str, Value]
) -> tuple[str, tuple[str, Value]] | None:
    """Why nothing of them is seen, and the width of arrows with which it would be.

    None when something is seen, or when both are zero: then nothing is to be seen.
    """
    longest_m = max(lengths_m(vectors, names, values))
    width_m = float(values["Arrow Width"])
    if longest_m > width_m or longest_m == 0:
        return None
    sentence = (
        f"The arrows are {longest_m:.3g} m long, and only those longer than Arrow Width "
        f"({width_m:g} m) are drawn: make it smaller."
    )
    return sentence, ("Arrow Width", float(f"{longest_m / 4:.2g}"))


def vector_shapes(
    vectors: Vectors, names: Names, values: Mapping[str, Value], *, small_too: bool = False
) -> dict[str, Shape]:
    """Draw the arrows that are longer than they are wide; `small_too` draws the others as well."""
    straight_m, turning_m = lengths_m(vectors, names, values)
    width_m = float(values["Arrow Width"])
    alpha = float(values["Alpha"])
    shapes: dict[str, Shape] = {}
    if straight_m > (0.0 if small_too else width_m):
        colour = colour_of(rgb_of(values[f"{names.straight} Color"]))
        shapes["straight"] = _arrow(_unit(vectors.straight), straight_m, width_m, colour, alpha)
    if turning_m > (0.0 if small_too else width_m):
        colour = colour_of(rgb_of(values[f"{names.turning} Color"]))
        direction = _unit(vectors.turning)
        shapes["turning"] = _arrow(direction, turning_m, width_m, colour, alpha)
        shapes |= _circle(direction, turning_m, width_m, colour, alpha)
    return shapes


def _unit(vector: Floats) -> Floats:
    scaled = vector / np.abs(vector).max()
    return scaled / np.linalg.norm(scaled)


def _arrow(direction: Floats, long_m: float, width_m: float, colour: Any, alpha: float) -> Arrows:  # noqa: ANN401
    tip = direction * (long_m * (1.0 + _HEAD))
    ends = np.array([[np.zeros(3), tip]], dtype=np.float32)
    thickness, head = width_m * _SHAFT_THICKNESS, width_m * _HEAD_THICKNESS
    return Arrows(ends, colour, thickness, head, long_m * _HEAD, alpha)


def _circle(
    direction: Floats,
    long_m: float,
    width_m: float,
    colour: Any,  # noqa: ANN401
    alpha: float,
) -> dict[str, Shape]:
    """Return the sense of rotation about an arrow: a part of a circle with a head."""
    radius_m, height_m = long_m / 4, long_m / 2
    turn = shortest_turn(_UP, direction)[None]
    around = np.stack(
        (
            radius_m * np.cos(_CIRCLE_RAD),
            radius_m * np.sin(_CIRCLE_RAD),
            np.full(_CIRCLE_RAD.size, height_m),
        ),
        axis=1,
    )
    points = turned(np.tile(turn, (len(around), 1)), around).astype(np.float32)
    pieces = np.stack((points[:-1], points[1:]), axis=1)
    head_m = width_m * _SHAFT_THICKNESS
    start = turned(turn, np.array([radius_m, 0.0, height_m]))[0]
    head = np.array([[start, start + head_m * turned(turn, np.array([0.0, 1.0, 0.0]))[0]]])
    thick = width_m * _CIRCLE_THICKNESS
    shapes: dict[str, Shape] = {"around": Lines(pieces, colour, thick, alpha)}
    if head_m > 0:
        ends = head.astype(np.float32)
        shapes["around head"] = Arrows(ends, colour, 0.0, width_m * _HEAD_THICKNESS, head_m, alpha)
    return shapes


SCREW: Final = Names("Linear", "Angular")
SCREW_PROPERTIES: Final = (
    *vector_properties(SCREW),
    switch(HIDE_SMALL, "Whether arrows that are shorter than wide are hidden.", on=True),
)


class VectorDisplay(HistoryDisplay[Vectors]):
    """Draws the last pairs of a push and a turn."""

    NAMES: ClassVar[Names]
    KEEPS = "History Length"

    @abstractmethod
    def parts(self, message: Any) -> tuple[Any, Any]:  # noqa: ANN401 - messages
        """Return the two geometry_msgs/Vector3 of a message."""

    def read(self, received: Received) -> Entry[Vectors] | None:
        """Return the vectors, unless their numbers cannot be drawn."""
        message = self.decode(received)
        vectors = vectors_of(*self.parts(message))
        if vectors is None:
            return self.refuse("not_finite", NOT_FINITE)
        return Entry(*frame_and_stamp(message.header), vectors)

    def shapes(self, content: Vectors) -> dict[str, Shape]:
        """Return an arrow each, and a circle about the one that turns."""
        return vector_shapes(content, self.NAMES, self.values, small_too=self._small_too)

    def sizes(self) -> tuple[str, ...]:
        """Return the scales of the newest vectors that are not zero."""
        if self.newest is None:
            return ()
        pairs = zip(self.NAMES, self.newest.content, strict=True)
        return tuple(scale_of(name) for name, vector in pairs if vector.any())

    def statuses(self) -> tuple[Status, ...]:
        """Also that the newest arrows are too short to be seen."""
        newest = self.newest
        if newest is None or self._small_too:
            return super().statuses()
        short = too_short(newest.content, self.NAMES, self.values)
        remarks = () if short is None else (Status("warn", "empty", *short),)
        return (*remarks, *super().statuses())

    @property
    def _small_too(self) -> bool:
        return self.values.get(HIDE_SMALL, True) is False


class AccelDisplay(VectorDisplay):
    """Draws the last accelerations."""

    KIND = "AccelStamped"
    DOC = "An acceleration along and about an axis."
    ICON = "arrow"
    TOPICS = (TopicRole("", ("geometry_msgs/msg/AccelStamped",), newest_only=False),)
    PROPERTIES = SCREW_PROPERTIES
    NAMES = SCREW

    def parts(self, message: Any) -> tuple[Any, Any]:  # noqa: ANN401 - messages
        """Return both accelerations."""
        return message.accel.linear, message.accel.angular


class TwistDisplay(VectorDisplay):
    """Draws the last twists."""

    KIND = "TwistStamped"
    DOC = "A linear and an angular velocity, as sent to drive a robot."
    ICON = "arrow"
    TOPICS = (TopicRole("", ("geometry_msgs/msg/TwistStamped",), newest_only=False),)
    PROPERTIES = SCREW_PROPERTIES
    NAMES = SCREW

    def parts(self, message: Any) -> tuple[Any, Any]:  # noqa: ANN401 - messages
        """Return the velocity and the turning rate."""
        return message.twist.linear, message.twist.angular


_NAMES = Names("Force", "Torque")


class WrenchDisplay(VectorDisplay):
    """Draws the last wrenches."""

    KIND = "Wrench"
    DOC = "A force and a torque, as a sensor at a wrist feels them."
    ICON = "arrow"
    TOPICS = (TopicRole("", ("geometry_msgs/msg/WrenchStamped",), newest_only=False),)
    PROPERTIES = (
        *vector_properties(_NAMES),
        switch(_ACCEPT, "Whether numbers that are none count as 0.", on=False),
    )
    NAMES = _NAMES

    def parts(self, message: Any) -> tuple[Any, Any]:  # noqa: ANN401 - messages
        """Return the force and the torque."""
        wrench = message.wrench
        if self.values[_ACCEPT]:
            _put_zeros(wrench.force)
            _put_zeros(wrench.torque)
        return wrench.force, wrench.torque


def _put_zeros(vector: Any) -> None:  # noqa: ANN401 - a message
    """Put 0 where a number is none; what is infinite stays, as in RViz."""
    for name in "xyz":
        if math.isnan(getattr(vector, name)):
            setattr(vector, name, 0.0)
