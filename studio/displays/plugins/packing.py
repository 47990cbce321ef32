"""Drawings of plug-ins as plain values and back; what comes back is checked field by field."""

from __future__ import annotations

import math
from dataclasses import MISSING, fields
from typing import TYPE_CHECKING, Any, Final, TypeAlias, cast, get_args

import numpy as np

from studio.displays.display import Status, TopicRole
from studio.displays.drawing import (
    CameraView,
    GridPlane,
    LinkParts,
    Placed,
    PointStyle,
    Shape,
    SolidKind,
    Triangles,
)
from studio.displays.plugins.requests import (
    PackedGroup,
    PackedProperty,
    PackedRole,
    PackedShape,
    PackedStatus,
)
from studio.displays.properties import Property, PropertyKind
from studio.errors import DisplayError

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from studio.displays.drawing import Drawing

Size: TypeAlias = tuple[int | str, ...]
"""Of an array, with letters for what may be any number; the same letter is the same number."""

SHAPES: Final[dict[str, type[Any]]] = {
    one.__name__: one for one in get_args(Shape) if one not in (CameraView, LinkParts)
}
"""By name, those that a plug-in may draw: the others are of the document's robot or the page's."""
_F4, _U1, _U4 = "float32", "uint8", "uint32"
_ARRAYS: Final[dict[str, tuple[str, tuple[Size, ...]]]] = {
    "positions": (_F4, (("N", 3),)),
    "wxyz": (_F4, (("N", 4),)),
    "ends": (_F4, (("N", 2, 3),)),
    "scales": (_F4, (("N", 3),)),
    "opacities": (_F4, (("N",),)),
    "vertices": (_F4, (("N", 3),)),
    "faces": (_U4, (("F", 3),)),
    "colors": (_U1, ((3,), ("N", 3), ("N", 2, 3))),
    "pixels": (_U1, (("H", "W", 4), ("H", "W"))),
    "palette": (_U1, ((256, 4),)),
    "image": (_U1, (("H", "W", 3),)),
}
"""By the name of a field: its numbers and the sizes that it may have."""
_TUPLES: Final = {"rgb": 3, "position": 3, "scale": 3, "size_m": 2, "wxyz": 4}
_CHOICES: Final[dict[tuple[str, str], tuple[str, ...]]] = {
    ("Points", "style"): get_args(PointStyle),
    ("Solids", "kind"): get_args(SolidKind),
    ("GridLines", "plane"): get_args(GridPlane),
}
_PROPERTY_KINDS: Final = tuple(one for one in get_args(PropertyKind) if one != "marker_server")
"""A server of markers has a client in the studio, which is that of its own display alone."""
_NONE: Final = {"palette", "image", "rgb"}
_TEXT_MAX: Final = 2_000
_FAR: Final = 1e15
_PATH_MAX: Final = 300


class ShapeBook:
    """At the plug-in's end: numbers the shapes of a display, so that each is sent once."""

    def __init__(self) -> None:
        self._known: dict[int, tuple[int, Shape]] = {}
        """By identity: the number of a shape, and the shape, which so stays the same object."""
        self._given = 0

    def pack(self, drawing: Drawing) -> tuple[tuple[PackedGroup, ...], tuple[PackedShape, ...]]:
        """Return a drawing and the shapes in it that are new.

        Raises:
            DisplayError: It holds something that is no shape.
        """
        before, self._known = self._known, {}
        new: list[PackedShape] = []
        groups: list[PackedGroup] = []
        for path, placed in drawing.items():
            numbers: dict[str, int] = {}
            for name, shape in placed.shapes.items():
                known = self._known.get(id(shape)) or before.get(id(shape))
                if known is None:
                    self._given += 1
                    known = self._given, shape
                    new.append(_packed(shape, self._given))
                self._known[id(shape)] = known
                numbers[name] = known[0]
            groups.append(_packed_group(path, placed, numbers))
        return tuple(groups), tuple(new)


def _packed_group(path: str, placed: Placed, numbers: dict[str, int]) -> PackedGroup:
    offset = None if placed.offset is None else (*placed.offset[0], *placed.offset[1])
    return PackedGroup(
        str(path), str(placed.frame), int(placed.stamp_ns), bool(placed.follows),
        bool(placed.turns), None if offset is None else tuple(map(float, offset)), numbers,
    )  # fmt: skip


def _packed(shape: Shape, number: int) -> PackedShape:
    kind = type(shape).__name__
    if SHAPES.get(kind) is not type(shape):
        raise DisplayError(f"A drawing has {kind} in it: its shapes are {', '.join(SHAPES)}.")
    made = {
        one.name: _plain(one.name, getattr(shape, one.name))
        for one in fields(shape)
        if one.name != "items"  # a plug-in's shapes are not selected one by one
    }
    return PackedShape(number, kind, made)


