"""Widgets of values: quantity, unit, kind of widget and range.

Comments decide first, else name, text, value and use.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, replace
from enum import Enum, auto
from functools import lru_cache
from typing import TYPE_CHECKING

from studio.description.syntax.annotations import NOTHING, Annotation
from studio.description.values import Widget, WidgetKind

if TYPE_CHECKING:
    from collections.abc import Iterable


_BOUNDS = frozenset({"min", "max", "minimum", "maximum", "lower", "upper", "limit", "limits"})
_AXES = frozenset({"x", "y", "z", "xyz"})
_CONSTANTS = re.compile(
    r"(?:m_)?pi|half_pi|two_pi|deg(?:rees?)?_?(?:2|to)_?rad(?:ians?)?"
    r"|rad(?:ians?)?_?(?:2|to)_?deg(?:rees?)?",
    re.IGNORECASE,
)
_WORD = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|\d+")
_DEGREE_WORDS = frozenset({"deg", "degs", "degree", "degrees"})
_NUMBER = re.compile(r"\s*[+-]?(\d*)(\.?)(\d*)(?:([eE])([+-]?)(\d+))?\s*")


class Sweep(Enum):
    """How a slider's range follows from the value."""

    POSITIVE = auto()
    """Above 0: from a quarter of the value to four times it."""
    SYMMETRIC = auto()
    """About 0, four times the value to both sides."""
    ANGLE = auto()
    """Half a turn to both sides."""
    FRACTION = auto()
    """From 0 to 1."""
    DIRECTION = auto()
    """From -1 to 1."""
    COUNT = auto()
    """Whole numbers."""
    FREE = auto()
    """A quarter to four times the value, with its sign."""
    CONSTANT = auto()
    """Nature's, not the robot's: pi is not turned."""


@dataclass(frozen=True, slots=True)
class Quantity:
    """A unit as the file has it, and the sweep of its slider."""

    unit: str
    sweep: Sweep


UNKNOWN = Quantity("", Sweep.FREE)
ANGLE = Quantity("rad", Sweep.ANGLE)
DEGREES = Quantity("deg", Sweep.ANGLE)
LENGTH = Quantity("m", Sweep.POSITIVE)
POSITION = Quantity("m", Sweep.SYMMETRIC)
MASS = Quantity("kg", Sweep.POSITIVE)
INERTIA = Quantity("kg m^2", Sweep.POSITIVE)
PRODUCT_OF_INERTIA = Quantity("kg m^2", Sweep.SYMMETRIC)
EFFORT = Quantity("N m", Sweep.POSITIVE)
FORCE = Quantity("N", Sweep.POSITIVE)
ANGULAR_SPEED = Quantity("rad/s", Sweep.POSITIVE)
LINEAR_SPEED = Quantity("m/s", Sweep.POSITIVE)
ANGULAR_ACCELERATION = Quantity("rad/s^2", Sweep.POSITIVE)
POSITIVE = Quantity("", Sweep.POSITIVE)
FRACTION = Quantity("", Sweep.FRACTION)
DIRECTION = Quantity("", Sweep.DIRECTION)
RATIO = Quantity("", Sweep.SYMMETRIC)
COUNT = Quantity("", Sweep.COUNT)
RATE = Quantity("Hz", Sweep.POSITIVE)
CONSTANT = Quantity("", Sweep.CONSTANT)


