"""One `<link>`, `<joint>` or `<material>` of an expanded URDF as a value, read as urdfdom reads it.

What is missing takes urdfdom's default. What is not valid becomes a fault, a RobotError with the
element, the attribute and the text; the sub-element that holds it is left out and the rest of the
element is kept, so that one typing error never hides a robot.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import lru_cache
from typing import TYPE_CHECKING, TypeVar

from studio.errors import RobotError
from studio.robot.values import (
    Box,
    Collision,
    Cylinder,
    Geometry,
    Inertial,
    Joint,
    JointType,
    Limit,
    Link,
    Material,
    Mesh,
    Mimic,
    Origin,
    Sphere,
    Visual,
)

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.description.elements import Element
    from studio.robot.values import Vector3

Value = TypeVar("Value")
_COORDINATE_LIMIT = 1e12


@dataclass(slots=True)
class ParsedElement:
    """The value of an element, None when it has no name or is of no known kind; and its faults."""

    value: Link | Joint | Material | None = None
    faults: list[RobotError] = field(default_factory=list[RobotError])


def read_element(element: Element) -> ParsedElement:
    """Read one top-level element; anything but link, joint, material gives None."""
    parsed = ParsedElement()
    try:
        reader = _READERS.get(element.tag)
        if reader is not None:
            parsed.value = reader(element, parsed)
    except RobotError as error:
        parsed.faults.append(error)
    return parsed


def _attempt(faults: list[RobotError], read: Callable[[], Value], otherwise: Value) -> Value:
    """Return the value of `read`, or `otherwise` with the fault noted."""
    try:
        return read()
    except RobotError as error:
        faults.append(error)
        return otherwise


def _read_link(element: Element, parsed: ParsedElement) -> Link:
    name = _name_of(element)
    where = f'link "{name}"'
    faults = parsed.faults
    visuals = [
        _attempt(faults, lambda one=one, n=n: _read_visual(one, f"{where}, visual {n}"), None)
        for n, one in enumerate(element.elements("visual"), start=1)
    ]
    collisions = [
        _attempt(faults, lambda one=one, n=n: _read_collision(one, f"{where}, collision {n}"), None)
        for n, one in enumerate(element.elements("collision"), start=1)
    ]
    inertial = element.find("inertial")
    return Link(
        name,
        tuple(one for one in visuals if one),
        tuple(one for one in collisions if one),
        None
        if inertial is None
        else _attempt(faults, lambda: _read_inertial(inertial, f"{where}, inertial"), None),
    )


def _read_visual(element: Element, where: str) -> Visual:
    material = element.find("material")
    return Visual(
        _read_origin(element, where),
        _read_geometry(element, where),
        None if material is None else _material_of(material, where),
        element.get("name", ""),
    )


def _read_collision(element: Element, where: str) -> Collision:
    return Collision(
        _read_origin(element, where), _read_geometry(element, where), element.get("name", "")
    )


def _read_inertial(element: Element, where: str) -> Inertial:
    mass = _child(element, "mass", where)
    tensor = element.find("inertia")
    return Inertial(
        _read_origin(element, where),
        _number(mass, "value", where),
        *(
            0.0 if tensor is None else _number(tensor, key, where, 0.0)
            for key in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
        ),
    )


def _read_origin(element: Element, where: str) -> Origin:
    origin = element.find("origin")
    if origin is None:
        return Origin()
    zero = (0.0, 0.0, 0.0)
    return Origin(_vector(origin, "xyz", where, zero), _vector(origin, "rpy", where, zero))


def _read_geometry(element: Element, where: str) -> Geometry:
    geometry = _child(element, "geometry", where)
    for shape in geometry.elements():
        reader = _SHAPES.get(shape.tag)
        if reader is not None:
            return reader(shape, where)
    written = ", ".join(f"<{shape.tag}>" for shape in geometry.elements()) or "nothing"
    raise RobotError(
        f"{where}: its geometry holds {written}: URDF knows box, cylinder, sphere and mesh."
    )


def _read_box(element: Element, where: str) -> Box:
    x, y, z = _vector(element, "size", where)
    return Box((abs(x), abs(y), abs(z)))


def _read_cylinder(element: Element, where: str) -> Cylinder:
    return Cylinder(abs(_number(element, "radius", where)), abs(_number(element, "length", where)))


def _read_sphere(element: Element, where: str) -> Sphere:
    return Sphere(abs(_number(element, "radius", where)))


def _read_mesh(element: Element, where: str) -> Mesh:
    uri = element.get("filename", "").strip()
    if not uri:
        raise RobotError(f"{where}: its mesh has no filename: write which file to show.")
    return Mesh(uri, _vector(element, "scale", where, (1.0, 1.0, 1.0)))


_SHAPES: dict[str, Callable[[Element, str], Geometry]] = {
    "box": _read_box,
    "cylinder": _read_cylinder,
    "sphere": _read_sphere,
    "mesh": _read_mesh,
}


def _read_material(element: Element, parsed: ParsedElement) -> Material:
    name = _name_of(element)
    return _attempt(
        parsed.faults, lambda: _material_of(element, f'material "{name}"'), Material(name)
    )


def _material_of(element: Element, where: str) -> Material:
    color, texture = element.find("color"), element.find("texture")
    return Material(
        element.get("name", ""),
        None if color is None else _read_color(color, where),
        "" if texture is None else texture.get("filename", "").strip(),
    )


def _read_color(element: Element, where: str) -> tuple[float, float, float, float] | None:
    if element.get("rgba") is None:
        return None
    numbers = _numbers(element, "rgba", where)
    if len(numbers) == 3:  # some makers leave alpha out; urdfdom refuses, RViz users expect 1
        numbers = (*numbers, 1.0)
    if len(numbers) != 4:
        raise _wrong(where, element, "rgba", "four numbers from 0 to 1")
    red, green, blue, alpha = (min(1.0, max(0.0, one)) for one in numbers)
    return red, green, blue, alpha


def _read_joint(element: Element, parsed: ParsedElement) -> Joint:
    name = _name_of(element)
    where, faults = f'joint "{name}"', parsed.faults
    limit, mimic = element.find("limit"), element.find("mimic")
    return Joint(
        name,
        _joint_type(element),
        _link_name(element, "parent", where),
        _link_name(element, "child", where),
        _attempt(faults, lambda: _read_origin(element, where), Origin()),
        _attempt(faults, lambda: _read_axis(element, where), (1.0, 0.0, 0.0)),
        None if limit is None else _attempt(faults, lambda: _read_limit(limit, where), None),
        None if mimic is None else _attempt(faults, lambda: _read_mimic(mimic, where), None),
    )


def _joint_type(element: Element) -> JointType:
    """Return the type; one that URDF does not know is drawn fixed, and the checks report it."""
    try:
        return JointType(element.get("type", "").strip())
    except ValueError:
        return JointType.FIXED


def _link_name(element: Element, tag: str, where: str) -> str:
    name = _child(element, tag, where).get("link", "")
    if not name:
        raise RobotError(f'{where}: its <{tag}> has no link: write <{tag} link="..."/>.')
    return name


def _read_axis(element: Element, where: str) -> Vector3:
    axis = element.find("axis")
    default = (1.0, 0.0, 0.0)
    return default if axis is None else _vector(axis, "xyz", where, default)


def _read_limit(element: Element, where: str) -> Limit:
    return Limit(*(_bound(element, key, where) for key in ("lower", "upper", "effort", "velocity")))


def _bound(element: Element, key: str, where: str) -> float:
    """Return a number of any size: many robots write a very large one where they mean no bound."""
    if element.get(key) is None:
        return 0.0
    numbers = _numbers(element, key, where, math.inf)
    if len(numbers) != 1:
        raise _wrong(where, element, key, "one number")
    return numbers[0]


def _read_mimic(element: Element, where: str) -> Mimic:
    leader = element.get("joint", "")
    if not leader:
        raise RobotError(f"{where}: its <mimic> names no joint: write which joint it follows.")
    return Mimic(
        leader,
        _number(element, "multiplier", where, 1.0),
        _number(element, "offset", where, 0.0),
    )


_READERS: dict[str, Callable[[Element, ParsedElement], Link | Joint | Material]] = {
    "link": _read_link,
    "joint": _read_joint,
    "material": _read_material,
}


def _name_of(element: Element) -> str:
    name = element.get("name", "")
    if not name:
        raise RobotError(f"A <{element.tag}> has no name and was left out: give it one.")
    return name


def _child(element: Element, tag: str, where: str) -> Element:
    child = element.find(tag)
    if child is None:
        raise RobotError(f"{where} has no <{tag}>: write one.")
    return child


def _number(element: Element, key: str, where: str, default: float | None = None) -> float:
    if element.get(key) is None and default is not None:
        return default
    numbers = _numbers(element, key, where)
    if len(numbers) != 1:
        raise _wrong(where, element, key, "one number")
    return numbers[0]


def _vector(element: Element, key: str, where: str, default: Vector3 | None = None) -> Vector3:
    if default is not None and element.get(key) is None:
        return default
    numbers = _numbers(element, key, where)
    if len(numbers) != 3:
        raise _wrong(where, element, key, "three numbers separated by blanks")
    return numbers


def _numbers(
    element: Element, key: str, where: str, limit: float = _COORDINATE_LIMIT
) -> tuple[float, ...]:
    """Return the finite numbers of an attribute, each between `-limit` and `limit`.

    Raises:
        RobotError: The attribute is missing, or a part of it is no number.
    """
    written = element.get(key)
    if written is None:
        raise RobotError(f"{where}: <{element.tag}> has no {key}: write one.")
    try:
        numbers, largest = _read_numbers(written)
    except ValueError as error:
        raise _wrong(where, element, key, "numbers") from error
    if not largest < limit:
        raise _wrong(where, element, key, "finite numbers")
    return numbers


@lru_cache(maxsize=4096)
def _read_numbers(written: str) -> tuple[tuple[float, ...], float]:
    """Return numbers between blanks and the largest absolute one, NaN if any is; 0 for none.

    Cached, for most texts of a part stay as they were.

    Raises:
        ValueError: A part is no number.
    """
    if "_" in written or not written.isascii():  # numbers to Python, to no other reader of URDF
        raise ValueError(written)
    numbers = tuple(map(float, written.split()))
    if any(map(math.isnan, numbers)):
        return numbers, math.nan
    return numbers, max(map(abs, numbers), default=0.0)


def _wrong(where: str, element: Element, key: str, wanted: str) -> RobotError:
    written = element.get(key, "")
    shown = written if len(written) <= 60 else f"{written[:57]}..."
    return RobotError(f'{where}: {key} of <{element.tag}> is "{shown}": write {wanted}.')
