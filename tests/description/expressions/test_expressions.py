"""What may stand in an expression, and what is refused before it is compiled."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.description.expressions.expressions import HELPERS, LENGTH_LIMIT, compile_expression
from studio.description.faults import Fault, Refusal

NAMES: dict[str, Any] = {"a": 3, "b": 2.5, "t": "text", "l": [1, 2], "range": range, "str": str}


def value_of(text: str) -> object:
    return eval(compile_expression(text).code, {**HELPERS, "__steps": iter, **NAMES})


@pytest.mark.parametrize(
    "text",
    [
        "a + b * 2 - 1 / a // 2 % 3",
        "a ** 2 + (a << 3) + -b",
        "t + 'x' * a",
        "'%s has %d' % (t, a)",
        "'{} {n:>5}'.format(t, n=a)",
        "[i * a for i in l if i > 1] + l",
        "{i: t for i in l}[2]",
        "t[1:3].upper()",
        "a if b > 2 and not t == 'q' else l",
        "str(a) in t or a in [3, 4]",
        "(1, *l, a)",
        "1.5e3 + 0x10",
        "{1, 2} | {3}",
    ],
)
def test_an_expression_means_what_python_says(text: str):
    assert value_of(text) == eval(text, dict(NAMES))


@pytest.mark.parametrize(
    "text",
    [
        "().__class__",
        "__import__('os')",
        "t.__len__()",
        "lambda: 1",
        "[y := 1]",
        "f'{t}'",
        "'{0.real}'.format(a)",
        "'{0[0]}'.format(l)",
        "'{:{w}}'.format(a, w=9)",
        "t.format_map(a)",
        "t.encode()",
        "str.mro()",
        "a.to_bytes(9)",
        "(i for i in l).gi_frame",
        "9 ** 9 ** 9",
        "t * 10 ** 9",
        "1 << 10 ** 9",
        "'%99999999d' % 1",
    ],
)
def test_what_could_reach_out_or_grow_is_refused(text: str):
    with pytest.raises(Refusal):
        value_of(text)


@pytest.mark.parametrize("text", ["", "1 +", "a b", "(", "x = 1", "import os", "\0", "-" * 15_000])
def test_what_python_cannot_parse_is_a_fault(text: str):
    with pytest.raises(Fault, match="is not valid"):
        compile_expression(text)


def test_an_expression_may_be_too_long():
    with pytest.raises(Refusal, match="longer"):
        compile_expression("1+" * LENGTH_LIMIT + "1")


def test_a_name_alone_is_known_as_such():
    assert compile_expression(" wheel_radius ").name == "wheel_radius"
    assert compile_expression("a + b").name is None


def test_comparisons_with_texts_are_found():
    text = "type == 'a' or 'b' != type or type in ['c', 'd'] and other == 1"
    assert compile_expression(text).compared == (
        ("type", "a"),
        ("type", "b"),
        ("type", "c"),
        ("type", "d"),
    )


arithmetic = st.recursive(
    st.one_of(st.integers(-9, 9).map(str), st.sampled_from(["a", "b", "1.5"])),
    lambda inner: st.builds("({} {} {})".format, inner, st.sampled_from("+-*/%"), inner),
    max_leaves=8,
)


@given(arithmetic)
def test_guarded_arithmetic_is_arithmetic(text: str):
    try:
        expected = eval(text, dict(NAMES))
    except ZeroDivisionError:
        with pytest.raises(ZeroDivisionError):
            value_of(text)
    else:
        assert value_of(text) == expected


def test_every_operator_that_can_grow_a_value_is_guarded():
    for text in ("a + t", "a * t", "a ** t", "a << t", "a % t"):
        names = compile_expression(text).code.co_names
        assert any(name.startswith("__") for name in names), text
