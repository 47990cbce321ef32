"""Values of parameters: the ten types that ROS 2 has, and which of them a Python value is."""

from __future__ import annotations

from collections.abc import Iterable
from enum import IntEnum
from typing import TYPE_CHECKING, Any, cast

from studio.errors import InvalidParameterTypeError
from studio.ros.types.classes import shown
from studio.ros.types.yaml_texts import read_yaml

if TYPE_CHECKING:
    from collections.abc import Callable

Value = (
    None | bool | int | float | str | list[bytes] | list[bool] | list[int] | list[float] | list[str]
)
INTEGER_MIN, INTEGER_MAX = -(2**63), 2**63 - 1


class ParameterType(IntEnum):
    """What a parameter holds, by the numbers of rcl_interfaces."""

    NOT_SET = 0
    BOOL = 1
    INTEGER = 2
    DOUBLE = 3
    STRING = 4
    BYTE_ARRAY = 5
    BOOL_ARRAY = 6
    INTEGER_ARRAY = 7
    DOUBLE_ARRAY = 8
    STRING_ARRAY = 9

    @classmethod
    def from_parameter_value(cls, value: object) -> ParameterType:
        """Find the type of a value; an empty list is one of bytes, as in rclpy.

        Raises:
            InvalidParameterTypeError: A parameter cannot hold it.
        """
        return type_of("value", value)

    def check(self, value: object) -> bool:
        """Whether a value is of this type; an empty list is of every list's."""
        return _CHECKS[self](plain(value))

    @property
    def words(self) -> str:
        """Name the type as `ros2 param describe` does."""
        return self.name.lower().replace("_", " ")


def type_of(name: str, value: object) -> ParameterType:
    """Find the type of a parameter's value.

    Raises:
        InvalidParameterTypeError: A parameter cannot hold it; `name` is told.
    """
    taken = plain(value)
    for kind, check in _CHECKS.items():
        if check(taken):
            return kind
    if isinstance(taken, int):
        raise InvalidParameterTypeError(name, "whole numbers have at most 64 bits")
    raise InvalidParameterTypeError(
        name,
        f"{shown(value)} is neither true, false, a number, a text nor a list of one kind of these",
    )


def plain(value: object) -> object:
    """Make plain numbers of numpy's, and lists of tuples, arrays and bytes."""
    if isinstance(value, (bytes, bytearray)):
        return [bytes([one]) for one in value]
    if value is None or isinstance(value, (bool, int, float, str)):
        return value
    if hasattr(value, "tolist"):
        return cast("Any", value).tolist()
    if isinstance(value, (dict, set)) or not isinstance(value, Iterable):
        return cast("object", value)
    return [_plain_item(one) for one in cast("Iterable[object]", value)]


def read_value(text: str) -> Value:
    """Read a value as `ros2 param set` does: what is no number, truth value or list is a text.

    Raises:
        InvalidParameterTypeError: It is a number that is too large.
    """
    try:
        value = read_yaml(text)
    except ValueError:
        return text
    if value is None or not _is_known(value) or value == []:
        _check_integer(text, value)
        return text
    return value


def _check_integer(text: str, value: object) -> None:
    if isinstance(value, int):
        type_of(text, value)


def _plain_item(item: object) -> object:
    return item if isinstance(item, (bytes, str)) else plain(item)


def _is_known(value: object) -> bool:
    return any(check(value) for check in _CHECKS.values())


def _is_integer(value: object) -> bool:
    return (
        isinstance(value, int)
        and not isinstance(value, bool)
        and INTEGER_MIN <= value <= INTEGER_MAX
    )


def _is_byte(value: object) -> bool:
    return isinstance(value, bytes) and len(value) == 1


def _is_bool(value: object) -> bool:
    return isinstance(value, bool)


def _is_double(value: object) -> bool:
    return isinstance(value, float)


def _is_text(value: object) -> bool:
    return isinstance(value, str)


def _list_of(check: Callable[[object], bool]) -> Callable[[object], bool]:
    def check_list(value: object) -> bool:
        return isinstance(value, list) and all(map(check, cast("list[object]", value)))

    return check_list


_CHECKS: dict[ParameterType, Callable[[object], bool]] = {
    ParameterType.NOT_SET: lambda value: value is None,
    ParameterType.BOOL: _is_bool,
    ParameterType.INTEGER: _is_integer,
    ParameterType.DOUBLE: _is_double,
    ParameterType.STRING: _is_text,
    ParameterType.BYTE_ARRAY: _list_of(_is_byte),
    ParameterType.BOOL_ARRAY: _list_of(_is_bool),
    ParameterType.INTEGER_ARRAY: _list_of(_is_integer),
    ParameterType.DOUBLE_ARRAY: _list_of(_is_double),
    ParameterType.STRING_ARRAY: _list_of(_is_text),
}
