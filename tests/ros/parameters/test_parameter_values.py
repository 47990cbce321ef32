from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.errors import InvalidParameterTypeError
from studio.ros.parameters.parameter import ParameterType, plain, read_value, type_of


@pytest.mark.parametrize(
    ("value", "kind"),
    [
        (None, "NOT_SET"),
        (True, "BOOL"),
        (1, "INTEGER"),
        (1.0, "DOUBLE"),
        ("1", "STRING"),
        (b"\x01\x02", "BYTE_ARRAY"),
        ([], "BYTE_ARRAY"),
        ([True], "BOOL_ARRAY"),
        ((1, 2), "INTEGER_ARRAY"),
        (np.array([1.0, 2.5], dtype=np.float32), "DOUBLE_ARRAY"),
        (np.int64(3), "INTEGER"),
        (["a"], "STRING_ARRAY"),
    ],
)
def test_a_python_value_has_a_type_of_ros(value: object, kind: str):
    assert type_of("x", value).name == kind


@pytest.mark.parametrize("value", [{"a": 1}, [1, "a"], [1, 2.0], [[1]], object(), 2**63, {1}])
def test_what_no_parameter_can_hold_is_refused_by_name(value: object):
    with pytest.raises(InvalidParameterTypeError, match='"speed"'):
        type_of("speed", value)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("-1.5", -1.5),
        ("3", 3),
        ("true", True),
        ("[1, 2]", [1, 2]),
        ("[1, 2.5]", "[1, 2.5]"),
        ("hello: there", "hello: there"),
        ("'5'", "5"),
        ("[", "["),
        ("", ""),
        ("null", "null"),
        ("2024-01-01", "2024-01-01"),
    ],
)
def test_a_command_line_gives_a_value_as_ros2_param_set_reads_it(text: str, value: object):
    assert read_value(text) == value


def test_a_number_beyond_64_bits_is_refused_and_not_made_a_text():
    with pytest.raises(InvalidParameterTypeError, match="64 bits"):
        read_value("9223372036854775808")


@given(st.text())
def test_any_text_is_a_value_or_one_named_error(text: str):
    try:
        value = read_value(text)
    except InvalidParameterTypeError:
        return
    assert type_of("x", value) is not ParameterType.NOT_SET


def test_an_empty_list_is_one_of_any_kind():
    assert ParameterType.DOUBLE_ARRAY.check([])
    assert not ParameterType.DOUBLE.check([])


def test_bytes_are_a_list_of_single_bytes_as_in_rclpy():
    assert plain(b"ab") == [b"a", b"b"]
