"""Messages about the arguments that a robot is launched with."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from studio.description.values import Widget
from studio.protocol.message import ArgumentName, Command, Event, Message


class SetArgument(Command):
    """Pass an argument as `name:=value` on the command line would; None takes it back."""

    type: Literal["set_argument"] = "set_argument"
    name: ArgumentName
    value: str | None


class GetArguments(Command):
    """What a robot can be launched with: the open document's, or that of a file not yet open."""

    type: Literal["get_arguments"] = "get_arguments"
    path: str = Field(default="", max_length=4096)


class SetArguments(Command):
    """Pass several arguments at once, as one run and one undo step; None takes one back."""

    type: Literal["set_arguments"] = "set_arguments"
    values: dict[ArgumentName, str | None] = Field(min_length=1, max_length=1000)


class ArgumentView(Message):
    """One argument of a robot, as a form shows it."""

    name: str
    file: str
    line: int
    default: str | None
    """As written in the file; None: the robot needs a value from outside."""
    value: str | None
    """What is passed now."""
    shown: str
    """What it comes to now, where that is known without a run."""
    widget: Widget
    is_file: bool
    """Its value names a file."""


class Arguments(Event):
    """Answer to `get_arguments`; `missing`: those without which it cannot be shown."""

    type: Literal["arguments"] = "arguments"
    request: int
    path: str
    arguments: tuple[ArgumentView, ...]
    missing: tuple[str, ...]