def _plain(name: str, value: object) -> object:
    if name in _ARRAYS and isinstance(value, np.ndarray | list):
        array = np.ascontiguousarray(value, _ARRAYS[name][0])
        return {"size": list(array.shape), "data": array.tobytes()}
    if isinstance(value, np.generic | np.ndarray):
        return cast("object", value.tolist())
    if isinstance(value, tuple | list):
        return [_plain("", one) for one in cast("list[object]", value)]
    return value


class ShapeShelf:
    """At the studio's end: the shapes that a display of a plug-in draws, by their numbers."""

    def __init__(self) -> None:
        self._shapes: dict[int, Shape] = {}

    def unpack(self, groups: tuple[PackedGroup, ...], new: tuple[PackedShape, ...]) -> Drawing:
        """Return the drawing; shapes that were there before are the same objects.

        Raises:
            DisplayError: A shape or a place makes no sense: the sentence names it.
        """
        known = self._shapes | {one.number: unpacked(one) for one in new}
        kept: dict[int, Shape] = {}
        drawing: dict[str, Placed] = {}
        for group in groups:
            shapes: dict[str, Shape] = {}
            for name, number in group.shapes.items():
                if number not in known:
                    raise DisplayError(f'The shape "{name[:60]}" was never sent.')
                shapes[name] = kept[number] = known[number]
            drawing[_path(group.path)] = _placed(group, shapes)
        self._shapes = kept
        return drawing


def _path(path: str) -> str:
    if not path or len(path) > _PATH_MAX:
        raise DisplayError(f"A path of a drawing has 1 to {_PATH_MAX} letters, not {len(path)}.")
    return path


def _placed(group: PackedGroup, shapes: Mapping[str, Shape]) -> Placed:
    offset = None
    if group.offset is not None:
        w, x, y, z, px, py, pz = _numbers("offset", group.path, list(group.offset), 7)
        length = math.hypot(w, x, y, z)
        if length < 1e-6:
            raise DisplayError(f'The offset of "{group.path}" has a quaternion of length 0.')
        offset = (w / length, x / length, y / length, z / length), (px, py, pz)
    stamp_ns = group.stamp_ns
    if not 0 <= stamp_ns < 1 << 63:
        raise DisplayError(f'The stamp of "{group.path}" is no time: {stamp_ns}.')
    return Placed(
        group.frame[:_PATH_MAX], stamp_ns, shapes, group.follows, group.turns, offset=offset
    )


def unpacked(packed: PackedShape) -> Shape:
    """Return a shape.

    Raises:
        DisplayError: A field is not what the shape promises: the sentence names both.
    """
    kind = SHAPES.get(packed.kind)
    if kind is None:
        raise DisplayError(f"There is no shape {packed.kind[:60]}.")
    sizes: dict[str, int] = {}
    values: dict[str, Any] = {}
    for one in fields(kind):
        if one.name in packed.fields:
            given = packed.fields[one.name]
            values[one.name] = _field(packed.kind, one.name, given, one.default, sizes)
    shape = cast("Shape", kind(**values))
    corners = len(shape.vertices) if isinstance(shape, Triangles) else 0
    if isinstance(shape, Triangles) and shape.faces.size and shape.faces.max() >= corners:
        raise DisplayError("The faces of Triangles name a corner that is not among its vertices.")
    return shape


def _field(kind: str, name: str, value: object, default: object, sizes: dict[str, int]) -> object:
    if value is None and name in _NONE:
        return None
    if isinstance(value, dict):
        return _array(kind, name, cast("dict[str, Any]", value), sizes)
    if (kind, name) in _CHOICES:
        if value not in _CHOICES[kind, name]:
            known = ", ".join(_CHOICES[kind, name])
            raise DisplayError(f"{name} of {kind} is one of {known}, not {str(value)[:60]!r}.")
        return value
    if isinstance(value, list):
        numbers = _numbers(name, kind, cast("list[object]", value), _TUPLES.get(name, 3))
        return _coloured(numbers) if name == "rgb" else tuple(numbers)
    return _single(kind, name, value, default)


def _coloured(numbers: list[float]) -> tuple[int, ...]:
    return tuple(min(max(round(one), 0), 255) for one in numbers)


def _single(kind: str, name: str, value: object, default: object) -> object:
    if name in ("text", "uri"):
        if isinstance(value, str):
            return value[:_TEXT_MAX]
        raise DisplayError(f"{name} of {kind} cannot be {str(value)[:60]!r}: it is a text.")
    if isinstance(value, bool) and isinstance(default, bool):
        return value
    if isinstance(value, int | float) and not isinstance(default, bool | str):
        (number,) = _numbers(name, kind, [value], 1)
        return round(number) if name == "cells" else number
    has_default = default is not MISSING
    usual = f", as {default!r}" if has_default and isinstance(default, float | bool) else ""
    raise DisplayError(f"{name} of {kind} cannot be {str(value)[:60]!r}{usual}.")


