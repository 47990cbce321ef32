"""Guarded methods do what Python's do, until the work or the result would be too large."""

from __future__ import annotations

from typing import Any

import pytest

from studio.description.expressions.guards import attribute, check_template, checked_format
from studio.description.faults import Refusal

AS_PYTHON: list[tuple[Any, str, tuple[Any, ...]]] = [
    ("a-b", "replace", ("-", "_")),
    ("aaa", "replace", ("a", "b", 2)),
    (", ", "join", (["a", "b"],)),
    ("abcab", "rfind", ("ab",)),
    ("abcab", "rindex", ("ab",)),
    ("a.b.c", "rsplit", (".", 1)),
    ("a.b.c", "rpartition", (".",)),
    (" a ", "strip", ()),
    ("xxa", "lstrip", ("x",)),
    ("axx", "rstrip", ("x",)),
    ("left_arm", "startswith", ("left",)),
    ("left_arm", "endswith", (("_arm", "_leg"),)),
    ("7", "zfill", (3,)),
    ("a", "center", (5, "-")),
    ("a\tb", "expandtabs", (4,)),
    ("A", "lower", ()),
]


@pytest.mark.parametrize(("value", "name", "arguments"), AS_PYTHON)
def test_it_gives_what_python_gives(value: Any, name: str, arguments: tuple[Any, ...]):  # noqa: ANN401
    assert attribute(value, name)(*arguments) == getattr(value, name)(*arguments)
    assert attribute(str, name)(value, *arguments) == getattr(value, name)(*arguments)


def test_lists_and_mappings_change_as_pythons_do():
    items, table = [3, 1], {"a": 1}
    attribute(items, "append")(2)
    attribute(items, "extend")([5])
    attribute(items, "sort")(reverse=True)
    assert items == [5, 3, 2, 1]
    attribute(items, "sort")(key=str)
    assert attribute(items, "pop")(0) == 1
    attribute(table, "update")(b=2)
    assert attribute(table, "setdefault")("c", 3) == 3
    assert table == {"a": 1, "b": 2, "c": 3}
    assert attribute(dict, "fromkeys")("ab", 0) == {"a": 0, "b": 0}


@pytest.mark.parametrize(
    ("value", "name", "arguments"),
    [
        ("a" * 1_000_000, "rfind", ("a" * 500_000,)),
        ("a" * 1_000_000, "strip", ("b" * 500_000,)),
        ("a" * 1_000_000, "startswith", (("b" * 500, "c" * 500),)),
        ("a" * 10_000, "replace", ("a", "b" * 1_000)),
        ("a" * 10_000, "join", (["b"] * 1_000,)),
        ("a", "ljust", (10**9,)),
        ("\t" * 10_000, "expandtabs", (1_000,)),
        ([1], "extend", (range(1_000_000),)),
        ({}, "update", (dict.fromkeys(range(1_000_000)),)),
    ],
)
def test_what_is_too_large_is_refused(value: Any, name: str, arguments: tuple[Any, ...]):  # noqa: ANN401
    with pytest.raises(Refusal, match="too large"):
        attribute(value, name)(*arguments)


def test_a_method_of_a_type_is_for_its_own_values():
    with pytest.raises(TypeError, match=r"str\.join"):
        attribute(str, "join")(1, ["a"])
    with pytest.raises(Refusal):
        attribute(list, "append")([0], [0] * 1_000_000)


def test_a_list_is_not_sorted_by_any_function():
    with pytest.raises(Refusal, match="sorted"):
        attribute([1], "sort")(key=print)


def test_formats_are_filled_in():
    assert checked_format("{} {a:>4} {b:.2f}")(1, a="x", b=0.5) == "1    x 0.50"
    check_template("%s_%03d", ("a", 7))


@pytest.mark.parametrize("template", ["{0.real}", "{0[0]}", "{0:{1}}", "{0:123456}", "{0:*}"])
def test_a_field_that_is_more_than_a_name_is_refused(template: str):
    with pytest.raises(Refusal):
        checked_format(template)(1, 2)


def test_many_fields_of_a_long_text_are_refused():
    with pytest.raises(Refusal):
        checked_format("{0}" * 1_000)("x" * 10_000)
    with pytest.raises(Refusal):
        check_template("%s" * 1_000, ("x" * 10_000,))
