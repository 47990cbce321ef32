"""ImuDisplay: attitude, turning rate and acceleration of an inertial measurement unit."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from studio.displays.display import Status, TopicRole, frame_and_stamp
from studio.displays.drawing import Arrows, Placed, Solids
from studio.displays.history import Entry, HistoryDisplay
from studio.displays.poses import NO_TURN_SET, NOT_FINITE, Poses, axes_shapes, has_no_turn
from studio.displays.properties import Property, colour_of, length, rgb_of, switch
from studio.displays.turning import drawable, turned, unit_quaternions

if TYPE_CHECKING:
    from collections.abc import Mapping

    from studio.displays.display import Received
    from studio.displays.drawing import Shape
    from studio.displays.turning import Floats

_BOX, _AXES = "Box properties", "Axes properties"
_ACCELERATION, _RATE = "Acceleration properties", "Angular velocity properties"
_IN_WORLD = "fixed_frame_orientation"
_HAS_BOX, _HAS_AXES = (f"{_BOX}/Enable box", (True,)), (f"{_AXES}/Enable axes", (True,))
_HAS_ACCELERATION = (f"{_ACCELERATION}/Enable acceleration", (True,))
_HAS_RATE = (f"{_RATE}/Enable angular velocity", (True,))
# Of the arrows, for a scale of 1: thickness of shaft and head, and length of the head.
_SHAFT_M, _HEAD_M, _HEAD_LENGTH_M = 0.5, 1.0, 1.0
_AXES_THICKNESS = 0.1
_PARTS = {
    _HAS_AXES[0]: (f"{_AXES}/Axes scale",),
    _HAS_BOX[0]: tuple(f"{_BOX}/{axis}_scale" for axis in "xyz"),
    _HAS_ACCELERATION[0]: (f"{_ACCELERATION}/Acc. vector scale",),
    _HAS_RATE[0]: (f"{_RATE}/Vector scale",),
}
"""What can be shown, by its switch, with the properties of its size."""
_NO_ATTITUDE = "This unit reports that it measures no orientation: it is drawn without a rotation."


class Motion(NamedTuple):
    """A unit's measurements: its attitude in the world, the rest in its own axes; shapes (3,)."""

    attitude: Poses
    rate: Floats
    acceleration: Floats


