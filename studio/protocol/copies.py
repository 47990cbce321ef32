"""Copies: a person's own document of a shared robot, to try things on and to hand in."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, StringConstraints

from studio.protocol.message import Command, Event, Message

REMARK_MAX = 2_000


class OpenCopy(Command):
    """Make a copy of a shared document with its unsaved edits, or go on with yours."""

    type: Literal["open_copy"] = "open_copy"


class DiscardCopy(Command):
    """Give a copy up; the next one begins with the shared robot as it is then."""

    type: Literal["discard_copy"] = "discard_copy"


class HandIn(Command):
    """Hand a copy in as it is now; handed in again, it takes the place of the one before."""

    type: Literal["hand_in"] = "hand_in"


class SendBack(Command):
    """Send a copy back to its owner with a remark."""

    type: Literal["send_back"] = "send_back"
    remark: Annotated[str, StringConstraints(max_length=REMARK_MAX)]


class ShowCopy(Command):
    """Let everybody see a copy, and bring those who follow to it; or no longer."""

    type: Literal["show_copy"] = "show_copy"
    shown: bool = True


class CopyView(Message):
    """One copy."""

    document: str
    """Its id."""
    of: str
    """Id of the shared document."""
    person: str
    name: str
    title: str
    made_s: float
    """In seconds since the epoch, as all of these."""
    handed_s: float | None = None
    changes: int = Field(default=0, ge=0)
    """Places in which what was handed in differs from the original."""
    remark: str = ""
    remarked_s: float | None = None
    """When it was sent back; with a hand-in after that, it is answered."""
    shown: bool = False


class MyCopies(Event):
    """Your own copies, to all pages of a person."""

    type: Literal["my_copies"] = "my_copies"
    copies: tuple[CopyView, ...]


class Copies(Event):
    """All copies, to those who lead the class."""

    type: Literal["copies"] = "copies"
    copies: tuple[CopyView, ...]
