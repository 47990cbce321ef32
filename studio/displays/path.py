"""Path: a planned or travelled path as a line, and its poses."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from studio.displays.display import TopicRole
from studio.displays.drawing import Lines
from studio.displays.history import Entry, HistoryDisplay
from studio.displays.poses import (
    Poses,
    arrow_shapes,
    axes_shapes,
    chosen_rows,
    drawable_poses,
    poses_of_chosen,
)
from studio.displays.properties import (
    RVIZ_GREEN,
    Property,
    colour_of,
    colour_properties,
    length,
    rgb_of,
)
from studio.ros.columns.poses import PATH, read_path

if TYPE_CHECKING:
    from studio.displays.display import Received
    from studio.displays.drawing import Shape
    from studio.displays.turning import Flags, Floats

POSES_MAX: Final = 100_000
_AXES, _ARROWS = ("Pose Style", ("Axes",)), ("Pose Style", ("Arrows",))


class Line(NamedTuple):
    """A path: its poses, and whether each is joined with the next, shape (N - 1,)."""

    poses: Poses
    joined: Flags


class PathDisplay(HistoryDisplay[Line]):
    """Draws the last paths as lines, and their poses if a style is chosen."""

    KIND = "Path"
    DOC = "The way that a robot plans, or came."
    ICON = "route"
    TOPICS = (TopicRole("", (PATH,), newest_only=False),)
    PROPERTIES = (
        Property("Line Style", "choice", "Lines", "Hair lines, or lines that have a width.",
                 choices=("Lines", "Billboards")),
        Property("Line Width", "number", 0.03, "How wide the line is.", 0.001, 1000.0, "m",
                 when=("Line Style", ("Billboards",))),
        *colour_properties(RVIZ_GREEN, "line"),
        Property("Buffer Length", "whole", 1, "How many paths are shown.", 1, 1000),
        *(Property(f"Offset/{axis}", "number", 0.0, f"How far the path is moved along {axis}.",
                   -1e6, 1e6, "m") for axis in "XYZ"),
        Property("Pose Style", "choice", "None", "What the poses on the path look like.",
                 choices=("None", "Axes", "Arrows")),
        length("Length", 0.3, "How long each axis is.", _AXES),
        length("Radius", 0.03, "How thick each axis is, from side to side.", _AXES),
        Property("Pose Color", "colour", "#ff55ff", "Colour of the arrows.", when=_ARROWS),
        length("Shaft Length", 0.1, "How long the shaft is.", _ARROWS),
        length("Head Length", 0.2, "How long the head is.", _ARROWS),
        length("Shaft Diameter", 0.1, "How thick the shaft is.", _ARROWS),
        length("Head Diameter", 0.3, "How thick the head is.", _ARROWS),
    )  # fmt: skip
    KEEPS = "Buffer Length"

    def read(self, received: Received) -> Entry[Line] | None:
        """Return the poses; where some cannot be drawn the line is cut."""
        read = read_path(received.cdr)
        sound = drawable_poses(read.rows)
        # With each row how many were left out before it: where that changes there is a gap.
        rows = np.column_stack((read.rows, np.cumsum(~sound, dtype=np.float64)))
        chosen = chosen_rows(rows, sound, "poses", min(POSES_MAX, self.limits.points), self)
        if chosen is None:
            return None
        if len(read.rows) == 1:
            self.warn("empty", "The path has a single pose: a line needs two.")
        line = Line(poses_of_chosen(chosen, "poses", self), np.diff(chosen[:, 7]) == 0)
        return Entry(read.frame, read.stamp_ns, line)

    def points_in(self, content: Line) -> int:
        """Return the number of its poses."""
        return len(content.poses)

    def shapes(self, content: Line) -> dict[str, Shape]:
        """Return the line, and its poses."""
        offset_m = np.array([self.number(f"Offset/{axis}") for axis in "XYZ"])
        moved = Poses(content.poses.xyz + offset_m, content.poses.wxyz)
        return self._line(moved.xyz, content.joined) | self._poses(moved)

    def _line(self, xyz: Floats, joined: Flags) -> dict[str, Shape]:
        if not joined.any():
            return {}
        ends = np.stack((xyz[:-1], xyz[1:]), axis=1)[joined].astype(np.float32)
        wide = self.values["Line Style"] == "Billboards"
        width_m = self.number("Line Width") if wide else 0.0
        colour = colour_of(rgb_of(self.values["Color"]))
        return {"line": Lines(ends, colour, width_m, self.number("Alpha"))}

    def _poses(self, poses: Poses) -> dict[str, Shape]:
        match self.values["Pose Style"]:
            case "Axes":
                return axes_shapes(poses, self.number("Length"), self.number("Radius"))
            case "Arrows":
                return arrow_shapes(
                    poses,
                    (self.number("Shaft Length"), self.number("Shaft Diameter")),
                    (self.number("Head Length"), self.number("Head Diameter")),
                    rgb_of(self.values["Pose Color"]),
                    1.0,
                )
            case _:
                return {}
