"""Guarded functions do what Python's do, within bounds, and calls that they make are counted."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import pytest

from studio.description.expressions.bounds import Budget, Limits
from studio.description.expressions.symbols import (
    MATH,
    bounded_range,
    bounded_round,
    bounded_sum,
    counted_functions,
    tokenize,
)
from studio.description.faults import Refusal

if TYPE_CHECKING:
    from collections.abc import Callable


def functions(calls: int = 1_000) -> dict[str, Any]:
    return counted_functions(Budget(Limits(evaluations=calls)).steps)


def test_they_give_what_python_gives():
    assert bounded_range(1, 9, 3) == range(1, 9, 3)
    assert bounded_round(2.567, 1) == 2.6
    assert bounded_sum([1, 2.5]) == 3.5
    assert bounded_sum([[1], [2]], [0]) == [0, 1, 2]
    assert MATH["factorial"](5) == 120
    assert MATH["prod"]([2, 3], start=4) == 24
    assert MATH["lcm"](4, 6) == 12
    assert MATH["pi"] == math.pi
    assert tokenize("a, b;c") == ["a", "b", "c"]
    assert tokenize("a,,b", ",", skip_empty=False) == ["a", "", "b"]


def test_functions_of_functions_give_what_python_gives():
    made = functions()
    assert list(made["map"](max, [1, 5], [3, 4])) == [3, 5]
    assert list(made["filter"](None, [0, 1])) == [1]
    assert made["sorted"]([2, -3], key=abs) == [2, -3]
    assert made["max"](1, -3, key=abs) == -3
    assert made["min"]([], default=7) == 7


@pytest.mark.parametrize(
    ("name", "arguments", "named"),
    [
        ("map", (abs, range(100_000)), {}),
        ("filter", (abs, range(100_000)), {}),
        ("sorted", (range(100_000),), {"key": abs}),
        ("min", (range(100_000),), {"key": abs}),
    ],
)
def test_every_call_is_counted(name: str, arguments: tuple[Any, ...], named: dict[str, Any]):
    made = functions()
    with pytest.raises(Refusal, match="1,000 expressions"):
        list(made[name](*arguments, **named))


@pytest.mark.parametrize(
    "call",
    [
        lambda: bounded_range(10**6),
        lambda: bounded_range(0, 10**30, 10**29),
        lambda: bounded_round(5, -(10**9)),
        lambda: bounded_sum([[0] * 100] * 1_000, []),
        lambda: MATH["factorial"](171),
        lambda: MATH["comb"](1_000, 500),
        lambda: MATH["prod"]([2**1000] * 9),
        lambda: MATH["lcm"](*(n**300 for n in range(2, 50))),
    ],
)
def test_what_is_too_large_is_refused(call: Callable[[], object]):
    with pytest.raises(Refusal, match="too large"):
        call()


def test_separators_are_characters_and_no_pattern():
    with pytest.raises(Refusal, match="separators"):
        tokenize("aaa", "x]|(?:a|a)*b|[y")
