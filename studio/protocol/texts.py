"""Messages about texts: what a file holds as it is typed into, and the expanded URDF."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from studio.protocol.message import OFFSET_LIMIT, Command, Event, Message


class GetText(Command):
    """The text of a file as it is edited; `texts_changed` tells from then on what happens to it."""

    type: Literal["get_text"] = "get_text"
    file: str = Field(max_length=4096)


class TextChange(Message):
    """In the text before, [start, end) gives way to `text`.

    The text is as an editor holds it: no byte order mark, every line break one LF. Offsets are
    UTF-16 code units from 0.
    """

    start: int = Field(ge=0, le=OFFSET_LIMIT)
    end: int = Field(ge=0, le=OFFSET_LIMIT)
    text: str = Field(max_length=4_194_304)


class EditText(Command):
    """Type into a file's text; refused when its version is no longer this one.

    The changes are in order, none overlapping, each with offsets in the text before all of them.
    All edits of one `gesture` are one undo step. `origin`, chosen by the browser, comes back in
    the `texts_changed` that tells them, so that it knows its own.
    """

    type: Literal["edit_text"] = "edit_text"
    file: str = Field(max_length=4096)
    version: int = Field(ge=0, le=OFFSET_LIMIT)
    changes: tuple[TextChange, ...] = Field(min_length=1, max_length=5000)
    gesture: str = Field(default="", max_length=100)
    origin: str = Field(default="", max_length=100)


class Text(Event):
    """Answer to `get_text`: the text at a version, as `TextChange` describes texts."""

    type: Literal["text"] = "text"
    request: int
    file: str
    """As the studio names it, which may differ from how it was asked for."""
    version: int
    text: str
    saved: str | None
    """The text on disk, where it is another one."""
    read_only: str
    """Why it may not be edited, a sentence; empty: it may."""


class TextsChanged(Event):
    """A text that somebody asked for changed, by whatever way; it now has this version."""

    type: Literal["texts_changed"] = "texts_changed"
    file: str
    version: int
    changes: tuple[TextChange, ...]
    origin: str
    """Of the `edit_text` that did it; empty: it was none."""


class GetUrdf(Command):
    """The expanded URDF of the last good run."""

    type: Literal["get_urdf"] = "get_urdf"


class Urdf(Event):
    """Answer to `get_urdf`."""

    type: Literal["urdf"] = "urdf"
    request: int
    text: str
