"""Messages about links that open a robot as somebody sees it."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from studio.protocol.message import Command, Event


class GetLink(Command):
    """A link that opens this robot with its arguments and unsaved edits."""

    type: Literal["get_link"] = "get_link"


class OpenLink(Command):
    """Open what a link holds as a document of its own; its edits are unsaved there."""

    type: Literal["open_link"] = "open_link"
    link: str = Field(max_length=400_000)


class Link(Event):
    """Answer to `get_link`: `text` goes behind `#robot=` of the studio's address."""

    type: Literal["link"] = "link"
    request: int
    text: str
    arguments: int
    files: tuple[str, ...]
    """Those whose unsaved edits it holds."""
    edits: int


class LinkOpened(Event):
    """Answer to `open_link`: go to `/d/<document>`; `left_out` says which edits found no place."""

    type: Literal["link_opened"] = "link_opened"
    request: int
    document: str
    left_out: tuple[str, ...]
