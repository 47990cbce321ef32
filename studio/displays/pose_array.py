"""PoseArrayDisplay: many poses, as the particles of a localisation are."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from studio.displays.display import TopicRole
from studio.displays.drawing import Lines
from studio.displays.history import Entry, HistoryDisplay
from studio.displays.poses import (
    Poses,
    Sizes,
    arrow_properties,
    axes_properties,
    one_pose,
    pose_facts,
    pose_parts,
    pose_shapes,
    pose_sizes,
    poses_of_rows,
)
from studio.displays.properties import (
    RVIZ_RED,
    Property,
    colour_of,
    colour_properties,
    length,
    rgb_of,
)
from studio.displays.selection import Item, box_of, wxyz_of, xyz_of
from studio.displays.turning import turned
from studio.ros.columns.poses import POSE_ARRAY, read_pose_array

if TYPE_CHECKING:
    from collections.abc import Sequence

    from studio.displays.display import Received
    from studio.displays.drawing import Shape
    from studio.displays.selection import Fact, Picked
    from studio.ros.types.classes import MessageValue

_FLAT, _SOLID, _AXES = "Arrow (Flat)", "Arrow (3D)", "Axes"
_SIZES = Sizes(0.23, 0.01, 0.07, 0.03, 0.3, 0.01)
_ARROWS = ("Shape", (_FLAT, _SOLID))
POSES_MAX: Final = 50_000

# Of a flat arrow of length 1, along x and y: its tail and tip, and the two strokes of its head.
_STROKES = ((0.0, 0.0), (1.0, 0.0), (1.0, 0.0), (0.75, 0.2), (1.0, 0.0), (0.75, -0.2))


class PoseArrayDisplay(HistoryDisplay[Poses]):
    """Draws all poses of the newest message."""

    KIND = "PoseArray"
    DOC = "Many poses, as the particles of a localisation are."
    ICON = "pose"
    TOPICS = (TopicRole("", (POSE_ARRAY,)),)
    PROPERTIES = (
        Property("Shape", "choice", _FLAT, "What a pose looks like.",
                 choices=(_FLAT, _SOLID, _AXES)),
        *colour_properties(RVIZ_RED, "arrows", when=_ARROWS),
        length("Arrow Length", 0.3, "How long the flat arrows are.", ("Shape", (_FLAT,))),
        *arrow_properties(_SIZES, when=("Shape", (_SOLID,))),
        *axes_properties(_SIZES, when=("Shape", (_AXES,))),
    )  # fmt: skip

    def read(self, received: Received) -> Entry[Poses] | None:
        """Return the poses that can be drawn."""
        read = read_pose_array(received.cdr)
        poses = poses_of_rows(read.rows, "poses", min(POSES_MAX, self.limits.points), self)
        return None if poses is None else Entry(read.frame, read.stamp_ns, poses)

    def shapes(self, content: Poses) -> dict[str, Shape]:
        """Flat arrows, arrows or axes."""
        if self.values["Shape"] != _FLAT:
            return pose_shapes(content, self.values)
        if not len(content) or not self.values["Arrow Length"]:
            return {}
        return {"arrows": self._flat(content)}

    def parts_picked(self, content: Poses, picked: Picked) -> Sequence[str]:
        """Return the index of each pose; a flat arrow has three lines."""
        lines = 3 if self.values["Shape"] == _FLAT else 1
        return pose_parts(content, picked.rows // lines)

    def part_item(self, entry: Entry[Poses], path: str, part: str) -> Item | None:
        """Return one pose."""
        one = one_pose(entry.content, part)
        if one is None:
            return None
        box = box_of(self.shapes(one))
        pose = xyz_of(one.xyz[0]), wxyz_of(one.wxyz[0])
        return Item("pose", part, path, entry.frame, entry.stamp_ns, box, *pose)

    def part_facts(
        self, content: Poses, part: str, message: MessageValue | None
    ) -> tuple[Fact, ...]:
        """Return its index and the pose."""
        del message
        return pose_facts(content, part)

    def sizes(self) -> tuple[str, ...]:
        """Return the properties with the length of each."""
        return ("Arrow Length",) if self.values["Shape"] == _FLAT else pose_sizes(self.values)

    def _flat(self, poses: Poses) -> Lines:
        along, aside = self.number("Arrow Length") * np.eye(3)[:2]
        ahead, left = turned(poses.wxyz, along), turned(poses.wxyz, aside)
        places = [poses.xyz + x * ahead + y * left for x, y in _STROKES]
        ends = np.stack(places, axis=1).reshape(-1, 2, 3).astype(np.float32)
        colour = colour_of(rgb_of(self.values["Color"]))
        return Lines(ends, colour, 0.0, self.number("Alpha"))
