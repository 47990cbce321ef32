"""Messages about the log of a ROS 2 system: what its nodes publish on `/rosout`."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from studio.protocol.message import Command, Event, Message

LINES_MAX = 2_000
"""Limit of one answer."""


class GetLog(Command):
    """Ask for the lines after one; `/rosout` is subscribed from the first such request on."""

    type: Literal["get_log"] = "get_log"
    after: int = Field(default=0, ge=0)
    """Number of the last line that is known; 0: none."""


class LogLine(Message):
    """One line that a node logged."""

    number: int
    """Counts all lines received, from 1."""
    stamp_s: float
    """By the node's clock, since 1970."""
    level: int
    """10 debug, 20 info, 30 warning, 40 error, 50 fatal; others are possible."""
    node: str
    """Name of its logger, which begins with that of the node."""
    text: str
    file: str
    function: str
    line: int


class LogAnswer(Event):
    """Answer to `get_log`: the oldest lines after that one, and how many there are in all."""

    type: Literal["log"] = "log"
    request: int
    connected: bool
    """Whether `/rosout` is subscribed; else nothing new comes."""
    lines: tuple[LogLine, ...]
    first: int
    """Number of the oldest line that is kept; what was before it is gone."""
    last: int
    """Number of the newest line; 0: none came."""
