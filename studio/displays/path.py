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
    numbered,
    one_pose,
    pose_facts,
    pose_parts,
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
from studio.displays.selection import Fact, Item, box_at, box_of, wxyz_of, xyz_of
from studio.ros.columns.poses import PATH, read_path

if TYPE_CHECKING:
    from collections.abc import Sequence

    from studio.displays.display import Received
    from studio.displays.drawing import Shape
    from studio.displays.selection import Picked
    from studio.displays.turning import Flags, Floats
    from studio.ros.types.classes import MessageValue

POSES_MAX: Final = 100_000
_POSE_M: Final = 0.05
"""Edge of the box around a pose that is drawn as nothing but a corner of the line."""
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
        at_most = min(POSES_MAX, self.limits.points)
        chosen = chosen_rows(numbered(rows), sound, "poses", at_most, self)
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
        moved = Poses(content.poses.xyz + self._offset_m, content.poses.wxyz)
        return self._line(moved.xyz, content.joined) | self._poses(moved)

    def parts_picked(self, content: Line, picked: Picked) -> Sequence[str]:
        """Return the index of each pose; of a piece of the line, that where it begins."""
        rows = picked.rows
        if picked.shape == "line":
            begins = np.flatnonzero(content.joined)
            rows = begins[rows[rows < len(begins)]]
        return pose_parts(content.poses, rows)

    def part_item(self, entry: Entry[Line], path: str, part: str) -> Item | None:
        """Return one pose."""
        one = one_pose(entry.content.poses, part)
        if one is None:
            return None
        shown = self.shapes(Line(one, entry.content.joined[:0]))
        box = box_of(shown) or box_at(one.xyz[0] + self._offset_m, (_POSE_M,) * 3)
        pose = xyz_of(one.xyz[0] + self._offset_m), wxyz_of(one.wxyz[0])
        return Item("pose", part, path, entry.frame, entry.stamp_ns, box, *pose)

    def part_facts(
        self, content: Line, part: str, message: MessageValue | None
    ) -> tuple[Fact, ...]:
        """Return its index and the pose, with its own frame and stamp."""
        found = pose_facts(content.poses, part)
        if message is None or not found:
            return found
        header = message.poses[int(part)].header
        stamp = header.stamp
        return (
            *found,
            Fact("header.frame_id", header.frame_id[:300]),
            Fact("header.stamp", f"{stamp.sec}.{stamp.nanosec:09d}", "s"),
        )

    def _line(self, xyz: Floats, joined: Flags) -> dict[str, Shape]:
        if not joined.any():
            return {}
        ends = np.stack((xyz[:-1], xyz[1:]), axis=1)[joined].astype(np.float32)
        wide = self.values["Line Style"] == "Billboards"
        width_m = self.number("Line Width") if wide else 0.0
        colour = colour_of(rgb_of(self.values["Color"]))
        return {"line": Lines(ends, colour, width_m, self.number("Alpha"))}

    @property
    def _offset_m(self) -> Floats:
        return np.array([self.number(f"Offset/{axis}") for axis in "XYZ"])

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
