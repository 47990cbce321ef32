"""`.rviz` files of a document: opened, saved and downloaded; and the options of its 3D view."""

from __future__ import annotations

from typing import Annotated, Literal, TypeAlias

from pydantic import Field, StringConstraints

from studio.protocol.displays import PropertyValue, ShortName
from studio.protocol.message import Command, Event, Message

FilePath: TypeAlias = Annotated[str, StringConstraints(max_length=4096, pattern=r"^[^\x00]*$")]
FileName: TypeAlias = Annotated[str, StringConstraints(max_length=255, pattern=r"^[^\x00-\x1f]*$")]
ConfigText: TypeAlias = Annotated[str, StringConstraints(max_length=1 << 20)]
PageText: TypeAlias = Annotated[str, StringConstraints(max_length=300_000)]
"""Panels, layouts and plots of a page, as a JSON object; empty: none."""
Colour: TypeAlias = Annotated[str, StringConstraints(pattern=r"^(#[0-9a-fA-F]{6})?$")]


class ViewValues(Message):
    """A view of the 3D view, by RViz's names."""

    kind: ShortName
    name: ShortName = ""
    values: dict[str, PropertyValue] = Field(default_factory=dict, max_length=50)


class OpenRvizFile(Command):
    """Show what an `.rviz` file says instead of the displays that there are."""

    type: Literal["open_rviz_file"] = "open_rviz_file"
    path: FilePath
    """Below the folders that may be read; as `package://` or relative to the robot's file, too."""


class OpenRvizText(Command):
    """The same with the text of a file that this browser has."""

    type: Literal["open_rviz_text"] = "open_rviz_text"
    name: FileName
    text: ConfigText


class LossView(Message):
    """Something of a file that is only kept, and written back as it is."""

    reason: Literal[
        "no_display", "no_property", "no_value", "no_tool", "no_view", "no_panel", "no_option",
        "empty_group", "window",
    ]  # fmt: skip
    what: str
    """The class in the file, or the part of the file."""
    names: tuple[str, ...]
    """Its properties; none: the whole of it."""


class RvizConfigOpened(Event):
    """Answer: the file is shown."""

    type: Literal["rviz_config_opened"] = "rviz_config_opened"
    request: int
    name: str
    displays: int
    """How many of its displays are shown."""
    tools: int
    views: int
    losses: tuple[LossView, ...]
    view: ViewValues | None
    """The view that was in use; None: none that there is here."""
    page: PageText


class GetRvizView(Command):
    """Ask for the view and the page settings that the `.rviz` file starts a page with."""

    type: Literal["get_rviz_view"] = "get_rviz_view"


class RvizView(Event):
    """Answer: what was in use when the file was saved."""

    type: Literal["rviz_view"] = "rviz_view"
    request: int
    view: ViewValues | None
    """None: it has none that the studio knows."""
    page: PageText
    """Only for the first page of a presenter after the command line named the file."""


class GetRvizText(Command):
    """Ask for the text of an `.rviz` file with all that is shown."""

    type: Literal["get_rviz_text"] = "get_rviz_text"
    view: ViewValues | None = None
    """The view of this page; None: that of the file stays."""
    page: PageText = ""
    rviz2: bool = False
    """Whether a file of RViz 1 becomes one that RViz2 opens."""


class RvizText(Event):
    """Answer: the text."""

    type: Literal["rviz_text"] = "rviz_text"
    request: int
    name: str
    text: str


class SaveRvizFile(Command):
    """Write an `.rviz` file; without a path the one that was opened."""

    type: Literal["save_rviz_file"] = "save_rviz_file"
    path: FilePath = ""
    replace: bool = False
    """Whether a file is written over that is not the one opened, or that somebody else changed."""
    view: ViewValues | None = None
    page: PageText = ""
    rviz2: bool = False
    """Whether a file of RViz 1 becomes one that RViz2 opens."""


class RvizFileSaved(Event):
    """Answer: where it was written; or that there is a file already, which is as it was."""

    type: Literal["rviz_file_saved"] = "rviz_file_saved"
    request: int
    path: str
    is_there: bool
    """True: nothing was written."""
    changed: bool
    """Whether this is the open file, and somebody else changed it on the disk."""


class UndoRvizConfig(Command):
    """Show what was shown before an `.rviz` file was opened; until something else is changed."""

    type: Literal["undo_rviz_config"] = "undo_rviz_config"


class CloseRvizConfig(Command):
    """Forget which file was opened; what is shown stays."""

    type: Literal["close_rviz_config"] = "close_rviz_config"


class SetViewOptions(Command):
    """Change what all views of the document have in common; what is None stays."""

    type: Literal["set_view_options"] = "set_view_options"
    background: Colour | None = None
    """Behind the 3D view; empty: that of the theme."""
    frame_rate: int | None = Field(default=None, ge=0, le=240)
    """Pictures per second at most; 0: as many as there can be."""


class ListRvizFiles(Command):
    """Ask for the `.rviz` files of the robot's packages, and those opened lately."""

    type: Literal["list_rviz_files"] = "list_rviz_files"


class ForgetRvizFile(Command):
    """Take a file out of those opened lately; answered with the list."""

    type: Literal["forget_rviz_file"] = "forget_rviz_file"
    path: FilePath


class RvizFileEntry(Message):
    """An `.rviz` file."""

    path: str
    name: str
    time_s: float | None
    """When it was opened, Unix time; None: it was not."""
    is_there: bool


class RvizFiles(Event):
    """Answer: those opened lately, the newest first, then those of the packages."""

    type: Literal["rviz_files"] = "rviz_files"
    request: int
    files: tuple[RvizFileEntry, ...]
    folder: str
    """Where a new file may go; empty: nowhere."""


class RvizConfigState(Event):
    """The `.rviz` file of a document."""

    type: Literal["rviz_config_state"] = "rviz_config_state"
    name: str
    """Empty: none was opened or saved."""
    path: str
    """Empty: it came from a browser."""
    changed: bool
    """Whether saving would write something else than the file says."""
    rviz1: bool
    """Whether it has RViz 1's names, which RViz2 does not read."""
    undo: bool
    """Whether `undo_rviz_config` has something to bring back."""
