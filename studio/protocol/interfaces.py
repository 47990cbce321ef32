"""Messages about interfaces: what messages, services and actions are made of."""

from __future__ import annotations

from typing import Annotated, Literal, TypeAlias

from pydantic import Field

from studio.protocol.message import Command, Event, Message

Value: TypeAlias = bool | int | float | str
NAME_MAX = 300
TEXT_MAX = 500_000


class GetInterface(Command):
    """Ask what a type is made of, down to its numbers and texts."""

    type: Literal["get_interface"] = "get_interface"
    name: str = Field(max_length=NAME_MAX)
    """Full name: `geometry_msgs/msg/Twist`, `std_srvs/srv/SetBool`."""
    with_text: bool = False
    """For a type that only a distribution has, its users are asked for definition and comments."""


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


class InterfaceAnswer(Event):
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
    """The definition; empty where only the distribution has the type, and no node described it."""


class ListInterfaces(Command):
    """Ask which types are known."""

    type: Literal["list_interfaces"] = "list_interfaces"


class InterfaceFaultView(Message):
    """A text that defines no type."""

    place: str
    """The file, or the name that its type would have without one."""
    line: int
    """From 1; 0: the whole text."""
    reason: str
    """What is wrong and what to write, half a sentence."""


class InterfacesAnswer(Event):
    """Answer to `list_interfaces`: full names in order."""

    type: Literal["interfaces"] = "interfaces"
    request: int
    distro: str
    names: tuple[str, ...]
    own: tuple[str, ...]
    """Those that a user added: by a package, an option, or on the page."""
    faults: tuple[InterfaceFaultView, ...]
    """Of a user's definitions that are not valid."""


class AddInterfaces(Command):
    """Take up texts of types, usable at once; what needs others may come first.

    Of several, those that break a rule are left out and named; one alone is refused.
    """

    type: Literal["add_interfaces"] = "add_interfaces"
    texts: Annotated[
        dict[
            Annotated[str, Field(max_length=NAME_MAX)], Annotated[str, Field(max_length=TEXT_MAX)]
        ],
        Field(min_length=1, max_length=2_000),
    ]
    """By full names: `my_interfaces/msg/Telemetry`."""


class AddedInterface(Message):
    """A type that was taken up."""

    name: str
    hash: str
    """RIHS01; empty while something that it is made of is not known."""
    trouble: str
    """What it still needs, in a sentence."""


class InterfacesAdded(Event):
    """Answer to `add_interfaces`."""

    type: Literal["interfaces_added"] = "interfaces_added"
    request: int
    types: tuple[AddedInterface, ...]
    faults: tuple[InterfaceFaultView, ...]
    """Of definitions that were left out."""
