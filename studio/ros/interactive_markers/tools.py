"""What a client adds to markers before it shows them: handles, colours, and what was left empty."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import TYPE_CHECKING, Final

from studio.ros.interactive_markers.names import CONTROL, Mode, OrientationMode

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from studio.ros.types.classes import MessageValue
    from studio.ros.types.library import TypeLibrary

_ARROW: Final = 0
_TEXT: Final = 9
_TRIANGLES: Final = 11
_STEPS: Final = 36
_INNER_M: Final = 0.5
_RING_WIDTH: Final = 0.3
"""Of a ring, as a share of its inner radius."""
_DARK: Final = 0.6
_DISC_MODES: Final = (Mode.MOVE_PLANE, Mode.ROTATE_AXIS, Mode.MOVE_ROTATE)
_WHITE: Final = (1.0, 1.0, 1.0, 1.0)


def auto_complete(
    marker: MessageValue,
    types: TypeLibrary,
    *,
    transparent: bool = True,
) -> None:
    """Give a marker its default handles, and values where it has none; it is changed in place.

    A scale of 0 becomes 1, quaternions get length 1, and two controls of one name two names.
    Numbers that are not finite stay so.

    Args:
        marker: Of the server; one without controls stays as it is.
        types: Of which the messages are.
        transparent: Whether markers may be seen through; else they are opaque.
    """
    if not marker.controls:
        return
    if marker.scale == 0:
        marker.scale = 1.0
    normalize(marker.pose.orientation)
    for control in marker.controls:
        complete_control(marker, control, types, transparent=transparent)
    _give_unique_names(marker.controls)


def make_title(marker: MessageValue, types: TypeLibrary) -> MessageValue:
    """Return a control that shows the description of a marker above it."""
    control = types.message(CONTROL)(
        interaction_mode=int(Mode.NONE),
        orientation_mode=int(OrientationMode.VIEW_FACING),
        always_visible=True,
    )
    height_m = 0.15 * marker.scale
    title = _text_marker(types, marker.description, height_m)
    title.pose.position.z = 1.4 * marker.scale
    control.markers.append(title)
    complete_control(marker, control, types)
    return control


def complete_control(
    marker: MessageValue,
    control: MessageValue,
    types: TypeLibrary,
    *,
    transparent: bool = True,
) -> None:
    """Give a control the handles of its mode if it has none, and its markers what they lack."""
    if _is_zero(control.orientation):
        control.orientation.w = 1.0
    if not control.markers:
        _add_default_handles(marker, control, types)
    for number, one in enumerate(control.markers):
        for axis in ("x", "y", "z"):
            if getattr(one.scale, axis) == 0:
                setattr(one.scale, axis, 1.0)
        normalize(one.pose.orientation)
        one.ns, one.id = marker.name, number
        if not transparent and one.color.a > 0:
            one.color.a = 1.0


def normalize(quaternion: MessageValue) -> None:
    """Bring a quaternion to length 1, in place; one of zeros becomes no turn.

    One that is not finite stays as it is.
    """
    parts: list[float] = [quaternion.x, quaternion.y, quaternion.z, quaternion.w]
    if not all(map(math.isfinite, parts)):
        return
    largest = max(map(abs, parts))
    if largest == 0:
        quaternion.w = 1.0
        return
    scaled = [part / largest for part in parts]  # squares of very large parts are infinite
    length = math.sqrt(sum(part * part for part in scaled))
    quaternion.x, quaternion.y, quaternion.z, quaternion.w = (part / length for part in scaled)


def _is_zero(quaternion: MessageValue) -> bool:
    return quaternion.x == quaternion.y == quaternion.z == quaternion.w == 0


def _give_unique_names(controls: Iterable[MessageValue]) -> None:
    names, number = set[str](), 0
    for control in controls:
        name = control.name
        while name in names:
            name, number = f"{control.name}_u{number}", number + 1
        control.name = name
        names.add(name)


def _add_default_handles(marker: MessageValue, control: MessageValue, types: TypeLibrary) -> None:
    mode = control.interaction_mode
    if mode == Mode.MOVE_AXIS:
        control.markers.extend(_arrow(marker, control, types, way) for way in (1.0, -1.0))
    elif mode in _DISC_MODES:
        control.markers.append(_disc(marker, control, types))
    elif mode == Mode.MENU:
        _make_view_facing_button(marker, control, types)


def _handle(control: MessageValue, types: TypeLibrary, kind: int) -> MessageValue:
    """Return a marker in the axes of its control, in the colour of the axis that is its x."""
    made = types.message("visualization_msgs/msg/Marker")(type=kind)
    for part in ("x", "y", "z", "w"):
        setattr(made.pose.orientation, part, getattr(control.orientation, part))
    made.color.r, made.color.g, made.color.b = _axis_colour(control.orientation)
    made.color.a = 0.5
    return made


def _axis_colour(quaternion: MessageValue) -> tuple[float, float, float]:
    """Return red, green and blue for x, y and z, by where the x axis of a control points."""
    x, y, z, w = quaternion.x, quaternion.y, quaternion.z, quaternion.w
    length2 = x * x + y * y + z * z + w * w
    if not 0 < length2 < math.inf:
        return 1.0, 0.0, 0.0
    parts = (
        abs(1 - 2 * (y * y + z * z) / length2),
        abs(2 * (x * y + w * z) / length2),
        abs(2 * (x * z - w * y) / length2),
    )
    most = max(parts)
    return parts[0] / most, parts[1] / most, parts[2] / most


def _arrow(
    marker: MessageValue, control: MessageValue, types: TypeLibrary, way: float
) -> MessageValue:
    """Return an arrow along the control's x, or against it with `way` -1."""
    arrow, point = _handle(control, types, _ARROW), types.message("geometry_msgs/msg/Point")
    scale = marker.scale
    arrow.scale.x, arrow.scale.y, arrow.scale.z = 0.15 * scale, 0.25 * scale, 0.2 * scale
    arrow.points = [point(x=way * 0.5 * scale), point(x=way * 0.9 * scale)]
    return arrow


