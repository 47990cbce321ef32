"""The differences of two robots, number by number, by the names of their links and joints."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final, TypeAlias, TypeVar

from studio.robot.values import Box, Cylinder, JointType, Mesh, Sphere, Visual

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence

    from studio.robot.measures import Bounds, Measures
    from studio.robot.values import (
        Collision,
        Geometry,
        Inertial,
        Joint,
        Limit,
        Link,
        Material,
        Origin,
        Robot,
        Vector3,
    )

Value: TypeAlias = float | str | None

_RELATIVE: Final = 1e-6
ABSOLUTE: Final = 1e-9
"""m, rad, kg: a nanometre is rounding in a file."""
TINY: Final = 1e-15
"""kg m^2: a screw has less than a millionth of one."""
AXES: Final = ("x", "y", "z")
_ANGLES: Final = ("roll", "pitch", "yaw")
_Part = TypeVar("_Part")
_MOMENTS: Final = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
_NO_AXIS: Final = frozenset({JointType.FIXED, JointType.FLOATING})


@dataclass(frozen=True, slots=True)
class Row:
    """One difference between two robots; None where one of them has no such value."""

    what: str
    """E.g. `mass`, `origin.x`, `visual.radius`; `link` or `joint` for a whole one."""
    one: Value
    other: Value
    unit: str = ""
    number: int = 0
    """Which visual or collision of a link, from 1; 0: none."""


def is_near(one: float, other: float, absolute: float = ABSOLUTE) -> bool:
    """Whether two numbers are the same but for rounding; two that are none are."""
    if math.isnan(one) and math.isnan(other):
        return True
    return math.isclose(one, other, rel_tol=_RELATIVE, abs_tol=absolute)


def number_row(
    what: str, one: float | None, other: float | None, unit: str, absolute: float = ABSOLUTE
) -> Iterator[Row]:
    """Yield a row for a number, where it differs or only one has it."""
    if one is None or other is None:
        if one is not other:
            yield Row(what, one, other, unit)
    elif not is_near(one, other, absolute):
        yield Row(what, one, other, unit)


def vector_rows(
    what: str, one: Sequence[float], other: Sequence[float], unit: str
) -> Iterator[Row]:
    """Yield a row for each of x, y and z that differs."""
    for axis, a, b in zip(AXES, one, other, strict=True):
        yield from number_row(f"{what}.{axis}", a, b, unit)


def text_row(what: str, one: str | None, other: str | None) -> Iterator[Row]:
    """Yield a row for a text, where it differs."""
    if one != other:
        yield Row(what, one, other)


def pose_rows(what: str, one: Origin, other: Origin) -> Iterator[Row]:
    """Rows for where a thing is, and for how it is turned where that is another rotation."""
    yield from vector_rows(what, one.xyz, other.xyz, "m")
    if one.rpy == other.rpy or _is_same_turn(one.rpy, other.rpy):
        return
    for angle, a, b in zip(_ANGLES, one.rpy, other.rpy, strict=True):
        yield from number_row(f"{what}.{angle}", a, b, "rad")


def _is_same_turn(one: Vector3, other: Vector3) -> bool:
    """Whether two sets of angles are one rotation: 180 degrees is also -180."""
    if not all(map(math.isfinite, (*one, *other))):
        return False
    pairs = zip(_entries(one), _entries(other), strict=True)
    return all(abs(a - b) < ABSOLUTE for a, b in pairs)


def _entries(rpy_rad: Vector3) -> tuple[float, ...]:
    """Return the nine numbers of the rotation matrix."""
    (cr, cp, cy), (sr, sp, sy) = map(math.cos, rpy_rad), map(math.sin, rpy_rad)
    return (
        *(cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr),
        *(sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr),
        *(-sp, cp * sr, cp * cr),
    )


@dataclass(frozen=True, slots=True)
class Difference:
    """A row and the part that it is about: `link:<name>` or `joint:<name>`."""

    part: str
    row: Row


def differences(one: Robot, other: Robot) -> tuple[Difference, ...]:
    """Return the differences: links, then joints, in the order of `one`, then those of `other`.

    A robot's values are shared between its states: identical objects are skipped.
    """
    parents = _parents(one), _parents(other)

    def link_rows(a: Link, b: Link) -> Iterator[Row]:
        yield from _moved_row(parents[0].get(a.name), parents[1].get(b.name))
        if a is not b and a != b:
            yield from _link_rows(a, b)

    links = _compared("link", one.links, other.links, link_rows, lambda _: "link")
    joints = _compared("joint", one.joints, other.joints, _joint_rows, lambda one: one.type.value)
    return (*links, *joints)


def _compared(
    kind: str,
    one: Mapping[str, _Part],
    other: Mapping[str, _Part],
    rows: Callable[[_Part, _Part], Iterator[Row]],
    label: Callable[[_Part], str],
) -> Iterator[Difference]:
    for name in dict.fromkeys((*one, *other)):
        a, b = one.get(name), other.get(name)
        if a is not None and b is not None:
            for row in rows(a, b):
                yield Difference(f"{kind}:{name}", row)
        else:
            whole = Row(kind, label(a) if a else None, label(b) if b else None)
            yield Difference(f"{kind}:{name}", whole)


def _parents(robot: Robot) -> dict[str, Joint]:
    return {joint.child: joint for joint in robot.joints.values()}


def _moved_row(one: Joint | None, other: Joint | None) -> Iterator[Row]:
    """Yield a row for a link under another parent, unless its joint has the same name."""
    if one is None or other is None or one.name != other.name:
        parents = one.parent if one else None, other.parent if other else None
        yield from text_row("parent", *parents)


def _link_rows(one: Link, other: Link) -> Iterator[Row]:
    yield from _inertial_rows(one.inertial, other.inertial)
    yield from _shapes_rows("visual", one.visuals, other.visuals)
    yield from _shapes_rows("collision", one.collisions, other.collisions)


def _inertial_rows(one: Inertial | None, other: Inertial | None) -> Iterator[Row]:
    masses = one.mass_kg if one else None, other.mass_kg if other else None
    yield from number_row("mass", *masses, "kg")
    if one is None or other is None:
        return
    yield from pose_rows("inertial", one.origin, other.origin)
    for moment in _MOMENTS:
        values = getattr(one, moment), getattr(other, moment)
        yield from number_row(moment, *values, "kg m^2", TINY)


def _shapes_rows(
    what: str,
    one: Sequence[Visual] | Sequence[Collision],
    other: Sequence[Visual] | Sequence[Collision],
) -> Iterator[Row]:
    """Yield shape by shape as they are listed; one that only one robot has is named by its kind."""
    for at in range(max(len(one), len(other))):
        a = one[at] if at < len(one) else None
        b = other[at] if at < len(other) else None
        for row in _shape_rows(what, a, b):
            yield replace(row, number=at + 1)


def _shape_rows(
    what: str, one: Visual | Collision | None, other: Visual | Collision | None
) -> Iterator[Row]:
    if one is None or other is None:
        labels = _label(one.geometry) if one else None, _label(other.geometry) if other else None
        yield Row(what, *labels)
        return
    yield from pose_rows(what, one.origin, other.origin)
    yield from _geometry_rows(what, one.geometry, other.geometry)
    if isinstance(one, Visual) and isinstance(other, Visual):
        yield from text_row(f"{what}.color", _color(one.material), _color(other.material))
        yield from text_row(f"{what}.texture", _texture(one.material), _texture(other.material))


def _geometry_rows(what: str, one: Geometry, other: Geometry) -> Iterator[Row]:
    match one, other:
        case Box(), Box():
            yield from vector_rows(f"{what}.size", one.size_m, other.size_m, "m")
        case Cylinder(), Cylinder():
            yield from number_row(f"{what}.radius", one.radius_m, other.radius_m, "m")
            yield from number_row(f"{what}.length", one.length_m, other.length_m, "m")
        case Sphere(), Sphere():
            yield from number_row(f"{what}.radius", one.radius_m, other.radius_m, "m")
        case Mesh(), Mesh():
            yield from text_row(f"{what}.mesh", one.uri, other.uri)
            yield from vector_rows(f"{what}.scale", one.scale, other.scale, "")
        case _:
            yield from text_row(f"{what}.shape", _label(one), _label(other))


def _label(geometry: Geometry) -> str:
    return type(geometry).__name__.lower()


def _color(material: Material | None) -> str | None:
    if material is None or material.rgba is None:
        return None
    return " ".join(f"{channel:.4g}" for channel in material.rgba)


def _texture(material: Material | None) -> str | None:
    return (material.texture_uri or None) if material else None


def _joint_rows(one: Joint, other: Joint) -> Iterator[Row]:
    if one is other or one == other:
        return
    yield from text_row("type", one.type.value, other.type.value)
    yield from text_row("parent", one.parent, other.parent)
    yield from text_row("child", one.child, other.child)
    yield from pose_rows("origin", one.origin, other.origin)
    if one.type not in _NO_AXIS and other.type not in _NO_AXIS:
        yield from vector_rows("axis", _unit(one.axis), _unit(other.axis), "")
    if one.type is other.type:
        yield from _limit_rows(one.limit, other.limit, slides=one.type is JointType.PRISMATIC)
    leaders = one.mimic.joint if one.mimic else None, other.mimic.joint if other.mimic else None
    yield from text_row("mimic", *leaders)
    if one.mimic and other.mimic:
        yield from number_row("mimic.multiplier", one.mimic.multiplier, other.mimic.multiplier, "")
        yield from number_row("mimic.offset", one.mimic.offset, other.mimic.offset, "")


def _limit_rows(one: Limit | None, other: Limit | None, *, slides: bool) -> Iterator[Row]:
    if one is other:
        return
    length, force, speed = ("m", "N", "m/s") if slides else ("rad", "N m", "rad/s")
    for name, unit in (
        ("lower", length),
        ("upper", length),
        ("effort", force),
        ("velocity", speed),
    ):
        values = getattr(one, name, None), getattr(other, name, None)
        yield from number_row(f"limit.{name}", *values, unit)


def _unit(axis: Vector3) -> Vector3:
    """Return the axis at length 1: only where it points matters."""
    size = math.hypot(*axis)
    return (axis[0] / size, axis[1] / size, axis[2] / size) if 0 < size < math.inf else axis


def whole_rows(one: Measures, other: Measures) -> tuple[Row, ...]:
    """Return the differences between two robots as a whole."""
    rows = [*text_row("name", one.name, other.name)]
    rows += number_row("links", one.links, other.links, "")
    rows += number_row("joints", one.joints, other.joints, "")
    rows += number_row("total_mass", one.mass_kg, other.mass_kg, "kg")
    rows += number_row("reach", one.reach_m, other.reach_m, "m")
    if one.box and other.box:
        rows += vector_rows("size", _size(one.box), _size(other.box), "m")
    return tuple(rows)


def _size(box: Bounds) -> tuple[float, ...]:
    return tuple(high - low for low, high in zip(*box, strict=True))
