"""Numbers keep the style of their file."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.description.syntax.number_text import decimals_of, format_number, parse_number

NUMBERS = st.floats(-1e9, 1e9).map(lambda value: round(value, 9))


@pytest.mark.parametrize(
    ("value", "like", "step", "written"),
    [
        (0.12, "0.10", None, "0.12"),
        (0.1, "0.12", None, "0.10"),
        (0.1 + 0.2, "0.1", None, "0.3"),
        (0.1 + 0.2, "0.10", 0.01, "0.30"),
        (4.0, "3", 1.0, "4"),
        (4.5, "3", None, "4.5"),
        (0.105, "0.1", 0.005, "0.105"),
        (0.1234567, "0.1", 0.05, "0.12"),
        (0.123, "0.1", None, "0.123"),
        (2e-3, "1e-3", None, "2e-3"),
        (2.5e-3, "1E-03", None, "2.5E-03"),
        (1000.0, "1e3", None, "1e3"),
        (0.6, ".5", None, ".6"),
        (-0.6, "-.5", None, "-.6"),
        (12.0, "3.", None, "12."),
        (-0.0, "1.0", None, "0.0"),
        (1e-9, "0.1", None, "0.000000001"),
        (1e-20, "0.1", None, "1e-20"),
        (1e22, "1", None, "1e22"),
        (2.0, "${x}", 0.01, "2"),
        (math.pi, "3.14", None, "3.14159265359"),
        (100.0, "90.0", 1.0, "100.0"),
        (0.25, "", 0.05, "0.25"),
    ],
)
def test_a_number_is_written_as_its_file_writes_numbers(
    value: float, like: str, step: float | None, written: str
):
    assert format_number(value, like, step) == written


@given(NUMBERS, st.sampled_from(["1", "0.10", "1e-3", ".5", "3.", "-2.250", "${a}", ""]))
def test_a_written_number_is_read_back_to_twelve_digits(value: float, like: str):
    read = parse_number(format_number(value, like))
    assert read is not None
    assert math.isclose(read, value, rel_tol=1e-11, abs_tol=1e-15)


@given(st.integers(-10_000, 10_000), st.sampled_from(["0.10", "1", "0.125"]))
def test_multiples_of_a_step_never_show_noise(multiple: int, like: str):
    written = format_number(multiple * 0.005, like, 0.005)
    assert decimals_of(written) <= 3


@pytest.mark.parametrize("value", [math.inf, -math.inf, math.nan])
def test_what_is_no_number_is_refused(value: float):
    with pytest.raises(ValueError, match="no number"):
        format_number(value, "1")


@pytest.mark.parametrize("text", ["", "x", "inf", "nan", "1_000", "0x10", "1 2", "1e999"])
def test_only_finite_numbers_as_people_write_them_are_numbers(text: str):
    assert parse_number(text) is None


@pytest.mark.parametrize(
    ("text", "decimals"), [("1", 0), ("0.10", 2), ("1e-3", 3), ("1.5e-3", 4), ("1e3", 0), ("x", 0)]
)
def test_decimals_are_counted_as_written(text: str, decimals: int):
    assert decimals_of(text) == decimals
