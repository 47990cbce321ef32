"""Markers as items that can be selected: their keys, boxes around them and facts about them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from studio.displays.markers.items import place
from studio.displays.markers.kinds import OF_POINTS, Key, Kind
from studio.displays.selection import (
    Box,
    Fact,
    box_around,
    box_at,
    numbers_fact,
    orientation_fact,
    position_fact,
)

if TYPE_CHECKING:
    from studio.displays.markers.kinds import Floats
    from studio.displays.markers.table import Rows

_TYPE_NAMES: Final = {
    Kind.ARROW: "ARROW",
    Kind.CUBE: "CUBE",
    Kind.SPHERE: "SPHERE",
    Kind.CYLINDER: "CYLINDER",
    Kind.LINE_STRIP: "LINE_STRIP",
    Kind.LINE_LIST: "LINE_LIST",
    Kind.CUBE_LIST: "CUBE_LIST",
    Kind.SPHERE_LIST: "SPHERE_LIST",
    Kind.POINTS: "POINTS",
    Kind.TEXT: "TEXT_VIEW_FACING",
    Kind.MESH: "MESH_RESOURCE",
    Kind.TRIANGLES: "TRIANGLE_LIST",
    Kind.ARROW_STRIP: "ARROW_STRIP",
}
"""As visualization_msgs/Marker names its constants."""
_LETTER_SHARE: Final = 0.5
"""Width of a letter, as a share of its height."""


def key_text(key: Key) -> str:
    """Return the key of a marker as a text; the id comes first, since namespaces have slashes."""
    namespace, marker_id = key
    return f"{marker_id}/{namespace}"


def key_of(text: str) -> Key | None:
    """Return the marker that a text names; None if it names none."""
    number, slash, namespace = text.partition("/")
    digits = number.removeprefix("-")
    if not slash or not (digits.isascii() and digits.isdigit()) or len(digits) > 10:
        return None
    return namespace, int(number)


def box_of_marker(marker: Rows) -> Box | None:
    """Return a box around the one marker of some rows, in its frame.

    None for a mesh, which is as large as its file says.
    """
    kind = int(marker.types[0])
    position, wxyz = marker.positions[0], marker.rotations_wxyz[0]
    scale = np.abs(marker.scales[0])
    points = marker.items[0].points
    if kind in OF_POINTS or (kind == Kind.ARROW and len(points) == 2):
        return _around_points(marker, scale)
    if kind == Kind.ARROW:
        half = np.array([[marker.scales[0, 0] / 2, 0.0, 0.0]])
        middle = place(marker, np.zeros(1, np.intp), half)[0]
        return box_at(middle, scale * (1.0, 2.0, 2.0), wxyz)
    if kind == Kind.TEXT:
        wide = scale[2] * _LETTER_SHARE * max(map(len, marker.texts[0].split("\n")), default=1)
        return box_at(position, (wide, wide, scale[2]))
    return None if kind == Kind.MESH else box_at(position, scale, wxyz)


def _around_points(marker: Rows, scale: Floats) -> Box | None:
    """Return a box, in the axes of the frame, around all points and what is drawn about each."""
    kind = int(marker.types[0])
    points = marker.items[0].points
    scaled = points * marker.scales[0] if kind == Kind.TRIANGLES else points
    if not len(points):
        return None
    placed = place(marker, np.zeros(len(points), np.intp), scaled)
    grows = {Kind.TRIANGLES: 0.0, Kind.CUBE_LIST: scale.max(), Kind.SPHERE_LIST: scale.max()}
    half_m = float(grows.get(Kind(kind), scale[0])) / 2
    return box_around(np.concatenate((placed - half_m, placed + half_m)))


def marker_facts(key: Key, marker: Rows) -> tuple[Fact, ...]:
    """Return what RViz shows of a marker: its name, type, pose, scale, colour, and what it says."""
    namespace, marker_id = key
    kind = Kind(int(marker.types[0]))
    found = [
        Fact("ns", namespace[:300]),
        Fact("id", marker_id),
        Fact("type", _TYPE_NAMES[kind]),
        position_fact(marker.positions[0].tolist()),
        orientation_fact(marker.rotations_wxyz[0].tolist()),
        numbers_fact("scale", marker.scales[0].tolist(), "", "vector"),
        numbers_fact("color", marker.rgba[0].tolist(), "", "colour"),
    ]
    if count := len(marker.items[0].points):
        found.append(Fact("points", count))
    if kind == Kind.TEXT:
        found.append(Fact("text", marker.texts[0]))
    if kind == Kind.MESH:
        found.append(Fact("mesh_resource", marker.texts[0]))
    return tuple(found)
