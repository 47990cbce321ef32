"""Poses of messages: those that can be drawn, and how they are drawn as arrows or axes."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, Protocol

import numpy as np

from studio.displays.drawing import Arrows, Axes
from studio.displays.properties import (
    RVIZ_RED,
    Property,
    colour_of,
    colour_properties,
    length,
    rgb_of,
)
from studio.displays.selection import Fact, orientation_fact, position_fact, row_of
from studio.displays.turning import drawable, turned, unit_quaternions

if TYPE_CHECKING:
    from collections.abc import Mapping
    from typing import Any

    from numpy.typing import NDArray

    from studio.displays.display import Reason
    from studio.displays.drawing import Rgb, Shape
    from studio.displays.properties import Value
    from studio.displays.turning import Flags, Floats

_FORWARD = np.array([1.0, 0.0, 0.0])
NOT_FINITE = "The message holds numbers that are not finite or beyond 1e12, which nobody can draw."
NO_TURN_SET = (
    "The orientation is a quaternion of zeros, drawn as no turn: its publisher should set w to 1."
)
_WXYZ = [6, 3, 4, 5]


class Poses(NamedTuple):
    """Poses that can be drawn.

    Attributes:
        xyz: Shape (N, 3), float64, m.
        wxyz: Shape (N, 4), float64, of length 1.
        numbers: Shape (N,), ascending: the index of each in its message; None: of one pose.
    """

    xyz: Floats
    wxyz: Floats
    numbers: Floats | None = None

    def __len__(self) -> int:
        return len(self.xyz)


class Sizes(NamedTuple):
    """Default sizes of the parts of an arrow, or of axes, m."""

    shaft_length: float = 1.0
    shaft_radius: float = 0.05
    head_length: float = 0.3
    head_radius: float = 0.1
    axes_length: float = 1.0
    axes_radius: float = 0.1


def pose_properties(under: str = "", sizes: Sizes | None = None) -> tuple[Property, ...]:
    """Properties of one pose: which shape it has, and the parts of the shape.

    Args:
        under: What the names of the parts begin with, as `Shape/`.
        sizes: As they are at first.
    """
    shape = Property(
        "Shape", "choice", "Arrow", "What a pose looks like.", choices=("Arrow", "Axes")
    )
    arrow, axes = ("Shape", ("Arrow",)), ("Shape", ("Axes",))
    return (
        shape,
        *colour_properties(RVIZ_RED, "arrow", under, arrow),
        *arrow_properties(sizes or Sizes(), under, arrow),
        *axes_properties(sizes or Sizes(), under, axes),
    )


def arrow_properties(
    sizes: Sizes, under: str = "", when: tuple[str, tuple[Value, ...]] | None = None
) -> tuple[Property, ...]:
    """Return the four measures of an arrow."""
    return tuple(
        length(f"{under}{name}", default, doc, when)
        for name, default, doc in (
            ("Shaft Length", sizes.shaft_length, "How long the shaft is."),
            ("Shaft Radius", sizes.shaft_radius, "How thick the shaft is, from side to side."),
            ("Head Length", sizes.head_length, "How long the head is."),
            ("Head Radius", sizes.head_radius, "How thick the head is, from side to side."),
        )
    )


def axes_properties(
    sizes: Sizes, under: str = "", when: tuple[str, tuple[Value, ...]] | None = None
) -> tuple[Property, Property]:
    """Return the two measures of axes."""
    thick = "How thick each axis is, from side to side."
    return (
        length(f"{under}Axes Length", sizes.axes_length, "How long each axis is.", when),
        length(f"{under}Axes Radius", sizes.axes_radius, thick, when),
    )


def pose_shapes(poses: Poses, values: Mapping[str, Value], under: str = "") -> dict[str, Shape]:
    """Draw poses by the values of `pose_properties`."""
    if values["Shape"] == "Axes":
        return axes_shapes(
            poses, float(values[f"{under}Axes Length"]), float(values[f"{under}Axes Radius"])
        )
    return arrow_shapes(
        poses,
        (float(values[f"{under}Shaft Length"]), float(values[f"{under}Shaft Radius"])),
        (float(values[f"{under}Head Length"]), float(values[f"{under}Head Radius"])),
        rgb_of(values[f"{under}Color"]),
        float(values[f"{under}Alpha"]),
    )


def pose_sizes(values: Mapping[str, Value], under: str = "") -> tuple[str, ...]:
    """Return the properties with the length of a pose; with all 0 it is not drawn."""
    names = ("Axes Length",) if values["Shape"] == "Axes" else ("Shaft Length", "Head Length")
    return tuple(f"{under}{name}" for name in names)


def arrow_shapes(
    poses: Poses, shaft_m: tuple[float, float], head_m: tuple[float, float], rgb: Rgb, alpha: float
) -> dict[str, Shape]:
    """Draw arrows along x, of shafts and heads of a length and a thickness."""
    total_m = shaft_m[0] + head_m[0]
    if not len(poses) or total_m == 0:
        return {}
    tips = poses.xyz + total_m * turned(poses.wxyz, _FORWARD)
    ends = np.stack((poses.xyz, tips), axis=1).astype(np.float32)
    # RViz takes each "radius" for the diameter, and users of RViz expect that.
    return {"arrows": Arrows(ends, colour_of(rgb), shaft_m[1], head_m[1], head_m[0], alpha)}


def axes_shapes(poses: Poses, length_m: float, thickness_m: float) -> dict[str, Shape]:
    """Draw a cross of axes at each pose."""
    if not len(poses) or length_m == 0:
        return {}
    xyz, wxyz = poses.xyz.astype(np.float32), poses.wxyz.astype(np.float32)
    return {"axes": Axes(xyz, wxyz, length_m, thickness_m / 2)}


def pose_of(message: Any) -> Poses | None:  # noqa: ANN401 - a message
    """Return the pose of a geometry_msgs/Pose; None if it has numbers that cannot be drawn.

    A quaternion of zeros is no turn, as in RViz; see `has_no_turn`.
    """
    at, turn = message.position, message.orientation
    xyz = np.array([[at.x, at.y, at.z]], dtype=np.float64)
    wxyz = np.array([[turn.w, turn.x, turn.y, turn.z]], dtype=np.float64)
    if not drawable(xyz).all() or not np.isfinite(wxyz).all():
        return None
    return Poses(xyz, unit_quaternions(wxyz)[0])


def has_no_turn(orientation: Any) -> bool:  # noqa: ANN401 - a message
    """Whether all parts of a quaternion are 0, because its publisher has not set it."""
    return not (orientation.w or orientation.x or orientation.y or orientation.z)


class Reporter(Protocol):
    """A display that reports what it leaves out."""

    def refuse(self, reason: Reason, sentence: str) -> None:
        """Report why nothing of a message can be drawn."""
        ...

    def thin(self, sentence: str) -> None:
        """Report how much is drawn."""
        ...

    def warn(
        self, reason: Reason | None, sentence: str, mend: tuple[str, Value] | None = None
    ) -> None:
        """Report what is odd, or left out."""
        ...


def poses_of_rows(rows: Floats, what: str, at_most: int, display: Reporter) -> Poses | None:
    """Return the poses of rows (N, 7) of x, y, z and a quaternion x, y, z, w.

    Args:
        rows: As they were sent.
        what: What they are called, in the plural.
        at_most: How many are drawn; of more, evenly spaced ones are chosen.
        display: Reports what is left out.

    Returns:
        None if there are rows and none can be drawn.
    """
    chosen = chosen_rows(numbered(rows), drawable_poses(rows), what, at_most, display)
    return None if chosen is None else poses_of_chosen(chosen, what, display)


def numbered(rows: Floats) -> Floats:
    """Return rows (N, K) with the index of each in one more column."""
    return np.column_stack((rows, np.arange(len(rows), dtype=np.float64)))


def poses_of_chosen(chosen: Floats, what: str, display: Reporter) -> Poses:
    """Return poses of `numbered` rows (N, 8 or more) that can all be drawn."""
    wxyz, zero = unit_quaternions(chosen[:, _WXYZ])
    if zero.any():
        display.warn(
            None,
            f"{int(zero.sum()):,} of {len(chosen):,} {what} have a quaternion of zeros, drawn as "
            "no turn: their publisher should set w to 1.",
        )
    return Poses(chosen[:, :3], wxyz, chosen[:, -1])


def drawable_poses(rows: Floats) -> Flags:
    """Return which rows (N, 7) are poses that can be drawn."""
    return drawable(rows[:, :3]) & np.isfinite(rows[:, 3:7]).all(axis=1)


def chosen_rows(
    rows: Floats, sound: Flags, what: str, at_most: int, display: Reporter
) -> Floats | None:
    """Return those of rows (N, K) to draw: valid ones, spread evenly if there are too many."""
    count = len(rows)
    if count and not sound.any():
        display.refuse(
            "not_finite",
            f"None of the {count:,} {what} has numbers that are finite and below 1e12.",
        )
        return None
    chosen = rows if sound.all() else rows[sound]
    if not count:
        display.warn("empty", f"The message holds no {what}.")
    elif len(chosen) < count:
        missing = count - len(chosen)
        display.warn(
            "not_finite",
            f"{missing:,} of {count:,} {what} are left out: their numbers are not finite or beyond "
            "1e12.",
        )
    if len(chosen) <= at_most:
        return chosen
    display.thin(f"Showing {at_most:,} of {count:,} {what}: more would make the view slow.")
    return chosen[np.linspace(0, len(chosen) - 1, at_most).astype(np.intp)]


def pose_parts(poses: Poses, rows: NDArray[np.intp]) -> list[str]:
    """Return the index in the message of each pose of these rows, once."""
    numbers = poses.numbers
    inside = rows[(rows >= 0) & (rows < len(poses))]
    if numbers is None:
        return ["0"] if len(inside) else []
    return [str(int(one)) for one in np.unique(numbers[inside])]


def pose_facts(poses: Poses, part: str) -> tuple[Fact, ...]:
    """Return the index of one pose, where it is and how it is turned."""
    row = row_of(poses.numbers, part)
    if row is None:
        return ()
    return (
        Fact("index", int(part)),
        position_fact(poses.xyz[row].tolist()),
        orientation_fact(poses.wxyz[row].tolist()),
    )


def one_pose(poses: Poses, part: str) -> Poses | None:
    """Return one of many poses by its index in the message; None if it is not drawn."""
    row = row_of(poses.numbers, part)
    return None if row is None else Poses(poses.xyz[row : row + 1], poses.wxyz[row : row + 1])
