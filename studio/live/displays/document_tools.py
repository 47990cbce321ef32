"""DocumentTools: the tools of a document's 3D view, and what is asked of them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from studio.displays.properties import FIXED_FRAME
from studio.errors import ToolError
from studio.protocol.commands import Commands, OnCopies, Scope
from studio.protocol.listeners import LastSent
from studio.protocol.tools import (
    AddTool,
    GetToolKinds,
    RemoveTool,
    RenameTool,
    SetToolProperty,
    ToolKinds,
    ToolKindView,
    Tools,
    ToolView,
)
from studio.rviz.config_lists import with_entries
from studio.rviz.tools import FRAME, TOOL_KINDS, ToolList, kind_of
from studio.tf.rotations import compose
from studio.tf.transforms import plain_name

if TYPE_CHECKING:
    from collections.abc import Callable, Container, Iterable

    from studio.live.displays.scene_frames import SceneFrames
    from studio.protocol.listeners import Audience
    from studio.rviz.tools import ToolKind, ToolSpec


@dataclass(frozen=True, slots=True)
class Pointed:
    """A place that somebody pointed at with a tool.

    Attributes:
        tool: Its id.
        fixed_frame: The frame that was chosen in the view; empty: the robot's root link.
        xyz: In the fixed frame, m.
        yaw_rad: A direction about z of the fixed frame.
    """

    tool: str
    fixed_frame: str
    xyz: tuple[float, float, float]
    yaw_rad: float = 0.0


@dataclass(frozen=True, slots=True)
class ToolUse:
    """What a tool is to send.

    Attributes:
        tool: The tool.
        frame: The frame of the message.
        wxyz: Orientation in that frame, of length 1.
        xyz: Place in that frame, m.
        stamp_ns: ROS time when it was pointed at.
    """

    tool: ToolSpec
    frame: str
    wxyz: tuple[float, float, float, float]
    xyz: tuple[float, float, float]
    stamp_ns: int


class DocumentTools:
    """Changes the list of tools; everybody is sent the whole of it.

    Args:
        audience: Is sent the tools.
        changed: Called after each change.
    """

    def __init__(self, audience: Audience, changed: Callable[[], object]) -> None:
        self._changed = changed
        self.list = ToolList()
        self._sent = LastSent[Tools](audience)
        self.on_tools: Callable[[Container[str]], object] = lambda _: None
        """Told the ids of the tools that there are, after each change."""

    @property
    def kept(self) -> tuple[ToolSpec, ...]:
        """All that is kept of them."""
        return tuple(self.list)

    def restore(self, tools: Iterable[ToolSpec]) -> None:
        """Have these tools; none: RViz's first set."""
        self.list.restore(tools)
        self._send()

    def note_saved(self, saved: Iterable[ToolSpec]) -> None:
        """Note where each stands in the config file that was written."""
        self.list.renew(with_entries(self.list, saved))

    def mirror(self, others: tuple[ToolSpec, ...]) -> None:
        """Have the tools that another document has."""
        if [_content(one) for one in others] != [_content(one) for one in self.list]:
            self.restore(others)
            self._changed()

    def event(self) -> Tools:
        """Return all tools as pages receive them."""
        return Tools(tools=tuple(map(_view, self.list)))

    def kinds(self, command: GetToolKinds) -> ToolKinds:
        """Return the kinds of tools."""
        return ToolKinds(request=command.request, kinds=tuple(map(_kind_view, TOOL_KINDS.values())))

    def add(self, command: AddTool) -> None:
        """Add one."""
        self.list.add(command.kind, command.name.strip())
        self._tell()

    def remove(self, command: RemoveTool) -> None:
        """Take one away."""
        self.list.remove(command.tool)
        self._tell()

    def rename(self, command: RenameTool) -> None:
        """Give one another name."""
        self.list.rename(command.tool, command.name)
        self._tell()

    def set_property(self, command: SetToolProperty) -> None:
        """Change a property."""
        value = command.value
        if command.name == FRAME and isinstance(value, str):
            value = "" if value == FIXED_FRAME else plain_name(value.strip())
        self.list.set(command.tool, command.name, value)
        self._tell()

    def use(self, pointed: Pointed, frames: SceneFrames) -> ToolUse:
        """Return what a tool is to send.

        Raises:
            ToolError: The tool publishes nothing, or there is no fixed frame, or another one.
            FrameError: Nothing connects the tool's frame with the fixed frame.
        """
        tool = self.list.get(pointed.tool)
        if not kind_of(tool.kind).message_type:
            raise ToolError(f"{tool.name} publishes nothing.")
        if pointed.fixed_frame != frames.chosen:
            raise ToolError("The fixed frame was changed meanwhile: point at the place again.")
        fixed = frames.fixed
        if not fixed:
            raise ToolError("There is no fixed frame: choose one in the 3D view.")
        half_rad = pointed.yaw_rad / 2
        pose = (math.cos(half_rad), 0.0, 0.0, math.sin(half_rad))
        frame = str(tool.value(FRAME)) or fixed
        if frame == fixed:
            return ToolUse(tool, fixed, pose, pointed.xyz, frames.ros_ns)
        frame_from_fixed = frames.buffer.fixed_from(frame, fixed)
        placed = compose((*frame_from_fixed.wxyz, *frame_from_fixed.xyz), (*pose, *pointed.xyz))
        return ToolUse(tool, frame, placed[:4], placed[4:], frames.ros_ns)

    def close(self) -> None:
        """There are none any more."""
        self.on_tools(())

    def _tell(self) -> None:
        self._send()
        self._changed()

    def _send(self) -> None:
        self._sent.send(self.event())
        self.on_tools([one.id for one in self.list])


def _content(tool: ToolSpec) -> tuple[str, str, dict[str, object]]:
    return tool.kind, tool.name, dict(tool.values)


def _view(tool: ToolSpec) -> ToolView:
    kind = kind_of(tool.kind)
    return ToolView(
        id=tool.id,
        kind=tool.kind,
        name=tool.name,
        icon=kind.icon,
        key=kind.key,
        publishes=kind.message_type,
        values={one.name: tool.value(one.name) for one in kind.properties},
    )


def _kind_view(kind: ToolKind) -> ToolKindView:
    from studio.live.displays.catalogue_views import property_view  # noqa: PLC0415 - imports all

    return ToolKindView(
        kind=kind.kind,
        name=kind.name,
        doc=kind.doc,
        icon=kind.icon,
        properties=tuple(map(property_view, kind.properties)),
    )


COMMANDS: Final = Commands[DocumentTools](Scope.DOCUMENT)
COMMANDS.controller(AddTool, lambda tools, c, _: tools.add(c), on_copies=OnCopies.REFUSED)
COMMANDS.controller(RemoveTool, lambda tools, c, _: tools.remove(c), on_copies=OnCopies.REFUSED)
COMMANDS.controller(RenameTool, lambda tools, c, _: tools.rename(c), on_copies=OnCopies.REFUSED)
COMMANDS.controller(
    SetToolProperty, lambda tools, c, _: tools.set_property(c), on_copies=OnCopies.REFUSED
)
COMMANDS.viewer(GetToolKinds, lambda tools, c, _: tools.kinds(c), same_for_all=True)
