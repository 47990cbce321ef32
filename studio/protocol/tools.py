"""Tools of a document's 3D view: their list and properties, and what they publish."""

from __future__ import annotations

from typing import Annotated, Literal, TypeAlias

from pydantic import Field

from studio.protocol.displays import DisplayId, PropertyValue, PropertyView, RosName, ShortName
from studio.protocol.message import Command, Event, Message

ToolId: TypeAlias = DisplayId
Metres: TypeAlias = Annotated[float, Field(ge=-1e9, le=1e9)]


class AddTool(Command):
    """Add a tool at the end."""

    type: Literal["add_tool"] = "add_tool"
    kind: ShortName
    name: ShortName = ""
    """Empty: that of its kind, with a number where there is one already."""


class RemoveTool(Command):
    """Remove a tool; one Interact tool stays."""

    type: Literal["remove_tool"] = "remove_tool"
    tool: ToolId


class RenameTool(Command):
    """Give a tool another name."""

    type: Literal["rename_tool"] = "rename_tool"
    tool: ToolId
    name: ShortName


class SetToolProperty(Command):
    """Change a property of a tool, by RViz's name."""

    type: Literal["set_tool_property"] = "set_tool_property"
    tool: ToolId
    name: RosName
    value: PropertyValue


class GetToolKinds(Command):
    """Ask for the kinds of tools."""

    type: Literal["get_tool_kinds"] = "get_tool_kinds"


class UseTool(Command):
    """Publish what was pointed at with a tool, or send it as a goal."""

    type: Literal["use_tool"] = "use_tool"
    tool: ToolId
    fixed_frame: RosName = ""
    """In which the place is given: refused if it is another now. Empty: the robot's root link."""
    x: Metres
    y: Metres
    z: Metres = 0.0
    yaw: float = Field(default=0.0, ge=-1e3, le=1e3)
    """rad about z; of a tool that publishes a point it is not used."""


class ToolKindView(Message):
    """A kind of tool."""

    kind: str
    name: str
    doc: str
    icon: str
    properties: tuple[PropertyView, ...]


class ToolKinds(Event):
    """Answer to `get_tool_kinds`, in the order of RViz's toolbar."""

    type: Literal["tool_kinds"] = "tool_kinds"
    request: int
    kinds: tuple[ToolKindView, ...]


class ToolView(Message):
    """A tool as it is set."""

    id: str
    kind: str
    name: str
    icon: str
    key: str
    publishes: str
    """Type of its messages; empty: it publishes nothing."""
    values: dict[str, PropertyValue]
    """All its properties."""


class Tools(Event):
    """All tools of a document, in order."""

    type: Literal["tools"] = "tools"
    tools: tuple[ToolView, ...]


class ToolUsed(Event):
    """Answer to `use_tool`: what was sent where."""

    type: Literal["tool_used"] = "tool_used"
    request: int
    sent_as: Literal["topic", "action"]
    name: str
    """Of the topic or the action."""
    frame: str
    """Of the message."""
    xyz: tuple[float, float, float]
    """m, in that frame."""
    wxyz: tuple[float, float, float, float]
    subscriptions: int
    """Of the topic when it was published; 0: nobody heard it. Of a goal it is 0."""
    operation: int
    """Of a goal: its number among goals; else 0."""
