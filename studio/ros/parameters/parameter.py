"""Parameter: a name, a type and a value, as in rclpy and as rcl_interfaces carries them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from enum import IntEnum
from functools import cache
from typing import TYPE_CHECKING, Any, ClassVar, cast

from studio.errors import InvalidParameterTypeError
from studio.ros.messages import shared_types
from studio.ros.types.classes import shown
from studio.ros.types.yaml_texts import read_yaml

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.ros.types.classes import MessageValue
    from studio.ros.types.library import TypeLibrary

Value = (
    None | bool | int | float | str | list[bytes] | list[bool] | list[int] | list[float] | list[str]
)
INTEGER_MIN, INTEGER_MAX = -(2**63), 2**63 - 1
DESCRIPTOR = "rcl_interfaces/msg/ParameterDescriptor"


class ParameterType(IntEnum):
    """Type of a parameter, by the numbers of rcl_interfaces."""

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

    def __str__(self) -> str:
        return f"Type.{self.name}"

    __format__ = object.__format__

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
    def label(self) -> str:
        """Name the type as `ros2 param describe` does."""
        return self.name.lower().replace("_", " ")


def type_of(name: str, value: object) -> ParameterType:
    """Find the type of a parameter's value.

    Raises:
        InvalidParameterTypeError: A parameter cannot hold it; `name` is the parameter's.
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
_FIELDS = {
    ParameterType.BOOL: "bool_value",
    ParameterType.INTEGER: "integer_value",
    ParameterType.DOUBLE: "double_value",
    ParameterType.STRING: "string_value",
    ParameterType.BYTE_ARRAY: "byte_array_value",
    ParameterType.BOOL_ARRAY: "bool_array_value",
    ParameterType.INTEGER_ARRAY: "integer_array_value",
    ParameterType.DOUBLE_ARRAY: "double_array_value",
    ParameterType.STRING_ARRAY: "string_array_value",
}


@dataclass(frozen=True, slots=True)
class ParameterMessages:
    """The message classes of parameters, by the names of rcl_interfaces."""

    Parameter: type[MessageValue]
    ParameterDescriptor: type[MessageValue]
    ParameterEvent: type[MessageValue]
    ParameterValue: type[MessageValue]
    ListParametersResult: type[MessageValue]
    SetParametersResult: type[MessageValue]

    @classmethod
    def of(cls, types: TypeLibrary) -> ParameterMessages:
        """Take the classes of a library."""
        names = cls.__dataclass_fields__
        return cls(*(types.message(f"rcl_interfaces/msg/{name}") for name in names))


@cache
def usual_messages() -> ParameterMessages:
    """Return the classes where no node is at hand: those that programs import."""
    return ParameterMessages.of(shared_types())


def value_message(
    kind: ParameterType, value: Value, messages: ParameterMessages | None = None
) -> MessageValue:
    """Write a value as a `ParameterValue`."""
    made = (messages or usual_messages()).ParameterValue(type=int(kind))
    if kind is ParameterType.BYTE_ARRAY:
        made.byte_array_value = b"".join(cast("list[bytes]", value))
    elif kind is not ParameterType.NOT_SET:
        setattr(made, _FIELDS[kind], value)
    return made


def value_of(name: str, message: MessageValue) -> tuple[ParameterType, Value]:
    """Read a `ParameterValue`.

    Raises:
        InvalidParameterTypeError: Its number is that of no type; `name` is the parameter's.
    """
    try:
        kind = ParameterType(int(message.type))
    except ValueError:
        raise InvalidParameterTypeError(name, f"there is no type {message.type}") from None
    if kind is ParameterType.NOT_SET:
        return kind, None
    value = plain(getattr(message, _FIELDS[kind]))
    if kind is ParameterType.BYTE_ARRAY:
        parts = cast("list[int | bytes]", value)
        return kind, [one if isinstance(one, bytes) else bytes([one]) for one in parts]
    return kind, cast("Value", value)


class Parameter:
    """A parameter's name, type and value; it never changes.

    Attributes:
        value: Plain Python; numbers of numpy and tuples became plain ones and lists.
    """

    Type: ClassVar[type[ParameterType]] = ParameterType
    __slots__ = ("_name", "_type", "_value")

    def __init__(
        self,
        name: str,
        type_: ParameterType | None = None,
        value: Any = None,  # noqa: ANN401  # one of `Value`, or what becomes one
    ) -> None:
        self._name = name
        self._value: Any = plain(value)
        self._type = type_of(name, value) if type_ is None else ParameterType(type_)
        if not self._type.check(value):
            raise InvalidParameterTypeError(name, f"{shown(value)} is no {self._type.label}")

    @property
    def name(self) -> str:
        """The name, its parts joined by dots."""
        return self._name

    @property
    def type_(self) -> ParameterType:
        """The type of the value."""
        return self._type

    @property
    def value(self) -> Any:  # noqa: ANN401  # of the type that the user declared
        """The value, None while it is not set."""
        return self._value

    @classmethod
    def from_parameter_msg(cls, message: MessageValue) -> Parameter:
        """Read a `rcl_interfaces/msg/Parameter`.

        Raises:
            InvalidParameterTypeError: Its type is none.
        """
        kind, value = value_of(message.name, message.value)
        return cls(message.name, kind, value)

    def get_parameter_value(self) -> MessageValue:
        """Return the value as a `rcl_interfaces/msg/ParameterValue`."""
        return value_message(self._type, self._value)

    def to_parameter_msg(self, messages: ParameterMessages | None = None) -> MessageValue:
        """Return a `rcl_interfaces/msg/Parameter`."""
        classes = messages or usual_messages()
        value = value_message(self._type, self._value, classes)
        return classes.Parameter(name=self._name, value=value)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Parameter):
            return NotImplemented
        return (self._name, self._type, self._value) == (other._name, other._type, other._value)

    def __hash__(self) -> int:
        return hash((self._name, self._type))

    def __repr__(self) -> str:
        return f"Parameter({self._name!r}, {self._type.name}, {self._value!r})"