_BY_ATTRIBUTE: dict[tuple[str, str], Quantity] = {
    ("mass", "value"): MASS,
    ("cylinder", "radius"): LENGTH,
    ("cylinder", "length"): LENGTH,
    ("capsule", "radius"): LENGTH,
    ("capsule", "length"): LENGTH,
    ("sphere", "radius"): LENGTH,
    ("box", "size"): LENGTH,
    ("limit", "lower"): ANGLE,
    ("limit", "upper"): ANGLE,
    ("limit", "effort"): EFFORT,
    ("limit", "velocity"): ANGULAR_SPEED,
    ("safety_controller", "soft_lower_limit"): ANGLE,
    ("safety_controller", "soft_upper_limit"): ANGLE,
    ("safety_controller", "k_position"): POSITIVE,
    ("safety_controller", "k_velocity"): POSITIVE,
    ("calibration", "rising"): ANGLE,
    ("calibration", "falling"): ANGLE,
    ("dynamics", "damping"): POSITIVE,
    ("dynamics", "friction"): POSITIVE,
    ("mimic", "multiplier"): RATIO,
    ("mimic", "offset"): ANGLE,
    ("axis", "xyz"): DIRECTION,
    ("origin", "rpy"): ANGLE,
    ("origin", "xyz"): POSITION,
    ("mesh", "scale"): UNKNOWN,
    ("color", "rgba"): FRACTION,
    ("inertia", "ixx"): INERTIA,
    ("inertia", "iyy"): INERTIA,
    ("inertia", "izz"): INERTIA,
    ("inertia", "ixy"): PRODUCT_OF_INERTIA,
    ("inertia", "ixz"): PRODUCT_OF_INERTIA,
    ("inertia", "iyz"): PRODUCT_OF_INERTIA,
}
"""The numbers of URDF, the most specific about their input first (an inertia is last)."""


NUMBERED_TAGS = frozenset(tag for tag, _ in _BY_ATTRIBUTE)


_PRISMATIC: dict[tuple[str, str], Quantity] = {
    ("limit", "lower"): POSITION,
    ("limit", "upper"): POSITION,
    ("limit", "effort"): FORCE,
    ("limit", "velocity"): LINEAR_SPEED,
    ("safety_controller", "soft_lower_limit"): POSITION,
    ("safety_controller", "soft_upper_limit"): POSITION,
    ("mimic", "offset"): POSITION,
}


_WORDS: dict[Quantity, str] = {
    CONSTANT: "pi halfpi twopi rad2deg deg2rad gravity",
    MASS: "mass weight payload masses",
    LENGTH: (
        "radius diameter length width height thickness depth size wheelbase track clearance "
        "separation spacing distance gap range baseline radii dist len diam reach"
    ),
    POSITION: "offset xyz x y z dx dy dz pos position shift origin translation",
    ANGLE: (
        "rpy roll pitch yaw angle theta tilt rotation orientation heading pan fov hfov vfov "
        "lower upper limit azimuth elevation swing"
    ),
    EFFORT: "effort torque",
    FORCE: "force",
    ANGULAR_SPEED: "velocity vel omega",
    LINEAR_SPEED: "speed",
    ANGULAR_ACCELERATION: "acceleration accel",
    POSITIVE: (
        "friction mu mu1 mu2 damping stiffness k kp kd ki gain gains scale ratio factor "
        "multiplier reduction density jerk voltage"
    ),
    FRACTION: "rgba red green blue opacity transparency color colour brightness",
    INERTIA: "ixx iyy izz inertia",
    PRODUCT_OF_INERTIA: "ixy ixz iyz",
    COUNT: (
        "count num number samples resolution pixels index id port baud channels beams rings "
        "rows columns fps"
    ),
    RATE: "rate frequency hz",
    DIRECTION: "reflect mirror axis sign side direction",
}


_BY_WORD = {word: quantity for quantity, words in _WORDS.items() for word in words.split()}


def in_unit(quantity: Quantity, unit: str) -> Quantity:
    """Return the same quantity in the `unit` of the file."""
    if not unit or unit == quantity.unit:
        return quantity
    if unit in {"deg", "rad"}:
        is_rate = quantity.unit.startswith("rad/")
        return (
            Quantity(quantity.unit.replace("rad", unit), Sweep.POSITIVE)
            if is_rate
            else Quantity(unit, Sweep.ANGLE)
        )
    return Quantity(unit, Sweep.FREE if quantity.sweep is Sweep.ANGLE else quantity.sweep)


