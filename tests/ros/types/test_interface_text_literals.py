from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.ros.types.definitions import INTEGERS, FieldType, Shape
from studio.ros.types.interface_text import parse_literal, parse_scalar


@pytest.mark.parametrize(
    ("text", "value"), [("0x1F", 31), ("-5", -5), ("+5", 5), ("007", 7), ("0b101", 5), ("0o17", 15)]
)
def test_whole_numbers_come_in_several_forms(text: str, value: int):
    assert parse_scalar(text, FieldType("int32")) == value


@pytest.mark.parametrize(("text", "word"), [('"a\\"b"', 'a"b'), ("'a'", "a"), ("a b", "a b")])
def test_texts_come_with_and_without_quotes(text: str, word: str):
    assert parse_scalar(text, FieldType("string")) == word


def test_lists_may_be_empty():
    assert parse_literal("[ ]", FieldType("int8", Shape.SEQUENCE)) == ()


@given(st.sampled_from(sorted(INTEGERS)), st.integers(-(2**70), 2**70))
def test_a_whole_number_is_taken_where_it_fits_and_nowhere_else(base: str, number: int):
    low, high = INTEGERS[base]
    if low <= number <= high:
        assert parse_scalar(str(number), FieldType(base)) == number
    else:
        with pytest.raises(ValueError, match="does not fit"):
            parse_scalar(str(number), FieldType(base))


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_any_number_survives_its_text(number: float):
    assert parse_scalar(repr(number), FieldType("float64")) == number
