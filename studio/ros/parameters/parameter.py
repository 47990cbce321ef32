"""Parameter: a name and a value, made and read as in rclpy."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

from studio.errors import InvalidParameterTypeError
from studio.ros.parameters.messages import (
    ParameterMessages,
    usual_messages,
    value_message,
    value_of,
)
from studio.ros.parameters.values import ParameterType, plain, type_of
from studio.ros.types.classes import shown

if TYPE_CHECKING:
    from studio.ros.types.classes import MessageValue


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
            raise InvalidParameterTypeError(name, f"{shown(value)} is no {self._type.words}")

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
        """Give the value as a `rcl_interfaces/msg/ParameterValue`."""
        return value_message(self._type, self._value)

    def to_parameter_msg(self, messages: ParameterMessages | None = None) -> MessageValue:
        """Give a `rcl_interfaces/msg/Parameter`."""
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
