"""Messages about interfaces: what messages, services and actions are made of."""

from __future__ import annotations

from typing import Literal, TypeAlias

from pydantic import Field

from studio.engine.messages.message import CommandMessage, Message

Value: TypeAlias = bool | int | float | str
NAME_MAX = 300


class GetInterface(CommandMessage):
    """Ask what a type is made of, down to its numbers and texts."""

    type: Literal["get_interface"] = "get_interface"
    name: str = Field(max_length=NAME_MAX)
    """In full: `geometry_msgs/msg/Twist`, `std_srvs/srv/SetBool`."""


class FieldView(Message):
    """One field of a message."""

    name: str
    base: str
    """A primitive, or the full name of a message that is among the answer's."""
    shape: Literal["single", "array", "bounded", "sequence"]
    count: int
    """Length of an array, bound of a bounded sequence; else 0."""
    string_bound: int
    """Characters that a text may have at most; 0: any number."""
    default: Value | tuple[Value, ...] | None
    comment: str


class ConstantView(Message):
    """A named value of a message."""

    name: str
    base: str
    value: Value
    comment: str


class MessageView(Message):
    """A message, or a part of a call."""

    name: str
    fields: tuple[FieldView, ...]
    constants: tuple[ConstantView, ...]
    comment: str


class InterfaceAnswer(Message):
    """Answer to `get_interface`."""

    type: Literal["interface"] = "interface"
    request: int
    name: str
    kind: Literal["msg", "srv", "action"]
    parts: tuple[str, ...]
    """Names among `messages`: itself; request and response; goal, result and feedback."""
    messages: tuple[MessageView, ...]
    """The parts and all that they are made of, whatever is made of others before these."""
    hash: str
    """RIHS01, as it stands in the keys of the wire."""
    text: str
    """As it was written; empty where only the distribution has it."""


InterfaceCommand: TypeAlias = GetInterface
InterfaceEvent: TypeAlias = InterfaceAnswer