def _disc(marker: MessageValue, control: MessageValue, types: TypeLibrary) -> MessageValue:
    """Return a ring in the control's y-z plane, whose pattern shows what it does.

    Its points are those of other rings, too: nobody writes into them.
    """
    disc, point = _handle(control, types, _TRIANGLES), types.message("geometry_msgs/msg/Point")
    disc.scale.x = disc.scale.y = disc.scale.z = marker.scale
    disc.points = list(_points_of(control.interaction_mode, point))
    if control.interaction_mode != Mode.MOVE_PLANE:
        color = types.message("std_msgs/msg/ColorRGBA")
        base = (disc.color.r, disc.color.g, disc.color.b)
        shades = {
            shade: color(r=shade * base[0], g=shade * base[1], b=shade * base[2], a=1.0)
            for shade in (_DARK, 1.0)
        }
        disc.colors = [shades[shade] for _, shade in _PATTERNS[control.interaction_mode]()]
    return disc


@lru_cache(maxsize=16)
def _points_of(mode: int, point: type[MessageValue]) -> tuple[MessageValue, ...]:
    """Return the corners of the triangles of a ring; all rings of a mode have the same."""
    corners = (corner for triangle, _ in _PATTERNS[mode]() for corner in triangle)
    return tuple(point(y=y, z=z) for y, z in map(_on_ring, corners))


_Corner = tuple[bool, int]
"""Whether it is on the outer circle, and its step."""
_Triangles = tuple[tuple[_Corner, _Corner, _Corner], float]
"""Corners of a triangle, and how bright it is."""


def _on_ring(corner: _Corner) -> tuple[float, float]:
    is_outer, step = corner
    angle = 2 * math.pi * (step % _STEPS) / _STEPS
    radius = _INNER_M * (1 + _RING_WIDTH) if is_outer else _INNER_M
    return radius * math.cos(angle), radius * math.sin(angle)


def _turning() -> Iterator[_Triangles]:
    """Yield slanted fields, dark and bright: the ring of a rotation."""
    for at in range(_STEPS):
        shade = _DARK + (1 - _DARK) * (at % 2)
        yield ((False, at), (True, at + 1), (False, at + 1)), shade
        yield ((False, at + 1), (True, at + 1), (True, at + 2)), shade


def _moving_turning() -> Iterator[_Triangles]:
    """Yield dark and bright teeth: a ring that moves and turns."""
    for at in range(0, _STEPS - 1, 2):
        yield ((False, at), (True, at + 1), (False, at + 1)), _DARK
        yield ((False, at + 1), (True, at + 1), (False, at + 2)), _DARK
        yield ((True, at), (True, at + 1), (False, at)), 1.0
        yield ((True, at + 1), (True, at + 2), (False, at + 2)), 1.0


def _moving() -> Iterator[_Triangles]:
    """Yield a plain ring, that of a plane."""
    for at in range(_STEPS):
        yield ((False, at), (True, at), (False, at + 1)), 1.0
        yield ((True, at), (True, at + 1), (False, at + 1)), 1.0


_PATTERNS: Final = {
    int(Mode.MOVE_PLANE): _moving,
    int(Mode.ROTATE_AXIS): _turning,
    int(Mode.MOVE_ROTATE): _moving_turning,
}


def _make_view_facing_button(
    marker: MessageValue, control: MessageValue, types: TypeLibrary
) -> None:
    """Give a control of a menu its description as a text that faces the eye."""
    control.orientation_mode = int(OrientationMode.VIEW_FACING)
    control.independent_marker_orientation = False
    height_m = 0.25 * marker.scale
    text = _text_marker(types, control.description, height_m)
    text.pose.position.x = -0.1 * height_m
    text.pose.position.z = 1.2 * marker.scale - 0.1 * height_m
    control.markers.append(text)


def _text_marker(types: TypeLibrary, text: str, height_m: float) -> MessageValue:
    made = types.message("visualization_msgs/msg/Marker")(type=_TEXT, text=text)
    made.scale.x = made.scale.y = made.scale.z = height_m
    made.color.r, made.color.g, made.color.b, made.color.a = _WHITE
    return made
