"""Parameters as rcl_interfaces carries them, and back."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, cast

from studio.errors import InvalidParameterTypeError
from studio.ros.messages import shared_types
from studio.ros.parameters.values import ParameterType, Value, plain

if TYPE_CHECKING:
    from studio.ros.types.classes import MessageValue
    from studio.ros.types.library import TypeLibrary

DESCRIPTOR = "rcl_interfaces/msg/ParameterDescriptor"
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
    """Give the classes where no node is at hand: those that programs import."""
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
        InvalidParameterTypeError: Its number is that of no type; `name` is told.
    """
    try:
        kind = ParameterType(int(message.type))
    except ValueError:
        raise InvalidParameterTypeError(name, f"there is no type {message.type}") from None
    if kind is ParameterType.NOT_SET:
        return kind, None
    value = plain(getattr(message, _FIELDS[kind]))
    if kind is ParameterType.BYTE_ARRAY:
        return kind, [bytes([one]) for one in cast("list[int]", value)]
    return kind, cast("Value", value)