class ImuDisplay(HistoryDisplay[Motion]):
    """Draws the newest measurement."""

    KIND = "Imu"
    DOC = "Attitude, turning rate and acceleration of an inertial measurement unit."
    ICON = "compass"
    TOPICS = (TopicRole("", ("sensor_msgs/msg/Imu",)),)
    PROPERTIES = (
        switch(_IN_WORLD, "Whether the attitude is drawn in the axes of the fixed frame; else in "
               "those of the frame of the unit.", on=True),
        switch(_HAS_BOX[0], "Whether a box shows the attitude.", on=False),
        *(length(f"{_BOX}/{axis}_scale", 1.0, f"How long the box is along {axis}.", _HAS_BOX)
          for axis in "xyz"),
        Property(f"{_BOX}/Box color", "colour", "#ff0000", "Colour of the box.", when=_HAS_BOX),
        Property(f"{_BOX}/Box alpha", "number", 1.0, "How opaque the box is.", 0.0, 1.0,
                 when=_HAS_BOX),
        switch(_HAS_AXES[0], "Whether axes show the attitude.", on=True),
        length(f"{_AXES}/Axes scale", 1.0, "How long each axis is.", _HAS_AXES),
        switch(_HAS_ACCELERATION[0], "Whether the acceleration is shown.", on=False),
        switch(f"{_ACCELERATION}/Derotate acceleration",
               "Whether the acceleration is turned with the attitude.", on=True,
               when=_HAS_ACCELERATION),
        Property(f"{_ACCELERATION}/Acc. vector scale", "number", 1.0,
                 "How long the arrow of 1 m/s² is.", 0.0, 1e6, "m", when=_HAS_ACCELERATION),
        Property(f"{_ACCELERATION}/Acc. vector color", "colour", "#ff0000", "Colour of the arrow.",
                 when=_HAS_ACCELERATION),
        Property(f"{_ACCELERATION}/Acc. vector alpha", "number", 1.0, "How opaque the arrow is.",
                 0.0, 1.0, when=_HAS_ACCELERATION),
        switch(_HAS_RATE[0], "Whether the turning rate is shown.", on=False),
        Property(f"{_RATE}/Vector scale", "number", 1.0, "How long the arrow of 1 rad/s is.",
                 0.0, 1e6, "m", when=_HAS_RATE),
        Property(f"{_RATE}/Vector color", "colour", "#cccc33", "Colour of the arrow.",
                 when=_HAS_RATE),
        Property(f"{_RATE}/Vector alpha", "number", 1.0, "How opaque the arrow is.", 0.0, 1.0,
                 when=_HAS_RATE),
    )  # fmt: skip

    def read(self, received: Received) -> Entry[Motion] | None:
        """Return the measurement, unless its numbers cannot be drawn."""
        message = self.decode(received)
        turn = message.orientation
        wxyz = np.array([[turn.w, turn.x, turn.y, turn.z]], dtype=np.float64)
        rest = np.stack((_row(message.angular_velocity), _row(message.linear_acceleration)))
        if not np.isfinite(wxyz).all() or not drawable(rest).all():
            return self.refuse("not_finite", NOT_FINITE)
        if message.orientation_covariance[0] == -1:
            self.warn(None, _NO_ATTITUDE)
            wxyz = np.zeros((1, 4))
        elif has_no_turn(turn):
            self.warn(None, NO_TURN_SET)
        attitude = Poses(np.zeros((1, 3)), unit_quaternions(wxyz)[0])
        return Entry(*frame_and_stamp(message.header), Motion(attitude, rest[0], rest[1]))

    def shapes(self, content: Motion) -> dict[str, Shape]:
        """Return shapes of what is switched on."""
        shapes: dict[str, Shape] = {}
        if self.values[_HAS_AXES[0]]:
            size_m = self.number(f"{_AXES}/Axes scale")
            shapes |= axes_shapes(content.attitude, size_m, size_m * _AXES_THICKNESS)
        if self.values[_HAS_BOX[0]] and any(map(self.number, _PARTS[_HAS_BOX[0]])):
            shapes["box"] = self._box(content)
        if self.values[_HAS_ACCELERATION[0]]:
            derotated = bool(self.values[f"{_ACCELERATION}/Derotate acceleration"])
            vector = _in_world(content, content.acceleration) if derotated else content.acceleration
            shapes |= self._arrow("acceleration", vector, f"{_ACCELERATION}/Acc. vector")
        if self.values[_HAS_RATE[0]]:
            rate = _in_world(content, content.rate)
            shapes |= self._arrow("angular velocity", rate, f"{_RATE}/Vector")
        return shapes

    def sizes(self) -> tuple[str, ...]:
        """Return the properties of what is switched on."""
        on = (sizes for part, sizes in _PARTS.items() if self.values[part])
        return tuple(name for sizes in on for name in sizes)

    def statuses(self) -> tuple[Status, ...]:
        """Also that nothing is switched on."""
        if any(self.values[part] for part in _PARTS):
            return super().statuses()
        sentence = "None of its parts is switched on, so nothing of it is seen."
        off = Status("warn", "empty", sentence, (_HAS_AXES[0], True))
        return (*super().statuses(), off)

    def placed(self, entry: Entry[Motion], shapes: Mapping[str, Shape]) -> Placed:
        """Place the unit, turned with its frame unless its attitude is that in the world."""
        turns = not self.values[_IN_WORLD]
        return Placed(entry.frame, entry.stamp_ns, shapes, turns=turns)

    def _box(self, motion: Motion) -> Solids:
        scales = np.array([[self.values[name] for name in _PARTS[_HAS_BOX[0]]]], np.float32)
        return Solids(
            "box",
            motion.attitude.xyz.astype(np.float32),
            motion.attitude.wxyz.astype(np.float32),
            scales,
            colour_of(rgb_of(self.values[f"{_BOX}/Box color"])),
            self.number(f"{_BOX}/Box alpha"),
        )

    def _arrow(self, name: str, vector: Floats, under: str) -> dict[str, Shape]:
        scale_m = self.number(f"{under} scale")
        measured = float(np.linalg.norm(vector))
        if measured == 0 or scale_m == 0:
            return {}
        tip = vector * scale_m * (1.0 + _HEAD_LENGTH_M / measured)
        return {
            name: Arrows(
                np.array([[np.zeros(3), tip]], dtype=np.float32),
                colour_of(rgb_of(self.values[f"{under} color"])),
                _SHAFT_M * scale_m,
                _HEAD_M * scale_m,
                _HEAD_LENGTH_M * scale_m,
                self.number(f"{under} alpha"),
            )
        }


def _row(vector: Any) -> Floats:  # noqa: ANN401 - a message
    return np.array([vector.x, vector.y, vector.z], dtype=np.float64)


def _in_world(motion: Motion, vector: Floats) -> Floats:
    return turned(motion.attitude.wxyz, vector)[0]
