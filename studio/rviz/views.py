"""RViz's views: which kinds there are, and what of each can be set, with RViz's first values.

World z is up. `Yaw` turns about it, from x towards y. `Pitch` tips the camera downwards: at a pitch
of more than 0 an Orbit looks down on its focal point, and an FPS looks below the horizon. What the
values mean for the camera is written down in `frontend_assets/lib/view-poses.js`, for every person
has a camera of their own.
"""

from __future__ import annotations

import math
from collections.abc import Mapping  # noqa: TC003 - msgspec reads it
from dataclasses import dataclass, field, replace
from typing import Any, Final

from studio.displays.properties import FIXED_FRAME, Property, Value, length, switch
from studio.errors import ViewError

ORTHOGRAPHIC: Final = "Orthographic"
"""A property of ours that RViz has not: seen without perspective. TopDownOrtho is so always, and an
FPS that is so has a `Scale` as it has. RViz passes over both."""
NAME_MAX: Final = 80
VIEWS_MAX: Final = 100
"""So many views can be saved with a document."""

_QUARTER: Final = math.pi / 4
_PITCH_MAX: Final = math.pi / 2 - 0.001
_FAR_M: Final = 1e6


@dataclass(frozen=True, slots=True)
class ViewSpec:
    """A view as it is kept.

    Attributes:
        kind: RViz's class without its package, as `Orbit`.
        name: What the user calls it.
        values: Properties by RViz's names, with slashes for groups, as `Focal Point/X`; those that
            are not there have their first values.
        entry: As it stands in the `.rviz` file; empty: it was in none.
    """

    kind: str
    name: str = ""
    values: Mapping[str, Value] = field(default_factory=dict[str, Value])
    entry: dict[str, Any] = field(default_factory=dict[str, Any])

    def checked(self) -> ViewSpec:
        """Return it with every value as its property takes it.

        Raises:
            ViewError: There is no such kind, or it has no such property.
            DisplayPropertyError: A value is of another kind.
        """
        kind = view_kind(self.kind)
        values = {name: kind.property(name).checked(value) for name, value in self.values.items()}
        return replace(self, name=self.name.strip()[:NAME_MAX], values=values)


@dataclass(frozen=True, slots=True)
class ViewKind:
    """A kind of view.

    Attributes:
        kind: RViz's class without its package.
        doc: One sentence for the user.
        properties: In RViz's order.
    """

    kind: str
    doc: str
    properties: tuple[Property, ...]

    def property(self, name: str) -> Property:
        """Return the property of a name.

        Raises:
            ViewError: There is none.
        """
        for one in self.properties:
            if one.name == name:
                return one
        raise ViewError(f'A view "{self.kind}" has no property "{name}".')


def view_kind(kind: str) -> ViewKind:
    """Return a kind of view by RViz's name of its class.

    Raises:
        ViewError: There is none.
    """
    found = VIEW_KINDS.get(kind)
    if found is None:
        raise ViewError(f'There is no view "{kind}": it is one of {", ".join(VIEW_KINDS)}.')
    return found


def _place(name: str, doc: str, default_m: tuple[float, float, float]) -> tuple[Property, ...]:
    return tuple(
        Property(f"{name}/{axis}", "number", at, doc, low=-_FAR_M, high=_FAR_M, unit="m")
        for axis, at in zip("XYZ", default_m, strict=True)
    )


def _angle(name: str, default: float, doc: str, limit: float = float("inf")) -> Property:
    return Property(name, "number", default, doc, low=-limit, high=limit, unit="rad")


_TARGET: Final = Property(
    "Target Frame", "frame", FIXED_FRAME, "TF frame whose motion this view follows."
)
_NEAR: Final = Property(
    "Near Clip Distance",
    "number",
    0.01,
    "Anything that is closer to the camera is not drawn.",
    low=0.001,
    high=10_000.0,
    unit="m",
)
_INVERT: Final = switch(
    "Invert Z Axis", "Turns the world upside down, for models whose z points down.", on=False
)
_FLAT: Final = switch(ORTHOGRAPHIC, "Shows far things as large as near ones.", on=False)
_FIELD: Final = Property(
    "Field of View",
    "number",
    _QUARTER,
    "Vertical opening angle of the camera.",
    low=0.01,
    high=math.pi - 0.1,
    unit="rad",
)
_YAW_DOC: Final = "Rotation of the camera around the z axis, which points up."
_PITCH_DOC: Final = "How far the camera is tipped downwards."

_ORBIT: Final = (
    _TARGET,
    _NEAR,
    _INVERT,
    _FLAT,
    _FIELD,
    Property("Distance", "number", 10.0, "Distance from the focal point.", 0.001, _FAR_M, unit="m"),
    length("Focal Shape Size", 0.05, "Size of the mark at the focal point while the mouse moves."),
    switch(
        "Focal Shape Fixed Size",
        "Gives the mark this size in metres; else it is this share of the distance.",
        on=True,
    ),
    _angle("Yaw", _QUARTER, _YAW_DOC),
    _angle("Pitch", _QUARTER, _PITCH_DOC, _PITCH_MAX),
    *_place("Focal Point", "The point that the camera orbits.", (0.0, 0.0, 0.0)),
)
_WALK: Final = (
    Property(
        "Scale",
        "number",
        100.0,
        "Pixels for one metre, without perspective.",
        low=1e-4,
        high=1e6,
        unit="px",
        when=(ORTHOGRAPHIC, (True,)),
    ),
    _angle("Yaw", 0.0, _YAW_DOC),
    _angle("Pitch", 0.0, _PITCH_DOC, _PITCH_MAX),
    *_place("Position", "Position of the camera.", (5.0, 5.0, 10.0)),
)
AXES: Final = ("arbitrary", "+x axis", "-x axis", "+y axis", "-y axis", "+z axis", "-z axis")

VIEW_KINDS: Final[Mapping[str, ViewKind]] = {
    one.kind: one
    for one in (
        ViewKind("Orbit", "Turns around a point, and looks at it from any side.", _ORBIT),
        ViewKind("XYOrbit", "Turns around a point that stays on the ground.", _ORBIT),
        ViewKind(
            "FPS",
            "Looks around from where it stands, and walks.",
            (_TARGET, _NEAR, _FLAT, _FIELD, *_WALK),
        ),
        ViewKind(
            "TopDownOrtho",
            "Looks straight down, as on a map.",
            (
                _TARGET,
                _NEAR,
                Property("Scale", "number", 10.0, "Pixels for one metre.", 1e-4, 1e6, unit="px"),
                _angle("Angle", 0.0, "Rotation about the z axis."),
                Property("X", "number", 0.0, "Position of the camera.", -_FAR_M, _FAR_M, unit="m"),
                Property("Y", "number", 0.0, "Position of the camera.", -_FAR_M, _FAR_M, unit="m"),
            ),
        ),
        ViewKind(
            "ThirdPersonFollower",
            "Follows its frame from behind: it goes and turns with it, and stays upright.",
            _ORBIT,
        ),
        ViewKind(
            "FrameAligned",
            "Looks along an axis of its frame, and goes and tilts with it.",
            (
                _TARGET,
                _NEAR,
                _INVERT,
                _FLAT,
                _FIELD,
                *_WALK,
                Property(
                    "Point towards",
                    "choice",
                    "+x axis",
                    "Looks along this axis of the frame.",
                    choices=AXES,
                ),
                switch("Lock Camera", "Keeps the mouse from moving the camera.", on=False),
            ),
        ),
    )
}
"""By RViz's name, in RViz's order."""
