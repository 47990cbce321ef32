from __future__ import annotations

import argparse

import pytest

from studio.cli.main import shield_values


def parsed(*words: str) -> argparse.Namespace:
    parser = argparse.ArgumentParser()
    parser.add_argument("-1", "--once", action="store_true")
    parser.add_argument("-r", type=float)
    parser.add_argument("values", nargs="*")
    return parser.parse_args(shield_values(words))


@pytest.mark.parametrize(
    "value", ["-1.5", "-2", "-.5", "-1e-3", "-.inf", "-inf", "-nan", "-0x10", "-", "-12 "]
)
def test_numbers_with_a_dash_are_values(value: str):
    assert parsed("/n", "x", value).values[2].strip() == value.strip()


def test_options_stay_options():
    options = parsed("-1", "-r", "-5", "/n")
    assert options.once
    assert options.r == -5
    assert options.values == ["/n"]
    with pytest.raises(SystemExit):
        parsed("-infrared")


def test_all_behind_two_dashes_is_a_value():
    assert parsed("--", "-x", "-1", "-2.5").values == ["-x", "-1", "-2.5"]
