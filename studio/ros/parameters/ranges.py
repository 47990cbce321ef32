"""Ranges of parameters: which values a descriptor takes, and why not the others."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from studio.ros.parameters.values import ParameterType

if TYPE_CHECKING:
    from studio.ros.parameters.parameter import Parameter
    from studio.ros.types.classes import MessageValue

_TOLERANCE = 1e-9


def misfit(parameter: Parameter, descriptor: MessageValue) -> str | None:
    """Say in half a sentence why a value is outside the range of a descriptor, None if it is not.

    The ends of a range are always taken; a step counts from its lower end, 0 is none.
    """
    if parameter.type_ is ParameterType.INTEGER and descriptor.integer_range:
        return _integer_misfit(parameter.value, descriptor.integer_range[0])
    if parameter.type_ is ParameterType.DOUBLE and descriptor.floating_point_range:
        return _double_misfit(parameter.value, descriptor.floating_point_range[0])
    return None


def _integer_misfit(value: int, span: MessageValue) -> str | None:
    if value in (span.from_value, span.to_value):
        return None
    if not span.from_value <= value <= span.to_value:
        return f"{value} is not from {span.from_value} to {span.to_value}"
    if span.step and (value - span.from_value) % span.step:
        return f"{value} is no step of {span.step} from {span.from_value}"
    return None


def _double_misfit(value: float, span: MessageValue) -> str | None:
    if _close(value, span.from_value) or _close(value, span.to_value):
        return None
    if not span.from_value <= value <= span.to_value:
        return f"{value:g} is not from {span.from_value:g} to {span.to_value:g}"
    steps = (value - span.from_value) / span.step if span.step > 0 else math.inf
    if math.isfinite(steps) and not _close(value, span.from_value + round(steps) * span.step):
        return f"{value:g} is no step of {span.step:g} from {span.from_value:g}"
    return None


def _close(one: float, other: float) -> bool:
    return math.isclose(one, other, rel_tol=_TOLERANCE, abs_tol=_TOLERANCE)
