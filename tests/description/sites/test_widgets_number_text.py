"""Numbers as people write them are read, and nothing else is."""

from __future__ import annotations

import pytest

from studio.description.sites.widgets import decimals_of, parse_number


@pytest.mark.parametrize("text", ["", "x", "inf", "nan", "1_000", "0x10", "1 2", "1e999"])
def test_only_finite_numbers_as_people_write_them_are_numbers(text: str):
    assert parse_number(text) is None


@pytest.mark.parametrize(
    ("text", "decimals"), [("1", 0), ("0.10", 2), ("1e-3", 3), ("1.5e-3", 4), ("1e3", 0), ("x", 0)]
)
def test_decimals_are_counted_as_written(text: str, decimals: int):
    assert decimals_of(text) == decimals
