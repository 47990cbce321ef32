"""Ranges of parameters: which values a descriptor takes, and why not the others."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from studio.ros.parameters.values import ParameterType

if TYPE_CHECKING:
    from studio.ros.parameters.parameter import Parameter
    from studio.ros.types.classes import MessageValue

_TOLERANCE = 1e-9


def misfit(parameter: Parameter, descriptor: MessageValue) -> str | None:
    """Say in rclpy's words why a value is outside the range of a descriptor, None if it is not.

    The ends of a range are always taken; a step counts from its lower end, 0 is none.
    """
    if parameter.type_ is ParameterType.INTEGER and descriptor.integer_range:
        return _integer_misfit(parameter, descriptor.integer_range[0])
    if parameter.type_ is ParameterType.DOUBLE and descriptor.floating_point_range:
        return _double_misfit(parameter, descriptor.floating_point_range[0])
    return None


def _integer_misfit(parameter: Parameter, span: MessageValue) -> str | None:
    value, low, high = parameter.value, *_ends(span)
    if value in (low, high):
        return None
    if not low < value < high:
        return f"Parameter {parameter.name} out of range. Min: {low}, Max: {high}, value: {value}"
    if span.step and (value - low) % span.step:
        return (
            f"The parameter value for {parameter.name} is not a valid step. "
            f"Min: {low}, max: {high}, value: {value}, step: {span.step}"
        )
    return None


def _double_misfit(parameter: Parameter, span: MessageValue) -> str | None:
    value, low, high = parameter.value, *_ends(span)
    if _close(value, low) or _close(value, high):
        return None
    if not low < value < high:
        # rclpy has a full stop after "range" for integers alone.
        return f"Parameter {parameter.name} out of range Min: {low}, Max: {high}, value: {value}"
    steps = (value - low) / span.step if span.step > 0 else math.inf
    if math.isfinite(steps) and not _close(value, low + round(steps) * span.step):
        return (
            f"The parameter value for {parameter.name} is not close enough to a valid step. "
            f"Min: {low}, max: {high}, value: {value}, step: {span.step}"
        )
    return None


def _ends(span: MessageValue) -> tuple[Any, Any]:
    """Give the lower end and the upper one, which a descriptor may have in either order."""
    low, high = span.from_value, span.to_value
    return (high, low) if high < low else (low, high)


def _close(one: float, other: float) -> bool:
    return math.isclose(one, other, rel_tol=_TOLERANCE, abs_tol=_TOLERANCE)
