"""How a value is best turned: from what its comments say, else from name, text, value and use."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from typing import TYPE_CHECKING

from studio.description.sites.quantities import (
    Quantity,
    Sweep,
    decimals_of,
    in_unit,
    parse_number,
    quantity_of,
)
from studio.description.syntax.annotations import NOTHING, Annotation
from studio.description.values import Widget, WidgetKind

if TYPE_CHECKING:
    from collections.abc import Iterable

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
        name: As it is called; keys of YAML joined by dots.
        text: As written. An expression keeps the range of what it came to.
        value: What it came to in the last run; empty when it was not read.
        annotation: What its comments say; a range or choices there win.
        consumers: (element path, attribute) pairs of URDF that it shapes.
        compared: Texts that conditions compare it with.
    """
    quantity = in_unit(quantity_of(name, consumers), annotation.unit)
    unit = quantity.unit
    is_expression = _EXPRESSION.search(text) is not None
    shown = value if is_expression or (value and not text.strip()) else text
    if annotation.gives_range:
        return _annotated(annotation, unit, shown)
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


def _annotated(annotation: Annotation, unit: str, shown: str) -> Widget:
    """What the comment says; choices over a range, a vector where the value is one."""
    if annotation.choices:
        given, unit = annotation.choices, annotation.unit
        return Widget(
            WidgetKind.CHOICE, unit=unit, choices=given, help=annotation.help, annotated=True
        )
    low, high = annotation.minimum or 0.0, annotation.maximum or 0.0
    kind = WidgetKind.VECTOR if len(_numbers(shown)) > 1 else WidgetKind.SLIDER
    whole = all(_INTEGER.fullmatch(word) for word in shown.split()) and bool(shown.split())
    whole = whole and low.is_integer() and high.is_integer() and high - low >= 2
    step = annotation.step or (1.0 if whole else _step_across(high - low))
    return Widget(kind, low, high, step, unit, help=annotation.help, annotated=True)


def _numbers(shown: str) -> list[float]:
    """The numbers that a text consists of; none when anything else is in it."""
    words = shown.split()
    if len(words) > _VECTOR_LENGTH:
        return []
    numbers = [number for word in words if (number := parse_number(word)) is not None]
    turnable = all(not number or 1e-30 < abs(number) < 1e30 for number in numbers)
    return numbers if len(numbers) == len(words) and turnable else []


def _choices(shown: str, compared: Iterable[str]) -> tuple[str, ...]:
    """The value and what it is compared with; a comparison with nothing or numbers says nothing."""
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
    """How far a slider about 0 goes to both sides; None for those that are not about 0."""
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
    """The power of ten that makes at least a hundred steps."""
    return float(f"1e{math.floor(math.log10(width / _STEPS_ACROSS) + 1e-9)}")


def _to_step(number: float, step: float) -> float:
    """The nearest multiple of a step, without noise."""
    return round(round(number / step) * step, decimals_of(format(step, "g")))
