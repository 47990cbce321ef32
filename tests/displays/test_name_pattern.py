from __future__ import annotations

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.displays.name_pattern import PatternProperty, pattern_of
from studio.errors import DisplayPropertyError

LETTERS = st.text("ab_/1", max_size=8)
ATOMS = st.sampled_from(["a", "b", ".", "[ab]", "[^a]", "_", r"\d", r"\w", r"\/", "[a-b1]", "1"])
PATTERNS = st.recursive(
    ATOMS,
    lambda inner: st.one_of(
        st.tuples(inner, inner).map("".join),
        st.tuples(inner, inner).map("|".join).map("(?:{})".format),
        st.tuples(inner, st.sampled_from(["*", "+", "?", "{2}", "{1,}", "{0,2}", "*?"])).map(
            lambda both: f"({both[0]}){both[1]}"
        ),
        inner.map("^{}".format),
        inner.map("{}$".format),
    ),
    max_leaves=6,
)


@given(PATTERNS, LETTERS)
def test_a_pattern_is_found_where_pythons_finds_it(pattern: str, name: str):
    expected = re.search(pattern, name) is not None
    found = pattern_of("Filter", pattern)
    assert found.is_in(name) == expected
    assert found.is_in(name) == expected


@pytest.mark.parametrize(
    ("pattern", "inside", "outside"),
    [
        ("^(left|right)_wheel$", ["left_wheel", "right_wheel"], ["wheel", "left_wheel_2", ""]),
        ("wheel", ["left_wheel", "wheels"], ["whee", ""]),
        ("", ["", "anything"], []),
        (r"^robot[0-9]+/(base|odom)", ["robot12/base_link"], ["robot/base", "x robot1/base"]),
        (r"a\.b", ["a.b"], ["axb"]),
        ("[]a]", [], ["b"]),
        ("[a-]x", ["-x", "ax"], ["bx"]),
        (r"\S+\s\W", ["ab !"], ["ab!"]),
        (r"[\d_]{2,3}$", ["a_1", "a123"], ["a1"]),
        ("a{0}b", ["b", "ab"], ["a"]),
    ],
)
def test_names_are_chosen_as_std_regex_search_does(
    pattern: str, inside: list[str], outside: list[str]
):
    found = pattern_of("Filter", pattern)
    assert all(found.is_in(name) for name in inside)
    assert not any(found.is_in(name) for name in outside)


@pytest.mark.parametrize(
    "pattern",
    ["(a+)+$", "(a|a)*$", "(a|aa)+$", "(.*a){20}$", ".*.*.*.*.*.*.*.*=$", "((a*)*)*$", "(a?){99}b"],
)
def test_a_pattern_that_keeps_others_busy_for_years_is_quick(pattern: str):
    found = pattern_of("Filter", pattern)
    for length in range(200, 256):
        found.is_in("a" * length + "!")


@pytest.mark.parametrize(
    ("pattern", "says"),
    [
        ("(", "not closed"),
        (")", "not opened"),
        ("a)", "not opened"),
        ("*", "nothing before it"),
        ("a|+", "nothing before it"),
        ("[a", "ends too early"),
        ("\\", "ends too early"),
        ("[b-a]", "range of letters"),
        (r"[\d-z]", "range of letters"),
        (r"[\D]", "within brackets"),
        ("(?=a)", "looks ahead"),
        (r"(a)\1", "not known here"),
        (r"\b", "not known here"),
        ("a{", "count that is none"),
        ("a{,2}", "count that is none"),
        ("a{3,1}", "before it begins"),
        ("a{2,x}", "count that is none"),
        ("a{501}", "repeats too much"),
        ("(a{25}){25}", "repeats too much"),
        ("a{9999}{9999}", "repeats too much"),
        ("(" * 40 + ")" * 40, "too many brackets"),
        ("a" * 201, "200 letters"),
    ],
)
def test_what_is_no_pattern_is_said(pattern: str, says: str):
    with pytest.raises(DisplayPropertyError, match=says):
        pattern_of("Filter (whitelist)", pattern)
    with pytest.raises(DisplayPropertyError, match=r"^Filter \(whitelist\) "):
        PatternProperty("Filter (whitelist)", "text", "", "A pattern.").checked(pattern)


@given(st.text(r"ab()[]{}*+?|^$\.-,0123d", max_size=30), LETTERS)
def test_any_text_is_a_pattern_or_refused(text: str, name: str):
    try:
        pattern = pattern_of("Filter", text)
    except DisplayPropertyError:
        return
    pattern.is_in(name)