def quantity_of_attribute(path: str, attribute: str) -> Quantity | None:
    """Return the quantity of an attribute of URDF; `path` ends in its element's tag.

    A joint that slides is written `joint:prismatic` in the path; others turn.
    """
    key = (path.rpartition("/")[2], attribute)
    if "joint:prismatic" in path and key in _PRISMATIC:
        return _PRISMATIC[key]
    return _BY_ATTRIBUTE.get(key)


def quantity_of_name(name: str) -> Quantity | None:
    """Return the quantity of a value by its name: the last known word decides.

    Dots separate keys of YAML; the last key decides, those above it only when it has no such word,
    except that a position among limits is an angle (`joint_limits.elbow.max_position`).
    """
    last, *above = reversed(name.split("."))
    if _CONSTANTS.fullmatch(last):
        return CONSTANT
    words = _words_of(last)
    found = _quantity_of_words(words)
    if found is POSITION and _BOUNDS.intersection(words):
        found = ANGLE
    if found is None:
        found = next(filter(None, (_quantity_of_words(_words_of(key)) for key in above)), None)
    is_in_degrees = _DEGREE_WORDS.intersection(words)
    return DEGREES if is_in_degrees and found in {ANGLE, None} else found


def _words_of(key: str) -> list[str]:
    return [word.lower() for word in _WORD.findall(key)]


def _quantity_of_words(words: list[str]) -> Quantity | None:
    """Return the last word's quantity: `max_velocity` and `velocity_limit` are both speeds.

    Bounds and axes only count when no other word does: `size_y` is a length.
    """
    weak: Quantity | None = None
    for word in reversed(words):
        quantity = _BY_WORD.get(word)
        if quantity is not None and word not in _BOUNDS | _AXES:
            return _specified(quantity, words)
        weak = weak or quantity
    return weak


def _specified(quantity: Quantity, words: list[str]) -> Quantity:
    """Refine a quantity: a velocity is a joint's unless called linear; `k_position` is a gain."""
    if "k" in words:
        return POSITIVE
    return LINEAR_SPEED if quantity is ANGULAR_SPEED and "linear" in words else quantity


@lru_cache(maxsize=1024)
def quantity_of(name: str, consumers: tuple[tuple[str, str], ...]) -> Quantity:
    """Return the quantity of a value: by its name, else by the most specific attribute it sets."""
    named = quantity_of_name(name)
    used = {key: found for key in consumers if (found := quantity_of_attribute(*key)) is not None}
    if named is not None and not (named is UNKNOWN and used):
        return _refined(named, set(used.values()))
    order = list(_BY_ATTRIBUTE)
    ranked = sorted(used, key=lambda key: order.index((key[0].rpartition("/")[2], key[1])))
    return used[ranked[0]] if ranked else UNKNOWN


def _refined(named: Quantity, used: set[Quantity]) -> Quantity:
    """Let its use decide what a name leaves open: an offset that only turns is an angle."""
    if not used or named in used:
        return named
    loose = {POSITION: ANGLE, ANGLE: POSITION, ANGULAR_SPEED: LINEAR_SPEED, EFFORT: FORCE}
    other = loose.get(named)
    return other if other is not None and used == {other} else named


def parse_number(text: str) -> float | None:
    """Return a text's finite number; None for anything else (inf, nan and `1_000`, too)."""
    if "_" in text:
        return None
    try:
        number = float(text)
    except ValueError:
        return None
    return number if math.isfinite(number) else None


def decimals_of(text: str) -> int:
    """Digits behind the decimal point of a number as written; an exponent shifts the point."""
    number = _NUMBER.fullmatch(text)
    if number is None:
        return 0
    exponent = int(f"{number[5]}{number[6]}") if number[4] else 0
    return max(0, len(number[3]) - exponent)


