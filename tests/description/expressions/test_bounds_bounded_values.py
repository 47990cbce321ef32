"""Sizes of values: each item counts wherever it is met, up to bounds that robots never reach."""

from __future__ import annotations

from typing import Any

import pytest

from studio.description.expressions.bounds import (
    BITS_LIMIT,
    DEPTH_LIMIT,
    ITEMS_LIMIT,
    SIZE_LIMIT,
    is_lasting,
    made,
    weight,
)
from studio.description.faults import Refusal


def doubled(levels: int) -> list[Any]:
    value: list[Any] = [1]
    for _ in range(levels):
        value = [value, value]
    return value


def nested(levels: int) -> list[Any]:
    value: list[Any] = []
    for _ in range(levels):
        value = [value]
    return value


@pytest.mark.parametrize(
    ("value", "expected"),
    [
        (1, 1),
        ("short", 1),
        ("x" * 640, 11),
        ([], 1),
        ([1, 2], 3),
        ({"a": [1], "b": 2}, 6),
        (doubled(3), 23),
        ({1: 2}.items(), 4),
    ],
)
def test_a_value_weighs_what_is_met_in_it(value: object, expected: int):
    assert weight(value) == expected


@pytest.mark.parametrize(
    "value",
    [
        0.5,
        True,
        None,
        2 ** (BITS_LIMIT - 1),
        "x" * SIZE_LIMIT,
        [0] * (ITEMS_LIMIT - 2),
        nested(DEPTH_LIMIT - 1),
    ],
)
def test_what_is_within_bounds_is_itself(value: object):
    assert made(value) is value


@pytest.mark.parametrize(
    "value",
    [
        2**BITS_LIMIT,
        "x" * (SIZE_LIMIT + 1),
        [0] * ITEMS_LIMIT,
        dict.fromkeys(range(ITEMS_LIMIT)).keys(),
        ("x" * 64_000,) * 20,
        doubled(40),
        nested(DEPTH_LIMIT + 1),
    ],
)
def test_what_is_not_is_refused(value: object):
    with pytest.raises(Refusal, match="too large"):
        made(value)


def test_a_list_that_holds_itself_is_refused():
    value: list[Any] = []
    value.append(value)
    with pytest.raises(Refusal):
        made(value)


def test_a_value_lasts_unless_an_iterator_is_in_it():
    assert all(map(is_lasting, (1, "a", None, [1, (2, {3: {4}})], {"a": 1}.items())))
    held = iter([1])
    for value in (held, [held], ({"a": [held]},), {"a": held}.values(), {held}):
        assert not is_lasting(value)
