"""PoseLook: poses as arrows along their x axes, or as axes; shared by all displays of poses."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from studio.displays.drawing import Arrows, Axes
from studio.displays.properties import Property, rgb_of
from studio.displays.turning import drawable, turned, unit_quaternions

if TYPE_CHECKING:
    from collections.abc import Mapping
    from typing import Any

    from studio.displays.drawing import Rgb, Shape
    from studio.displays.properties import Value
    from studio.displays.turning import Floats

RVIZ_RED = "#ff1900"
_FORWARD = np.array([1.0, 0.0, 0.0])


class Poses(NamedTuple):
    """Poses that can be drawn.

    Attributes:
        xyz: Shape (N, 3), float64, m.
        wxyz: Shape (N, 4), float64, of length 1.
    """

    xyz: Floats
    wxyz: Floats

    def __len__(self) -> int:
        return len(self.xyz)


class Sizes(NamedTuple):
    """What the parts of an arrow, or of axes, measure at first, m."""

    shaft_length: float = 1.0
    shaft_radius: float = 0.05
    head_length: float = 0.3
    head_radius: float = 0.1
    axes_length: float = 1.0
    axes_radius: float = 0.1


def pose_properties(under: str = "", sizes: Sizes | None = None) -> tuple[Property, ...]:
    """What of one pose can be set: which shape it has, and the parts of the shape.

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


def colour_properties(
    colour: str, what: str, under: str = "", when: tuple[str, tuple[Value, ...]] | None = None
) -> tuple[Property, Property]:
    """Color and Alpha of something."""
    return (
        Property(f"{under}Color", "colour", colour, f"Colour of the {what}.", when=when),
        Property(f"{under}Alpha", "number", 1.0, f"How opaque the {what} is.", 0.0, 1.0, when=when),
    )


def arrow_properties(
    sizes: Sizes, under: str = "", when: tuple[str, tuple[Value, ...]] | None = None
) -> tuple[Property, ...]:
    """The four measures of an arrow."""
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
    """The two measures of axes."""
    thick = "How thick each axis is, from side to side."
    return (
        length(f"{under}Axes Length", sizes.axes_length, "How long each axis is.", when),
        length(f"{under}Axes Radius", sizes.axes_radius, thick, when),
    )


def length(
    name: str, default: float, doc: str, when: tuple[str, tuple[Value, ...]] | None = None
) -> Property:
    """A length that can be set, m."""
    return Property(name, "number", default, doc, low=0.0, high=1000.0, unit="m", when=when)


def switch(
    name: str, doc: str, *, on: bool, when: tuple[str, tuple[Value, ...]] | None = None
) -> Property:
    """What can be switched on and off."""
    return Property(name, "switch", on, doc, when=when)


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
    """How long a pose is drawn, by the names of properties; where all are 0 it is not."""
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
    # RViz takes each "radius" for what is seen from side to side, and so does who knows RViz.
    return {"arrows": Arrows(ends, colour_of(rgb), shaft_m[1], head_m[1], head_m[0], alpha)}


def axes_shapes(poses: Poses, length_m: float, thickness_m: float) -> dict[str, Shape]:
    """Draw a cross of axes at each pose."""
    if not len(poses) or length_m == 0:
        return {}
    xyz, wxyz = poses.xyz.astype(np.float32), poses.wxyz.astype(np.float32)
    return {"axes": Axes(xyz, wxyz, length_m, thickness_m / 2)}


def colour_of(rgb: Rgb) -> Any:  # noqa: ANN401 - NDArray[np.uint8] of shape (3,)
    """One colour for all, as shapes take it."""
    return np.array(rgb, dtype=np.uint8)


def pose_of(message: Any) -> Poses | None:  # noqa: ANN401 - a message
    """The one pose of a geometry_msgs/Pose; None when it has numbers that cannot be drawn.

    A quaternion of zeros is no turn, as in RViz: `has_no_turn` tells it.
    """
    at, turn = message.position, message.orientation
    xyz = np.array([[at.x, at.y, at.z]], dtype=np.float64)
    wxyz = np.array([[turn.w, turn.x, turn.y, turn.z]], dtype=np.float64)
    if not drawable(xyz).all() or not np.isfinite(wxyz).all():
        return None
    return Poses(xyz, unit_quaternions(wxyz)[0])


def has_no_turn(orientation: Any) -> bool:  # noqa: ANN401 - a message
    """Whether all parts of a quaternion are 0: nobody has set it."""
    return not (orientation.w or orientation.x or orientation.y or orientation.z)


NOT_FINITE = "The message holds numbers that are not finite or beyond 1e12, which nobody can draw."
NO_TURN_SET = (
    "The orientation is a quaternion of zeros, drawn as no turn: its publisher should set w to 1."
)
