"""Messages about managed nodes: their states, and the ways from one to another."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from studio.protocol.message import Command, Event, Message

MANAGED_MAX = 100


class GetManaged(Command):
    """Ask in which state the managed nodes are; each of them is asked."""

    type: Literal["get_managed"] = "get_managed"


class TransitionView(Message):
    """What a node can be asked to do."""

    id: int
    label: str
    goal: str
    """The state that it leads to first."""


class ManagedNodeView(Message):
    """A managed node."""

    name: str
    state_id: int
    """1 unconfigured, 2 inactive, 3 active, 4 finalized; from 10 on between two; 0: not known."""
    state: str
    transitions: tuple[TransitionView, ...]
    trouble: str
    """Why its state is not known, in a sentence."""


class ManagedNodes(Event):
    """Answer to `get_managed`."""

    type: Literal["managed_nodes"] = "managed_nodes"
    request: int
    nodes: tuple[ManagedNodeView, ...]
    more: int
    """Managed nodes that were not asked, for there are too many."""


class ChangeState(Command):
    """Have a managed node take a transition; done when it has, refused with what became of it."""

    type: Literal["change_state"] = "change_state"
    node: str = Field(max_length=300)
    transition: int = Field(ge=0, le=255)
