"""A parameter's descriptor in words, as `ros2 param describe` writes it."""

from __future__ import annotations

from typing import Any

from studio.ros.parameters.parameter import ParameterType


def description_lines(descriptor: Any) -> list[str]:  # noqa: ANN401  # of the node's distribution
    """Write a `ParameterDescriptor`; constraints only where there are some."""
    lines = [f"Parameter name: {descriptor.name}", f"  Type: {_type_words(descriptor.type)}"]
    if descriptor.description:
        lines.append(f"  Description: {descriptor.description}")
    constraints = _constraints(descriptor)
    return [*lines, "  Constraints:", *constraints] if constraints else lines


def _type_words(number: int) -> str:
    return ParameterType(number).words if number in set(ParameterType) else f"unknown ({number})"


def _constraints(descriptor: Any) -> list[str]:  # noqa: ANN401
    lines = ["    Read only: true"] if descriptor.read_only else []
    for one in (*descriptor.floating_point_range, *descriptor.integer_range):
        lines += [f"    Min value: {one.from_value}", f"    Max value: {one.to_value}"]
        if one.step:
            lines.append(f"    Step: {one.step}")
    if descriptor.additional_constraints:
        lines.append(f"    Additional constraints: {descriptor.additional_constraints}")
    return lines
