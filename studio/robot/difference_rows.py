"""Rows of a comparison: two values of one thing, made only where they really differ."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, TypeAlias

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from studio.robot.values import Origin, Vector3

Value: TypeAlias = float | str | None

_RELATIVE: Final = 1e-6
ABSOLUTE: Final = 1e-9
"""m, rad, kg: a nanometre is rounding in somebody's file."""
TINY: Final = 1e-15
"""kg m^2: a screw has less than a millionth of one."""
AXES: Final = ("x", "y", "z")
_ANGLES: Final = ("roll", "pitch", "yaw")


@dataclass(frozen=True, slots=True)
class Row:
    """One thing that two robots do not have alike; None where one of them has none."""

    what: str
    """E.g. `mass`, `origin.x`, `visual.radius`; `link` or `joint` for a whole one."""
    one: Value
    other: Value
    unit: str = ""
    number: int = 0
    """Which visual or collision of a link, from 1; 0 where it is about none."""


def is_near(one: float, other: float, absolute: float = ABSOLUTE) -> bool:
    """Whether two numbers are the same but for rounding; two that are none are."""
    if math.isnan(one) and math.isnan(other):
        return True
    return math.isclose(one, other, rel_tol=_RELATIVE, abs_tol=absolute)


def number_row(
    what: str, one: float | None, other: float | None, unit: str, absolute: float = ABSOLUTE
) -> Iterator[Row]:
    """A row for a number, where it differs or only one has it."""
    if one is None or other is None:
        if one is not other:
            yield Row(what, one, other, unit)
    elif not is_near(one, other, absolute):
        yield Row(what, one, other, unit)


def vector_rows(
    what: str, one: Sequence[float], other: Sequence[float], unit: str
) -> Iterator[Row]:
    """A row for each of x, y and z that differs."""
    for axis, a, b in zip(AXES, one, other, strict=True):
        yield from number_row(f"{what}.{axis}", a, b, unit)


def text_row(what: str, one: str | None, other: str | None) -> Iterator[Row]:
    """A row for a text, where it differs."""
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
    """The nine numbers of the rotation matrix."""
    (cr, cp, cy), (sr, sp, sy) = map(math.cos, rpy_rad), map(math.sin, rpy_rad)
    return (
        *(cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr),
        *(sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr),
        *(-sp, cp * sr, cp * cr),
    )