def _numbers(name: str, kind: str, values: list[object], count: int) -> list[float]:
    numbers = [
        float(one) for one in values if isinstance(one, int | float) and not isinstance(one, bool)
    ]
    if len(numbers) != count or len(values) != count:
        raise DisplayError(f"{name} of {kind} has {count} numbers, not {len(values)}.")
    if not all(math.isfinite(one) and abs(one) < _FAR for one in numbers):
        raise DisplayError(f"{name} of {kind} is NaN, infinite or out of reach.")
    return numbers


def _array(kind: str, name: str, packed: dict[str, Any], sizes: dict[str, int]) -> NDArray[Any]:
    if name not in _ARRAYS:
        raise DisplayError(f"{name} of {kind} takes no array.")
    type_name, allowed = _ARRAYS[name]
    size = tuple(int(one) for one in packed["size"])
    found = next((one for one in allowed if _fits(size, one, sizes)), None)
    if found is None:
        wanted = " or ".join(f"({', '.join(map(str, one))})" for one in allowed)
        raise DisplayError(f"{name} of {kind} has the size {size}, and it may have {wanted}.")
    array = np.frombuffer(packed["data"], type_name).reshape(size)
    if type_name == _F4:
        with np.errstate(all="ignore"):
            bad = int(np.count_nonzero(~(np.abs(array) < _FAR)))
        if bad:
            raise DisplayError(f"{bad:,} numbers in {name} of {kind} are NaN or infinite.")
    return _unit(kind, array) if name == "wxyz" else array


def _unit(kind: str, wxyz: NDArray[Any]) -> NDArray[np.float32]:
    lengths = np.linalg.norm(wxyz, axis=1, keepdims=True)
    if (lengths < 1e-6).any():
        raise DisplayError(f"A quaternion in wxyz of {kind} has the length 0.")
    return (wxyz / lengths).astype(np.float32)


def _fits(size: tuple[int, ...], wanted: Size, sizes: dict[str, int]) -> bool:
    """Whether a size is one that is wanted; letters keep the number that they had first."""
    if len(size) != len(wanted):
        return False
    now = dict(sizes)
    for number, want in zip(size, wanted, strict=True):
        if number != (want if isinstance(want, int) else now.setdefault(want, number)):
            return False
    sizes |= now
    return True


def pack_role(role: TopicRole) -> PackedRole:
    """Return a role as it is sent."""
    return PackedRole(
        str(role.name), tuple(map(str, role.types)), str(role.beside), bool(role.newest_only),
        bool(role.reliable), bool(role.latched), int(role.depth), str(role.elsewhere),
    )  # fmt: skip


def unpack_role(role: PackedRole) -> TopicRole:
    """Return a role as it was meant."""
    return TopicRole(
        role.name, role.types, role.beside, role.newest_only, role.reliable, role.latched,
        min(max(role.depth, 1), 1000), role.elsewhere,
    )  # fmt: skip


def pack_property(one: Property) -> PackedProperty:
    """Return a property as it is sent.

    Raises:
        DisplayPropertyError: Its default is none of its values.
    """
    if one.kind != "fact":
        one.checked(one.default)
    return PackedProperty(
        one.name, one.kind, one.default, one.doc,
        one.low if math.isfinite(one.low) else None,
        one.high if math.isfinite(one.high) else None,
        one.unit, tuple(one.choices), one.when,
    )  # fmt: skip


def unpack_property(one: PackedProperty) -> Property:
    """Return a property as it was meant.

    Raises:
        DisplayError: Its kind is none, or its default is none of its values.
    """
    if one.kind not in _PROPERTY_KINDS:
        kinds = ", ".join(_PROPERTY_KINDS)
        raise DisplayError(f'The property "{one.name[:60]}" has a kind of {kinds}.')
    made = Property(
        one.name[:_PATH_MAX], cast("Any", one.kind), one.default, one.doc[:_TEXT_MAX],
        -math.inf if one.low is None else one.low, math.inf if one.high is None else one.high,
        one.unit[:20], one.choices, one.when,
    )  # fmt: skip
    if made.kind != "fact":
        made.checked(made.default)
    return made


def pack_status(one: Status) -> PackedStatus:
    """Return a status as it is sent."""
    return PackedStatus(one.level, one.sentence, one.mend)


def unpack_status(one: PackedStatus) -> Status:
    """Return a status as it was meant."""
    level = one.level if one.level in ("ok", "warn", "error") else "warn"
    return Status(cast("Any", level), None, one.sentence[:_TEXT_MAX], one.mend)
