"""Messages about what can be opened beside the served folders, and about what is made anew."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from studio.protocol.message import ArgumentName, Command, Event, Message


class ListRecent(Command):
    """The files that were opened last."""

    type: Literal["list_recent"] = "list_recent"


class OpenRecent(Command):
    """Open a file of that list again, with the arguments that it had."""

    type: Literal["open_recent"] = "open_recent"
    path: str = Field(max_length=4096)


class ForgetRecent(Command):
    """Take a file out of that list; the file stays."""

    type: Literal["forget_recent"] = "forget_recent"
    path: str = Field(max_length=4096)


class ListExamples(Command):
    """The models that the studio ships."""

    type: Literal["list_examples"] = "list_examples"


class OpenExample(Command):
    """Open the working copy of a shipped model."""

    type: Literal["open_example"] = "open_example"
    name: str = Field(max_length=200)
    arguments: dict[ArgumentName, str] = Field(default_factory=dict)
    """That the model is opened with."""


class ListPlaces(Command):
    """The folders in which something new can be made."""

    type: Literal["list_places"] = "list_places"


class NewRobot(Command):
    """Make a package `folder/name` out of a template, and open its robot."""

    type: Literal["new_robot"] = "new_robot"
    template: Literal["blank", "rover", "arm"]
    name: str = Field(max_length=200)
    folder: str = Field(default="", max_length=4096)
    """Empty: that of the data folder."""


class NewUntitled(Command):
    """Open a text that has no file yet."""

    type: Literal["new_untitled"] = "new_untitled"
    text: str


class SaveAs(Command):
    """Write the document's robot to a new place, and go on there."""

    type: Literal["save_as"] = "save_as"
    name: str = Field(max_length=200)
    folder: str = Field(default="", max_length=4096)
    """Empty: that of the data folder."""
    as_package: bool = True
    """With package.xml, launch/ and README.md around it."""


class RecentEntry(Message):
    """One file of the list; `is_there` false: it is gone."""

    path: str
    title: str
    time_s: float
    """When it was opened, Unix time."""
    origin: Literal["file", "example", "upload", "untitled"]
    is_there: bool


class Recent(Event):
    """Answer to `list_recent` and `forget_recent`: newest first."""

    type: Literal["recent"] = "recent"
    request: int
    files: tuple[RecentEntry, ...]


class ExampleEntry(Message):
    """One shipped model; `text` says what it shows."""

    name: str
    robot: str
    text: str


class Examples(Event):
    """Answer to `list_examples`."""

    type: Literal["examples"] = "examples"
    request: int
    examples: tuple[ExampleEntry, ...]


class Places(Event):
    """Answer to `list_places`: the data folder's own first."""

    type: Literal["places"] = "places"
    request: int
    folders: tuple[str, ...]
