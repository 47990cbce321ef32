"""Paths to a number in a message: `.pose.position.x`, `.ranges[3]`, `.orientation.@yaw.@deg`.

They are those of the page's plots. What stands behind an `@` is worked out: the length of a vector
or a list, an angle in another unit, the angle of a quaternion about an axis (rad, as tf2 names
them).
"""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING, Any, Final, NamedTuple, cast

import numpy as np

from studio.errors import FieldPathError
from studio.ros.types.classes import MessageValue, attribute_name, attributes_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

ANGLES: Final = ("roll", "pitch", "yaw")
NORM_ITEMS: Final = 64
"""So many values of a list count for its norm."""
_STEP = re.compile(
    r"\.@(norm|deg|rad|length|roll|pitch|yaw)|\.([A-Za-z_]\w*)|\[(-?\d{1,9})\]", re.A
)


class FieldStep(NamedTuple):
    """Into the field of a name."""

    name: str


class IndexStep(NamedTuple):
    """Into an item of a list; -1 is the last."""

    place: int


class WorkStep(NamedTuple):
    """To what is worked out: `norm`, `deg`, `rad`, `length`, `roll`, `pitch` or `yaw`."""

    work: str


Step = FieldStep | IndexStep | WorkStep


def steps_of(path: str) -> tuple[Step, ...]:
    """Read a path; the dot at its beginning may be left out.

    Raises:
        FieldPathError: It is none.
    """
    text = path.strip()
    if text and text[0] not in ".[":
        text = f".{text}"
    steps: list[Step] = []
    at = 0
    while at < len(text):
        found = _STEP.match(text, at)
        if found is None:
            raise FieldPathError(path, "a path looks like .pose.position.x or .ranges[3]")
        work, name, index = found.groups()
        step = WorkStep(work) if work else FieldStep(name) if name else IndexStep(int(index))
        steps.append(step)
        at = found.end()
    if not steps:
        raise FieldPathError(path, "a path looks like .pose.position.x or .ranges[3]")
    return tuple(steps)


def number_at(message: MessageValue, steps: Iterable[Step]) -> float:
    """Return the number of a message; NaN where it has none. A time or duration is in seconds."""
    value: Any = message
    for step in steps:
        match step:
            case FieldStep(name):
                value = _field(value, name)
            case IndexStep(place):
                value = _item(value, place)
            case WorkStep(work):
                value = _worked(value, work)
    return _number(value)


def _field(value: object, name: str) -> object:
    attribute = attribute_name(name)
    is_there = isinstance(value, MessageValue) and attribute in attributes_of(value)
    return getattr(value, attribute) if is_there else None


def _is_list(value: object) -> bool:
    return isinstance(value, (list, tuple, np.ndarray))


def _item(value: Any, index: int) -> object:  # noqa: ANN401
    is_there = _is_list(value) and -len(value) <= index < len(value)
    return value[index] if is_there else None


def _number(value: Any) -> float:  # noqa: ANN401
    if isinstance(value, MessageValue) and {"sec", "nanosec"} <= {*attributes_of(value)}:
        return _number(value.sec) + _number(value.nanosec) / 1e9
    if isinstance(value, bytes) and len(value) == 1:  # the field of a `byte`
        return float(value[0])
    is_number = isinstance(value, (bool, int, float, np.integer, np.floating, np.bool_))
    return float(cast("float", value)) if is_number else math.nan


def _worked(value: Any, work: str) -> float:  # noqa: ANN401
    match work:
        case "deg":
            return _number(value) * 180 / math.pi
        case "rad":
            return _number(value) * math.pi / 180
        case "length":
            return _length(value)
        case "norm":
            return _norm(value)
        case _:
            return angle_of(work, *(_number(_field(value, axis)) for axis in "xyzw"))


def _length(value: Any) -> float:  # noqa: ANN401
    if isinstance(value, str):
        return len(value.encode("utf-16-le", "surrogatepass")) // 2  # as the page counts letters
    return float(len(value)) if _is_list(value) else math.nan


def _norm(value: Any) -> float:  # noqa: ANN401
    if isinstance(value, MessageValue):
        parts: Sequence[Any] = [getattr(value, name) for name in attributes_of(value)]
    elif _is_list(value):
        parts = value
    else:
        return math.nan
    return math.hypot(*map(_number, parts[:NORM_ITEMS]))


def angle_of(work: str, x: Any, y: Any, z: Any, w: Any) -> Any:  # noqa: ANN401
    """Return an angle of quaternions, rad; of numbers or of arrays of them."""
    with np.errstate(all="ignore"):
        norm = x * x + y * y + z * z + w * w
        if work == "roll":
            return np.arctan2(2 * (w * x + y * z), norm - 2 * (x * x + y * y))
        if work == "yaw":
            return np.arctan2(2 * (w * z + x * y), norm - 2 * (y * y + z * z))
        return np.arcsin(np.clip(np.divide(2 * (w * y - z * x), norm), -1, 1))
