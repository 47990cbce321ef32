"""Relays: machines that pass a shared studio on to more browsers than it could serve itself."""

from __future__ import annotations

from typing import Annotated, Literal, TypeAlias

from pydantic import StringConstraints

from studio.protocol.message import Command, Event, Message

RelayLine: TypeAlias = Annotated[str, StringConstraints(min_length=1, max_length=300)]
"""What `studio relay` prints: `tls/HOST:PORT#KEY`."""


class AddRelay(Command):
    """Share the class by a relay, too."""

    type: Literal["add_relay"] = "add_relay"
    line: RelayLine


class RemoveRelay(Command):
    """Share the class by this relay no more: its people go to another."""

    type: Literal["remove_relay"] = "remove_relay"
    endpoint: RelayLine


RelayStatus: TypeAlias = Literal["connecting", "there", "lost", "refused"]
"""`lost` and `connecting` are tried again by themselves, `refused` is not."""


class RelayView(Message):
    """One relay as the presenter sees it."""

    endpoint: str
    """Where it is dialled, without its key."""
    state: RelayStatus
    reason: str = ""
    """Why it is not there, in a sentence."""
    address: str = ""
    """Of the page at which people join there; empty: it is not known yet."""
    people: int = 0
    """Whose pages are open there."""
    lag_ms: float = 0.0
    """Age of the oldest that the relay has not confirmed yet; more than a second: it is behind."""


class Relays(Event):
    """The relays of this studio; only to presenters."""

    type: Literal["relays"] = "relays"
    relays: tuple[RelayView, ...]


class RelayState(Event):
    """To a page that a relay serves: whether the studio is there, and where else one can go on."""

    type: Literal["relay_state"] = "relay_state"
    studio: Literal["there", "away"]
    """`away`: what the page shows is the last that came; it goes on by itself."""
    others: tuple[str, ...] = ()
    """Addresses at which this person goes on when this relay is gone: each holds their ticket."""
