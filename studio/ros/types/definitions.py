"""What a type is made of: fields with their types, constants, and the parts of calls."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

INTEGERS = {
    "byte": (0, 255),
    "char": (0, 255),
    **{f"int{bits}": (-(2 ** (bits - 1)), 2 ** (bits - 1) - 1) for bits in (8, 16, 32, 64)},
    **{f"uint{bits}": (0, 2**bits - 1) for bits in (8, 16, 32, 64)},
}
FLOATS = ("float32", "float64")
STRINGS = ("string", "wstring")
PRIMITIVES = ("bool", *INTEGERS, *FLOATS, *STRINGS)
# The field that rosidl puts into a type without any, one byte on the wire.
DUMMY_FIELD = "structure_needs_at_least_one_member"

Scalar = bool | int | float | str
Literal = Scalar | tuple[Scalar, ...]


class Shape(Enum):
    """How many values a field holds."""

    SINGLE = "single"
    ARRAY = "array"
    BOUNDED = "bounded"
    SEQUENCE = "sequence"


@dataclass(frozen=True, slots=True)
class FieldType:
    """The type of a field.

    `base` is a primitive or the full name of a message, `count` the length of an array or the
    bound of a bounded sequence, `string_bound` the characters of a bounded string; 0 is none.
    """

    base: str
    shape: Shape = Shape.SINGLE
    count: int = 0
    string_bound: int = 0

    @property
    def nested(self) -> bool:
        """Whether the field holds messages."""
        return self.base not in PRIMITIVES

    @property
    def numeric(self) -> bool:
        """Whether the field holds numbers or truth values."""
        return not self.nested and self.base not in STRINGS

    def __str__(self) -> str:
        bound = f"<={self.string_bound}" if self.string_bound else ""
        base = self.base.replace("/msg/", "/") + bound
        match self.shape:
            case Shape.SINGLE:
                return base
            case Shape.ARRAY:
                return f"{base}[{self.count}]"
            case Shape.BOUNDED:
                return f"{base}[<={self.count}]"
            case Shape.SEQUENCE:
                return f"{base}[]"


@dataclass(frozen=True, slots=True)
class Field:
    """A field; `comment` is what stands above it or behind it in the text."""

    name: str
    type: FieldType
    default: Literal | None = None
    comment: str = ""


@dataclass(frozen=True, slots=True)
class Constant:
    """A named value of a type."""

    name: str
    base: str
    value: Scalar
    comment: str = ""


@dataclass(frozen=True, slots=True)
class Message:
    """A message, or the request, goal and so on of a call, by its full name."""

    name: str
    fields: tuple[Field, ...] = ()
    constants: tuple[Constant, ...] = ()
    comment: str = ""

    def needs(self) -> set[str]:
        """Name the messages that fields are made of."""
        return {field.type.base for field in self.fields if field.type.nested}


@dataclass(frozen=True, slots=True)
class Service:
    """A service: what is asked and what is answered."""

    name: str
    request: Message
    response: Message


@dataclass(frozen=True, slots=True)
class Action:
    """An action: what is wished, what comes at the end and what meanwhile."""

    name: str
    goal: Message
    result: Message
    feedback: Message


Interface = Message | Service | Action


def messages_of(interface: Interface) -> tuple[Message, ...]:
    """Give the messages that a text defines, in its order."""
    match interface:
        case Message():
            return (interface,)
        case Service():
            return (interface.request, interface.response)
        case Action():
            return (interface.goal, interface.result, interface.feedback)
