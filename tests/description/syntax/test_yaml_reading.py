"""YAML files read: xacro's units, mistakes with their places, nothing without bounds."""

from __future__ import annotations

import math
from typing import Any

import pytest

from studio.description.faults import Fault, Refusal
from studio.description.syntax.yaml_reading import check_aliases, read_yaml


def load(data: bytes) -> Any:  # noqa: ANN401 - whatever the file holds
    return read_yaml("c.yaml", data, float)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("!degrees 180", math.pi),
        ("!radians 1.5", 1.5),
        ("!millimeters 250", 0.25),
        ("!meters 2", 2.0),
        ("!foot 1", 0.3048),
        ("!inches 10", 0.254),
    ],
)
def test_units_are_converted_to_metres_and_radians(text: str, value: float):
    assert load(f"k: {text}".encode())["k"] == pytest.approx(value)


def test_an_empty_file_is_nothing():
    assert load(b"# only a comment\n") is None


def test_a_mistake_is_said_with_its_place():
    with pytest.raises(Fault) as fault:
        load(b"a: 1\nb: [1,\nc: 2}\n")
    assert fault.value.code == "yaml-malformed"
    assert fault.value.place is not None
    assert fault.value.place.line == 3


@pytest.mark.parametrize("data", [b"k: \xff", b"a: 1\n---\nb: 2\n", b"k: !unknown 1"])
def test_what_is_no_yaml_of_ours_is_a_fault(data: bytes):
    with pytest.raises(Fault, match=r"YAML|UTF-8"):
        load(data)


def bomb(levels: int) -> bytes:
    lines = ["a0: &a0 [x]"]
    lines += [f"a{n}: &a{n} [{', '.join([f'*a{n - 1}'] * 9)}]" for n in range(1, levels)]
    return "\n".join(lines).encode()


@pytest.mark.parametrize("data", [bomb(9), b"a: &a [*a]", b"[" * 200 + b"]" * 200])
def test_a_text_that_expands_without_bound_is_refused(data: bytes):
    with pytest.raises(Refusal):
        load(data)
    with pytest.raises(Refusal):
        check_aliases(data)


def test_aliases_within_bounds_are_values():
    assert load(bomb(3))["a1"] == [["x"]] * 9