_EXPRESSION = re.compile(r"\$[{(]")
_INTEGER = re.compile(r"\s*[+-]?\d+\s*")
_BOOLEANS = frozenset({"true", "false"})
_STEPS_ACROSS = 100
"""A slider has at least that many steps, so that a pixel of it is about one step."""
_VECTOR_LENGTH = 16
_NO_LENGTH_M = 1e-5
"""Calibrations leave lengths such as 2e-11 m where a zero is meant."""


def infer_widget(
    name: str,
    text: str,
    value: str = "",
    annotation: Annotation = NOTHING,
    consumers: tuple[tuple[str, str], ...] = (),
    compared: Iterable[str] = (),
) -> Widget:
    """Choose the widget of a value.

    Args:
        name: The name; keys of YAML joined by dots.
        text: As written. An expression keeps the range of its value.
        value: Value in the last run; empty when it was not read.
        annotation: Of its comments; a range or choices there win.
        consumers: (element path, attribute) pairs of URDF that it affects.
        compared: Texts that conditions compare it with.
    """
    quantity = in_unit(quantity_of(name, consumers), annotation.unit)
    unit = quantity.unit
    is_expression = _EXPRESSION.search(text) is not None
    shown = value if is_expression or (value and not text.strip()) else text
    if (annotated := _annotated(annotation, unit, shown)) is not None:
        return annotated
    if not is_expression and shown.strip().lower() in _BOOLEANS:
        return Widget(WidgetKind.SWITCH, help=annotation.help)
    numbers = _numbers(shown)
    if numbers and quantity.sweep is not Sweep.CONSTANT:
        return _turned(
            numbers, shown, quantity, Widget(WidgetKind.TEXT, unit=unit, help=annotation.help)
        )
    choices = () if numbers else _choices(shown, compared)
    kind = WidgetKind.CHOICE if choices else WidgetKind.TEXT
    return Widget(kind, choices=choices, help=annotation.help)


def keep_range(widget: Widget, before: Iterable[Widget], shown: str) -> Widget:
    """Leave an inferred range as it was while the value stays in it: a drag must not move it.

    The first widget of `before` whose range holds the value `shown` gives it.
    """
    numbers = _numbers(shown)
    for earlier in before:
        same = (widget.kind, widget.unit, widget.annotated) == (earlier.kind, earlier.unit, False)
        low, high = earlier.minimum, earlier.maximum
        if not same or low is None or high is None:
            continue
        if all(low <= number <= high for number in numbers):
            return replace(widget, minimum=low, maximum=high, step=earlier.step)
    return widget


def _annotated(annotation: Annotation, unit: str, shown: str) -> Widget | None:
    """Return the comment's widget: choices, else a range, of a vector where the value is one."""
    if annotation.choices:
        given, unit = annotation.choices, annotation.unit
        return Widget(
            WidgetKind.CHOICE, unit=unit, choices=given, help=annotation.help, annotated=True
        )
    if annotation.minimum is None:
        return None
    low, high = annotation.minimum, annotation.maximum or 0.0
    kind = WidgetKind.VECTOR if len(_numbers(shown)) > 1 else WidgetKind.SLIDER
    whole = all(_INTEGER.fullmatch(word) for word in shown.split()) and bool(shown.split())
    whole = whole and low.is_integer() and high.is_integer() and high - low >= 2
    step = annotation.step or (1.0 if whole else _step_across(high - low))
    return Widget(kind, low, high, step, unit, help=annotation.help, annotated=True)


def _numbers(shown: str) -> list[float]:
    """Return the numbers that a text consists of; none when anything else is in it."""
    words = shown.split()
    if len(words) > _VECTOR_LENGTH:
        return []
    numbers = [number for word in words if (number := parse_number(word)) is not None]
    turnable = all(not number or 1e-30 < abs(number) < 1e30 for number in numbers)
    return numbers if len(numbers) == len(words) and turnable else []


