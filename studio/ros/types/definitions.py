"""Interfaces: messages, services and actions with their fields, and what rosidl derives of them."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING

from studio.errors import InterfaceTextError, UnknownTypeError

if TYPE_CHECKING:
    from collections.abc import Callable

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
EVENT_INFO = "service_msgs/msg/ServiceEventInfo"
DEPTH_MAX = 32
# Values that one message holds at least: the fixed arrays of it, multiplied.
VALUES_MAX = 16_000_000
# Fixed arrays of messages and texts: each place becomes code of its own in the codec.
PLACES_MAX = 4_096


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
    """A service: its request and response."""

    name: str
    request: Message
    response: Message


@dataclass(frozen=True, slots=True)
class Action:
    """An action: its goal, result and feedback."""

    name: str
    goal: Message
    result: Message
    feedback: Message


Interface = Message | Service | Action


def messages_of(interface: Interface) -> tuple[Message, ...]:
    """Return the messages that a text defines, in its order."""
    match interface:
        case Message():
            return (interface,)
        case Service():
            return (interface.request, interface.response)
        case Action():
            return (interface.goal, interface.result, interface.feedback)


_UUID = FieldType("unique_identifier_msgs/msg/UUID")
_TIME = FieldType("builtin_interfaces/msg/Time")


def service_event(service: Service) -> Message:
    """Make the message of a service's introspection topic, `T_Event`."""
    return Message(
        f"{service.name}_Event",
        (
            Field("info", FieldType(EVENT_INFO)),
            Field("request", FieldType(service.request.name, Shape.BOUNDED, 1)),
            Field("response", FieldType(service.response.name, Shape.BOUNDED, 1)),
        ),
    )


def service_as_message(service: Service) -> Message:
    """Return the type that a service's hash is taken of; it is never sent."""
    return Message(
        service.name,
        (
            Field("request_message", FieldType(service.request.name)),
            Field("response_message", FieldType(service.response.name)),
            Field("event_message", FieldType(f"{service.name}_Event")),
        ),
    )


def send_goal_service(action: Action) -> Service:
    """Make the service that asks for a goal."""
    name = f"{action.name}_SendGoal"
    return Service(
        name,
        Message(
            f"{name}_Request",
            (Field("goal_id", _UUID), Field("goal", FieldType(action.goal.name))),
        ),
        Message(
            f"{name}_Response",
            (Field("accepted", FieldType("bool")), Field("stamp", _TIME)),
        ),
    )


def get_result_service(action: Action) -> Service:
    """Make the service that waits for a goal's end."""
    name = f"{action.name}_GetResult"
    return Service(
        name,
        Message(f"{name}_Request", (Field("goal_id", _UUID),)),
        Message(
            f"{name}_Response",
            (
                Field("status", FieldType("int8")),
                Field("result", FieldType(action.result.name)),
            ),
        ),
    )


def feedback_message(action: Action) -> Message:
    """Make the message of an action's feedback topic."""
    return Message(
        f"{action.name}_FeedbackMessage",
        (Field("goal_id", _UUID), Field("feedback", FieldType(action.feedback.name))),
    )


def action_as_message(action: Action) -> Message:
    """Return the type that an action's own hash is taken of; it is never sent."""
    parts = {
        "goal": f"{action.name}_Goal",
        "result": f"{action.name}_Result",
        "feedback": f"{action.name}_Feedback",
        "send_goal_service": f"{action.name}_SendGoal",
        "get_result_service": f"{action.name}_GetResult",
        "feedback_message": f"{action.name}_FeedbackMessage",
    }
    return Message(action.name, tuple(Field(name, FieldType(part)) for name, part in parts.items()))


def check_sizes(message: Message, find: Callable[[str], Message]) -> None:
    """Refuse a type that is part of itself, too deep, or large before a value is in it.

    Raises:
        InterfaceTextError: It is so.
        UnknownTypeError: What it is made of is not known.
    """
    _Walk(find).measure(message, ())


class _Walk:
    """One traversal of a type; what was measured once is not measured again."""

    def __init__(self, find: Callable[[str], Message]) -> None:
        self._find = find
        self._measured: dict[str, tuple[int, int]] = {}

    def measure(self, message: Message, above: tuple[str, ...]) -> tuple[int, int]:
        """Count the values that a message holds at least, and its levels."""
        if message.name in above:
            raise InterfaceTextError(
                message.name, None, f"it is part of itself: {' > '.join([*above, message.name])}"
            )
        if len(above) < DEPTH_MAX and message.name not in self._measured:
            below = (*above, message.name)
            fields = [self._field(message, field, below) for field in message.fields]
            values = 1 + sum(values for values, _ in fields)
            levels = 1 + max((levels for _, levels in fields), default=0)
            self._measured[message.name] = (values, levels)
        values, levels = self._measured.get(message.name, (0, 1))
        if len(above) + levels > DEPTH_MAX:
            raise InterfaceTextError(
                message.name, None, f"messages lie deeper than {DEPTH_MAX} levels"
            )
        if values > VALUES_MAX:
            raise InterfaceTextError(
                message.name, None, f"its arrays hold more than {VALUES_MAX} values"
            )
        return values, levels

    def _field(self, message: Message, field: Field, below: tuple[str, ...]) -> tuple[int, int]:
        kind = field.type
        each, levels = self.measure(self._part(message, field), below) if kind.nested else (1, 0)
        if kind.shape is not Shape.ARRAY:
            return (each if kind.shape is Shape.SINGLE else 1), levels
        if not kind.numeric and kind.count > PLACES_MAX:
            raise InterfaceTextError(
                message.name,
                None,
                f"{field.name} has {kind.count} places, at most {PLACES_MAX} of {kind.base} fit: "
                "use a sequence",
            )
        return each * kind.count, levels

    def _part(self, message: Message, field: Field) -> Message:
        try:
            return self._find(field.type.base)
        except UnknownTypeError as error:
            why = f"cannot be used ({error.reason})" if error.reason else "no known package defines"
            raise UnknownTypeError(
                message.name, f'its field {field.name} is a "{field.type.base}", which {why}'
            ) from None
