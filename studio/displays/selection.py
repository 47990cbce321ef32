"""What can be selected of a display: items by their keys, where they are, and facts about them.

An item is what a message is made of: a marker, a point of a cloud, a cell of a map, a frame; or the
message itself where it is one thing, as a pose is. Its key stays the same from message to message,
so that a selected marker is followed until it is deleted.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Final, Literal, NamedTuple, TypeAlias, cast

import numpy as np

from studio.displays.drawing import (
    NO_TURN,
    ORIGIN,
    Arrows,
    Axes,
    Frustum,
    Lines,
    Picture,
    Points,
    Solids,
    Text,
    Triangles,
)
from studio.displays.turning import turned
from studio.ros.types.classes import MessageValue, attributes_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from numpy.typing import NDArray

    from studio.displays.drawing import Shape, Wxyz, Xyz

FactValue: TypeAlias = "str | int | float | bool | tuple[float, ...]"
FactKind: TypeAlias = Literal["", "position", "orientation", "vector", "colour", "field"]
"""What a value is: three numbers of a place or a vector, four x, y, z, w of a turn, four parts from
0 to 1 of a colour; a field that the sender named."""
ItemKind: TypeAlias = Literal[
    "marker", "point", "beam", "cell", "map", "pose", "frame", "link", "corner", "joint", "message",
    "image",
]  # fmt: skip

NEWEST: Final = "newest"
"""First part of the key of what is always of the newest message."""
FACTS_MAX: Final = 100
"""Facts of one item: a cloud may have a thousand fields."""
_TEXT_MAX: Final = 1000
_NUMBERS_MAX: Final = 36
"""A covariance is shown as it is; of longer arrays only the length."""
_DEPTH_MAX: Final = 8
_LEAST_M: Final = 0.002
"""Of an edge of a box around something flat."""


class Picked(NamedTuple):
    """What somebody pointed at in a drawing.

    Attributes:
        path: Of the group.
        shape: Its name in the group.
        rows: Shape (N,): which of the shape's points, solids, lines ...; the numbers of their
            `items` if the shape has them.
        place: Where it was hit, m in the frame of the group; None: it was not hit in one place.
    """

    path: str
    shape: str
    rows: NDArray[np.intp]
    place: Xyz | None = None


class Box(NamedTuple):
    """A box around something: its middle and edges, m, in the frame of its group."""

    middle: Xyz = ORIGIN
    size_m: Xyz = (0.0, 0.0, 0.0)
    wxyz: Wxyz = NO_TURN


class Item(NamedTuple):
    """An item as it is now.

    Attributes:
        kind: What it is.
        name: What the user knows it by, as `namespace/id` of a marker; empty: its kind says all.
        path: Of the group that it is drawn in.
        frame: Of the message.
        stamp_ns: Of the message, since the epoch; 0: it has none.
        box: Around it; None: as large as what is drawn of its group, or of the shape.
        xyz: Where it is in the frame of its group, m; None: in the middle of its box.
        wxyz: How it is turned there; None: it has no direction.
        shape: What is drawn of it in the group; empty: all.
        row: Which point of the shape it is; None: it is none. Points of a sweep are drawn elsewhere
            than their message says.
    """

    kind: ItemKind
    name: str
    path: str
    frame: str
    stamp_ns: int
    box: Box | None
    xyz: Xyz | None = None
    wxyz: Wxyz | None = None
    shape: str = ""
    row: int | None = None


class Fact(NamedTuple):
    """One thing known of an item, by the name of its field."""

    name: str
    value: FactValue
    unit: str = ""
    kind: FactKind = ""


def index_of(text: str) -> int:
    """Return the index that a part of a key names; -1 for any other text."""
    return int(text) if text.isascii() and text.isdigit() and len(text) < 16 else -1


def row_of(numbers: NDArray[np.floating] | NDArray[np.intp] | None, text: str) -> int | None:
    """Return the row of an index among the ascending `numbers` that are drawn; None: not there.

    Args:
        numbers: Shape (N,); None: of a single row.
        text: The index, as a part of a key.
    """
    index = index_of(text)
    if numbers is None:
        return 0 if index == 0 else None
    row = int(np.searchsorted(numbers, index))
    return row if row < len(numbers) and numbers[row] == index else None


def xyz_of(numbers: Iterable[float]) -> Xyz:
    """Return three plain numbers."""
    x, y, z = map(float, numbers)
    return x, y, z


def wxyz_of(numbers: Iterable[float]) -> Wxyz:
    """Return four plain numbers."""
    w, x, y, z = map(float, numbers)
    return w, x, y, z


def number_fact(name: str, value: float, unit: str = "", kind: FactKind = "") -> Fact:
    """Return a fact that is a number; what is not finite becomes a word."""
    return Fact(name, value if math.isfinite(value) else str(value), unit, kind)


def numbers_fact(name: str, values: Iterable[float], unit: str = "", kind: FactKind = "") -> Fact:
    """Return a fact of several numbers; if one is not finite all become words."""
    numbers = tuple(map(float, values))
    if all(map(math.isfinite, numbers)):
        return Fact(name, numbers, unit, kind)
    return Fact(name, ", ".join(f"{one:g}" for one in numbers), unit)


def position_fact(xyz: Iterable[float]) -> Fact:
    """Return where something is in its frame, m."""
    return numbers_fact("position", xyz, "m", "position")


def orientation_fact(wxyz: Iterable[float]) -> Fact:
    """Return how something is turned in its frame; the fact has x, y, z, w as ROS does."""
    w, x, y, z = wxyz
    return numbers_fact("orientation", (x, y, z, w), "", "orientation")


def message_facts(message: MessageValue) -> tuple[Fact, ...]:
    """Return the fields of a small message but for its header; of long arrays the length."""
    found: list[Fact] = []
    _collect(message, "", found, 0)
    return tuple(found[:FACTS_MAX])


def _collect(message: MessageValue, prefix: str, found: list[Fact], depth: int) -> None:
    for attribute in attributes_of(message):
        if len(found) >= FACTS_MAX or (not prefix and attribute == "header"):
            continue
        name, value = f"{prefix}{attribute.rstrip('_')}", getattr(message, attribute)
        if not isinstance(value, MessageValue):
            found.append(_fact_of(name, value))
        elif (whole := _whole(name, value)) is not None:
            found.append(whole)
        elif depth < _DEPTH_MAX:
            _collect(value, f"{name}.", found, depth + 1)


def _whole(name: str, value: MessageValue) -> Fact | None:
    """Return the fact of a message that is one value: a vector, a turn, a colour or a time."""
    parts = attributes_of(value)
    if parts == ("x", "y", "z"):
        kind: FactKind = (
            "position" if name.rpartition(".")[2] in {"position", "point"} else "vector"
        )
        return numbers_fact(name, (value.x, value.y, value.z), kind=kind)
    if parts == ("x", "y", "z", "w"):
        return numbers_fact(name, (value.x, value.y, value.z, value.w), kind="orientation")
    if parts == ("r", "g", "b", "a"):
        return numbers_fact(name, (value.r, value.g, value.b, value.a), kind="colour")
    if parts == ("sec", "nanosec"):
        return Fact(name, f"{value.sec}.{value.nanosec:09d}", "s")
    return None


def _fact_of(name: str, value: object) -> Fact:
    match value:
        case bool() | int():
            return Fact(name, value)
        case float():
            return number_fact(name, value)
        case str():
            return Fact(name, value[:_TEXT_MAX])
        case np.ndarray():
            return _array_fact(name, cast("NDArray[Any]", value))
        case Sequence():
            return Fact(name, f"[{len(cast('Sequence[object]', value)):,}]")
        case _:
            return Fact(name, str(value)[:_TEXT_MAX])


def _array_fact(name: str, numbers: NDArray[Any]) -> Fact:
    if 0 < len(numbers) <= _NUMBERS_MAX and numbers.dtype.kind in "iuf":
        return numbers_fact(name, numbers.tolist())
    return Fact(name, f"[{len(numbers):,}]")


def box_of(shapes: Mapping[str, Shape]) -> Box | None:
    """Return a box, in the axes of their frame, around all of some shapes.

    None when that is not known here: a mesh is as large as its file says.
    """
    parts: list[NDArray[np.float64]] = []
    for shape in shapes.values():
        places = _places_of(shape)
        if places is None:
            return None
        parts.append(places)
    places = np.concatenate(parts) if parts else np.empty((0, 3))
    return box_around(places)


def box_around(places: NDArray[np.floating]) -> Box | None:
    """Return a box around places, shape (N, 3), m; None if none of them is finite."""
    finite = places[np.isfinite(places).all(axis=1)].astype(np.float64)
    if not len(finite):
        return None
    low, high = finite.min(axis=0), finite.max(axis=0)
    return box_at((low + high) / 2, high - low)


def box_at(
    middle: Iterable[float], size_m: Iterable[float], wxyz: Iterable[float] = NO_TURN
) -> Box:
    """Return a box of plain numbers; what is flat gets an edge of 2 mm, so that it is seen."""
    x, y, z = map(float, middle)
    long, wide, high = (max(abs(float(one)), _LEAST_M) for one in size_m)
    w, i, j, k = map(float, wxyz)
    return Box((x, y, z), (long, wide, high), (w, i, j, k))


def _places_of(shape: Shape) -> NDArray[np.float64] | None:
    """Return places that a shape reaches to, shape (N, 3); None: it is not known here."""
    match shape:
        case Points():
            found = _grown(shape.positions, shape.size_m)
        case Lines():
            found = _grown(shape.ends.reshape(-1, 3), shape.width_m)
        case Arrows():
            found = _grown(shape.ends.reshape(-1, 3), shape.head_diameter_m)
        case Axes():
            found = _of_axes(shape)
        case Solids():
            found = _of_solids(shape)
        case Triangles():
            found = shape.vertices.astype(np.float64)
        case Text():
            found = np.array([shape.position])
        case Picture() | Frustum():
            found = _of_picture(shape)
        case _:
            found = None
    return found


def _grown(places: NDArray[np.floating], size_m: float) -> NDArray[np.float64]:
    return np.concatenate([places - size_m / 2, places + size_m / 2]).astype(np.float64)


def _of_axes(shape: Axes) -> NDArray[np.float64]:
    tips = [
        shape.positions + turned(shape.wxyz.astype(np.float64), shape.length_m * axis)
        for axis in np.eye(3)
    ]
    return np.concatenate([shape.positions.astype(np.float64), *tips])


def _of_solids(shape: Solids) -> NDArray[np.float64]:
    low, high = (0.0, 1.0) if shape.kind == "cone" else (-0.5, 0.5)
    corners = np.array([(x, y, z) for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (low, high)])
    wxyz = shape.wxyz.astype(np.float64)
    return np.concatenate(
        [shape.positions + turned(wxyz, corner * shape.scales) for corner in corners]
    ).astype(np.float64)


def _of_picture(shape: Picture | Frustum) -> NDArray[np.float64]:
    if isinstance(shape, Picture):
        wide, high = shape.size_m
        corners = np.array([(x, y, 0.0) for x in (0.0, wide) for y in (0.0, high)])
        return turned(np.tile(shape.wxyz, (4, 1)), corners) + shape.position
    half_m = shape.far_m * math.tan(shape.fov_y_rad / 2)
    wide = half_m * shape.aspect
    far = [(x * wide, y * half_m, shape.far_m) for x in (-1, 1) for y in (-1, 1)]
    return np.array([(0.0, 0.0, 0.0), *far])
