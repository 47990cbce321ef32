"""Messages about what is done in a ROS 2 system: services called, goals sent, topics published."""

from __future__ import annotations

from typing import Annotated, Literal, TypeAlias

from pydantic import Field, StringConstraints

from studio.protocol.interfaces import NAME_MAX
from studio.protocol.message import Command, Event, Message

TEXT_MAX = 400_000
Name: TypeAlias = Annotated[str, StringConstraints(min_length=1, max_length=NAME_MAX)]
Yaml: TypeAlias = Annotated[str, StringConstraints(max_length=TEXT_MAX)]
"""Values as a command line gives them; empty: all defaults."""
PlainJson: TypeAlias = str
"""JSON of plain values. What JSON's numbers do not hold, as nan and whole numbers of more than 53
bits, stands in it as a text."""


class GetServices(Command):
    """Ask for the services that have a server."""

    type: Literal["get_services"] = "get_services"


class GetActions(Command):
    """Ask for the actions that have a server."""

    type: Literal["get_actions"] = "get_actions"


class ReadValues(Command):
    """Read YAML as values of a type; refused with the field that does not take its value."""

    type: Literal["read_values"] = "read_values"
    name: Name
    """Full name of the type."""
    place: int = Field(default=0, ge=0, le=2)
    """Among the parts of `interface`: 0 is the message itself, a request or a goal."""
    text: Yaml


class FollowOperations(Command):
    """Receive the operations of a kind, of all pages, and their changes; or no more."""

    type: Literal["follow_operations"] = "follow_operations"
    operations: Literal["calls", "goals", "publications"]
    following: bool = True


class CallService(Command):
    """Call a service; those who follow calls receive what becomes of it."""

    type: Literal["call_service"] = "call_service"
    name: Name
    service_type: Name
    text: Yaml = ""
    timeout_s: float = Field(default=10.0, gt=0, le=3600)


class CancelCall(Command):
    """Wait for the answer of a call no longer."""

    type: Literal["cancel_call"] = "cancel_call"
    operation: int


class OfferView(Message):
    """A service or an action."""

    name: str
    types: tuple[str, ...]
    nodes: tuple[str, ...]
    """Full names of those that serve it."""


class Services(Event):
    """Answer to `get_services`."""

    type: Literal["services"] = "services"
    request: int
    services: tuple[OfferView, ...]


class Actions(Event):
    """Answer to `get_actions`."""

    type: Literal["actions"] = "actions"
    request: int
    actions: tuple[OfferView, ...]


class ValuesRead(Event):
    """Answer to `read_values`: only what the text names; `now` and `auto` stay as they are."""

    type: Literal["values_read"] = "values_read"
    request: int
    values: PlainJson


class Begun(Event):
    """Answer to what begins an operation: its number, by which it is reported and cancelled."""

    type: Literal["begun"] = "begun"
    request: int
    operation: int


class CallView(Message):
    """A call, and what became of it."""

    operation: int
    name: str
    service_type: str
    text: str
    """The request, as it was asked."""
    state: Literal["calling", "answered", "failed", "cancelled"]
    began_s: float
    """Seconds since the epoch, by the studio's clock."""
    took_s: float
    timeout_s: float
    reply: PlainJson
    """Empty without one."""
    trouble: str
    """Why there is none, in a sentence."""


class Calls(Event):
    """Calls, the oldest first; all that are kept, or those that changed."""

    type: Literal["calls"] = "calls"
    whole: bool
    operations: tuple[CallView, ...]
