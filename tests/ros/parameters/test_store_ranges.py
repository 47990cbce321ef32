from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.ros.parameters.parameter import Parameter, usual_messages
from studio.ros.parameters.store import range_violation
from studio.ros.types.library import TypeLibrary

LIBRARY = TypeLibrary("jazzy")
INTEGER_RANGE = LIBRARY.message("rcl_interfaces/msg/IntegerRange")
DOUBLE_RANGE = LIBRARY.message("rcl_interfaces/msg/FloatingPointRange")
DESCRIPTOR = usual_messages().ParameterDescriptor


def integer_misfit(value: int, low: int, high: int, step: int = 0) -> str | None:
    span = INTEGER_RANGE(from_value=low, to_value=high, step=step)
    return range_violation(Parameter("x", value=value), DESCRIPTOR(integer_range=[span]))


def double_misfit(value: float, low: float, high: float, step: float = 0.0) -> str | None:
    span = DOUBLE_RANGE(from_value=low, to_value=high, step=step)
    return range_violation(Parameter("x", value=value), DESCRIPTOR(floating_point_range=[span]))


def test_whole_numbers_keep_to_their_range_and_steps():
    outside = "Parameter x out of range. Min: 0, Max: 255, value: 256"
    assert integer_misfit(256, 0, 255) == outside
    assert integer_misfit(256, 255, 0) == outside
    between = "The parameter value for x is not a valid step. Min: 0, max: 10, value: 4, step: 3"
    assert integer_misfit(4, 0, 10, 3) == between
    assert integer_misfit(9, 0, 10, 3) is None
    assert integer_misfit(10, 0, 10, 3) is None


def test_numbers_keep_to_their_range_and_steps():
    assert double_misfit(1.5, 0.0, 1.0) == "Parameter x out of range Min: 0.0, Max: 1.0, value: 1.5"
    assert double_misfit(0.3, 0.0, 1.0, 0.1) is None
    assert double_misfit(0.35, 0.0, 1.0, 0.1) == (
        "The parameter value for x is not close enough to a valid step. "
        "Min: 0.0, max: 1.0, value: 0.35, step: 0.1"
    )
    outside = "Parameter x out of range Min: 0.0, Max: 1.0, value: nan"
    assert double_misfit(math.nan, 0.0, 1.0) == outside
    assert double_misfit(0.1 + 0.2, 0.0, 0.3) is None


def test_a_range_is_for_its_own_type_alone():
    span = INTEGER_RANGE(from_value=0, to_value=1, step=0)
    assert range_violation(Parameter("x", value=7.5), DESCRIPTOR(integer_range=[span])) is None


@given(st.floats(), st.floats(), st.floats(), st.floats())
def test_no_range_is_too_odd_to_judge(value: float, low: float, high: float, step: float):
    reason = double_misfit(value, low, high, step)
    assert reason is None or reason.startswith(("Parameter x out", "The parameter value for x"))


@pytest.mark.parametrize("step", [0, 1, 2**63, 2**64 - 1])
def test_the_widest_range_takes_its_ends(step: int):
    for end in (-(2**63), 2**63 - 1):
        assert integer_misfit(end, -(2**63), 2**63 - 1, step) is None