def _choices(shown: str, compared: Iterable[str]) -> tuple[str, ...]:
    """Return the value and the texts compared with it, unless those are empty or numbers."""
    words = [word for word in compared if word and parse_number(word) is None]
    words = [word for word in words if word.lower() not in _BOOLEANS]
    if not words:
        return ()
    return tuple(dict.fromkeys([*([shown] if shown else []), *words]))


def _turned(numbers: list[float], shown: str, quantity: Quantity, plain: Widget) -> Widget:
    kind = WidgetKind.SLIDER if len(numbers) == 1 else WidgetKind.VECTOR
    is_whole = all(_INTEGER.fullmatch(word) for word in shown.split())
    low, high, step = _range(numbers, quantity, is_whole=is_whole)
    return Widget(kind, low, high, step, plain.unit, help=plain.help)


def _range(
    numbers: list[float], quantity: Quantity, *, is_whole: bool
) -> tuple[float, float, float]:
    """Minimum, maximum and step for these numbers of that quantity."""
    largest = max(numbers, key=abs)
    is_count = quantity.sweep is Sweep.FREE and not quantity.unit and len(numbers) == 1
    if quantity.sweep is Sweep.COUNT or (is_count and is_whole):
        return _whole(largest)
    if quantity.sweep is Sweep.FRACTION and all(0 <= number <= 1 for number in numbers):
        return 0.0, 1.0, 0.01
    reach = _reach_about_zero(largest, quantity)
    return _quarter_to_four_times(numbers, quantity) if reach is None else _symmetric(reach)


def _reach_about_zero(largest: float, quantity: Quantity) -> float | None:
    """Return how far a slider goes to both sides of 0; None for those that are not about 0."""
    match quantity.sweep:
        case Sweep.ANGLE:
            half_turn = 180.0 if quantity.unit == "deg" else math.pi
            return half_turn * max(1, math.ceil(abs(largest) / half_turn - 1e-9))
        case Sweep.DIRECTION:
            return max(1.0, abs(largest))
        case Sweep.SYMMETRIC:
            is_zero = abs(largest) < (_NO_LENGTH_M if quantity.unit == "m" else 1e-30)
            return 1.0 if is_zero else 4 * abs(largest)
        case _:
            return None


def _quarter_to_four_times(numbers: list[float], quantity: Quantity) -> tuple[float, float, float]:
    smallest, largest = min(numbers), max(numbers)
    if smallest < 0 < largest or not any(numbers):
        reach = 4 * max(-smallest, largest) or 1.0
        is_positive = quantity.sweep is Sweep.POSITIVE and smallest >= 0
        return (0.0, reach, _step_across(reach)) if is_positive else _symmetric(reach)
    low, high = (
        sorted((smallest / 4, smallest * 4)) if largest <= 0 else (smallest / 4, largest * 4)
    )
    step = _step_across(high - low)
    low = low if abs(low) < step else _to_step(low, step)
    if low == 0 and quantity.sweep is Sweep.POSITIVE and smallest > 0:
        low = min(step, smallest)
    return low, _to_step(high, step), step


def _whole(number: float) -> tuple[float, float, float]:
    if not number:
        return -1.0, 1.0, 1.0
    low, high = sorted((number / 4, number * 4))
    return float(math.floor(low)), float(math.ceil(high)), 1.0


def _symmetric(reach: float) -> tuple[float, float, float]:
    step = _step_across(reach)
    digits = max(0, 2 - math.floor(math.log10(reach))) + 2
    reach = round(reach, digits)
    return -reach, reach, step


def _step_across(width: float) -> float:
    """Return the power of ten that makes at least a hundred steps."""
    return float(f"1e{math.floor(math.log10(width / _STEPS_ACROSS) + 1e-9)}")


def _to_step(number: float, step: float) -> float:
    """Return the nearest multiple of a step, without noise."""
    return round(round(number / step) * step, decimals_of(format(step, "g")))
