from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.errors import MessageValueError
from studio.ros.types.classes import check_count, dtype_of, keeper
from studio.ros.types.definitions import INTEGERS, FieldType, Shape


def keep(base: str, value: object) -> Any:  # noqa: ANN401
    return keeper("p/msg/T x", FieldType(base, Shape.SEQUENCE))(value)


def test_an_array_of_the_right_type_is_kept_as_it_is():
    given_array = np.zeros(3)
    assert keep("float64", given_array) is given_array


@pytest.mark.parametrize(
    ("base", "value", "kept"),
    [
        ("float64", [1, 2], [1.0, 2.0]),
        ("float64", np.arange(3), [0.0, 1.0, 2.0]),
        ("float32", np.arange(6.0)[::2], [0.0, 2.0, 4.0]),
        ("float64", np.array([1.0], dtype=">f8"), [1.0]),
        ("uint8", b"\x01\xff", [1, 255]),
        ("byte", bytearray(b"\xff"), [255]),
        ("int8", range(3), [0, 1, 2]),
        ("bool", [True, False], [True, False]),
        ("int32", [], []),
        ("string", ("a", "b"), ["a", "b"]),
    ],
)
def test_what_means_the_same_becomes_the_fields_own_type(base: str, value: object, kept: list[Any]):
    result = keep(base, value)
    assert list(result) == kept
    if base != "string":
        assert result.dtype == dtype_of(base)


@pytest.mark.parametrize(
    ("base", "value"),
    [
        ("float64", "12"), ("float64", ["a"]), ("float64", 1.0), ("float64", None),
        ("float64", {"a": 1}), ("float64", [[1.0]]), ("float64", [1.0, [2.0]]), ("float64", [1j]),
        ("int8", [1.5]), ("int8", [128]), ("uint8", [-1]), ("uint64", [2**64]), ("int8", ["1"]),
        ("bool", [1, 0]), ("float64", b"12345678"), ("string", "ab"), ("string", None),
    ],
)  # fmt: skip
def test_what_would_be_sent_wrong_is_refused(base: str, value: object):
    with pytest.raises(MessageValueError, match="p/msg/T x"):
        keep(base, value)


@given(st.sampled_from(sorted(INTEGERS)), st.lists(st.integers(-(2**65), 2**65), max_size=4))
def test_whole_numbers_are_kept_exactly_or_refused(base: str, numbers: list[int]):
    low, high = INTEGERS[base]
    if all(low <= number <= high for number in numbers):
        assert keep(base, numbers).tolist() == numbers
    else:
        with pytest.raises(MessageValueError):
            keep(base, numbers)


@pytest.mark.parametrize(("shape", "count"), [(Shape.ARRAY, 2), (Shape.BOUNDED, 4)])
def test_a_wrong_number_of_values_is_refused(shape: Shape, count: int):
    kind = FieldType("int8", shape, 3)
    check_count("x", kind, 3)
    with pytest.raises(MessageValueError):
        check_count("x", kind, count)
