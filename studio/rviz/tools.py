"""Tools of the 3D view: RViz2's kinds with its names and defaults, and the tools of a document."""

from __future__ import annotations

import math
from collections.abc import Mapping  # noqa: TC003 - msgspec reads it
from contextlib import suppress
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, Final

from studio.displays.properties import Property, Value, switch
from studio.errors import StudioError, ToolError

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

POSE_WITH_COVARIANCE: Final = "geometry_msgs/msg/PoseWithCovarianceStamped"
POSE: Final = "geometry_msgs/msg/PoseStamped"
POINT: Final = "geometry_msgs/msg/PointStamped"
NAVIGATE_TO_POSE: Final = "nav2_msgs/action/NavigateToPose"

TOPIC: Final = "Topic"
DEPTH: Final = "Topic/Depth"
HISTORY: Final = "Topic/History Policy"
RELIABILITY: Final = "Topic/Reliability Policy"
DURABILITY: Final = "Topic/Durability Policy"
FRAME: Final = "Frame"
COVARIANCES: Final = ("Covariance x", "Covariance y", "Covariance yaw")
SINGLE_CLICK: Final = "Single click"
LINE_COLOR: Final = "Line color"
SEND_AS: Final = "Send as"
ACTION: Final = "Action"

TOOLS_MAX: Final = 50
_DEPTH_MAX: Final = 10_000
_SYSTEM_DEFAULT: Final = "System Default"


@dataclass(frozen=True, slots=True)
class ToolKind:
    """One kind of tool.

    Attributes:
        kind: RViz's class without its package, as `SetGoal`.
        name: The first name of a tool of this kind.
        doc: One sentence for the user.
        icon: One of the page's icons, as `Display.ICON`.
        key: The key that takes the first tool of this kind, as RViz has it.
        message_type: What it publishes; empty: nothing.
        properties: What can be set.
    """

    kind: str
    name: str
    doc: str
    icon: str
    key: str
    message_type: str = ""
    properties: tuple[Property, ...] = ()

    def property(self, name: str) -> Property:
        """Return the property of a name.

        Raises:
            ToolError: There is none.
        """
        for one in self.properties:
            if one.name == name:
                return one
        raise ToolError(f"{name} is no property of {self.name}.")


@dataclass(frozen=True, slots=True)
class ToolSpec:
    """Settings of one tool.

    `values` holds the properties that differ from their defaults, `entry` the tool as it stands in
    the `.rviz` file; empty: it was in none.
    """

    id: str
    kind: str
    name: str
    values: Mapping[str, Value] = field(default_factory=dict[str, Value])
    entry: dict[str, Any] = field(default_factory=dict[str, Any])

    def value(self, name: str) -> Value:
        """Return a property as it is set, or its default.

        Raises:
            ToolError: The kind has no property of that name.
        """
        default = kind_of(self.kind).property(name).default
        return self.values.get(name, default)


def kind_of(kind: str) -> ToolKind:
    """Return the kind of a name.

    Raises:
        ToolError: There is none.
    """
    found = TOOL_KINDS.get(kind)
    if found is None:
        raise ToolError(f'There is no tool "{kind}": choose one of {", ".join(TOOL_KINDS)}.')
    return found


def default_tools() -> tuple[ToolSpec, ...]:
    """Return RViz's first set, in its order; the ids are `t1` and so on."""
    return tuple(
        ToolSpec(f"t{number}", one.kind, one.name)
        for number, one in enumerate(TOOL_KINDS.values(), start=1)
    )


def _topic_properties(topic: str, what: str) -> tuple[Property, ...]:
    """Return a topic and its QoS as RViz2 groups them below it."""
    return (
        Property(TOPIC, "text", topic, f"The topic on which {what} are published."),
        Property(
            DEPTH, "whole", 5, "How many messages are kept for a slow subscription.",
            low=1, high=_DEPTH_MAX,
        ),
        _policy(HISTORY, "Keep Last", "Keep All", "Whether only the newest messages are kept."),
        _policy(
            RELIABILITY, "Reliable", "Best Effort", "Whether messages are sent until they arrive."
        ),
        _policy(
            DURABILITY, "Volatile", "Transient Local",
            "Whether late subscriptions get the last messages; those of a tool are kept until "
            "its topic or QoS changes.",
        ),
        Property(FRAME, "frame", "", "The frame of the message; empty: the fixed frame."),
    )  # fmt: skip


def _policy(name: str, default: str, other: str, doc: str) -> Property:
    return Property(name, "choice", default, doc, choices=(_SYSTEM_DEFAULT, default, other))


def _covariance(name: str, default: float, doc: str, unit: str) -> Property:
    return Property(name, "number", default, doc, low=0.0, high=1e6, unit=unit)


def _kinds(all_kinds: Iterable[ToolKind]) -> dict[str, ToolKind]:
    return {one.kind: one for one in all_kinds}


TOOL_KINDS: Final[Mapping[str, ToolKind]] = _kinds((
    ToolKind(
        "Interact", "Interact",
        "Moves the camera, selects links, drags joints and interactive markers.",
        "interact", "I",
        properties=(
            switch(
                "Hide Inactive Objects",
                "While one interactive marker is dragged, the others are hidden.",
                on=True,
            ),
        ),
    ),
    ToolKind("MoveCamera", "Move Camera", "Moves the camera, and nothing else.", "move", "M"),
    ToolKind("Select", "Select", "Selects what is drawn, by a click or in a box.", "select", "S"),
    ToolKind(
        "FocusCamera", "Focus Camera", "Brings what is clicked to the middle of the view.",
        "crosshair", "C",
    ),
    ToolKind(
        "Measure", "Measure", "Measures distances and angles.", "measure", "N",
        properties=(
            Property(
                LINE_COLOR, "colour", "#808000",
                "Colour of the lines; RViz's own stands for that of the theme.",
            ),
        ),
    ),
    ToolKind(
        "SetInitialPose", "2D Pose Estimate",
        "Tells a localization where the robot is: press at the place, drag the direction.",
        "pose", "P", POSE_WITH_COVARIANCE,
        properties=(
            *_topic_properties("/initialpose", "pose estimates"),
            _covariance(COVARIANCES[0], 0.5 * 0.5, "Variance of x.", "m²"),
            _covariance(COVARIANCES[1], 0.5 * 0.5, "Variance of y.", "m²"),
            _covariance(COVARIANCES[2], (math.pi / 12) ** 2, "Variance of the yaw.", "rad²"),
        ),
    ),
    ToolKind(
        "SetGoal", "2D Goal Pose",
        "Sends a robot to a pose: press at the place, drag the direction.",
        "goal", "G", POSE,
        properties=(
            *_topic_properties("/goal_pose", "goals"),
            Property(
                SEND_AS, "choice", "Auto",
                "A message, or a goal of an action; Auto takes the action where it is served.",
                choices=("Auto", "Topic", "Action"),
            ),
            Property(
                ACTION, "text", "/navigate_to_pose",
                f"The action that takes goals, of the type {NAVIGATE_TO_POSE}.",
                when=(SEND_AS, ("Auto", "Action")),
            ),
        ),
    ),
    ToolKind(
        "PublishPoint", "Publish Point", "Publishes the point of a surface that is clicked.",
        "pin", "U", POINT,
        properties=(
            *_topic_properties("/clicked_point", "points"),
            switch(SINGLE_CLICK, "The tool is put away after one click.", on=True),
        ),
    ),
))  # fmt: skip
"""By RViz's class without its package; the order is that of RViz's first set."""


class ToolList:
    """The tools of a document in their order; ids are never given twice.

    An Interact tool is always among them: others return to it.
    """

    def __init__(self) -> None:
        self._tools = {one.id: one for one in default_tools()}
        self._given = len(self._tools)

    def __iter__(self) -> Iterator[ToolSpec]:
        return iter(self._tools.values())

    def get(self, tool: str) -> ToolSpec:
        """Return the one of an id.

        Raises:
            ToolError: There is none any more; so for all that follow.
        """
        if found := self._tools.get(tool):
            return found
        raise ToolError("This tool is not there any more: choose another.")

    def restore(self, tools: Iterable[ToolSpec]) -> None:
        """Have these tools instead, each with an id of its own; none: RViz's first set.

        One of a kind and name that were there keeps its id, for somebody may have it in hand. Kinds
        that are not known are left out, and so are values that their properties do not take.
        """
        wanted = tuple(filter(None, map(_readable, tools))) or default_tools()
        if not any(one.kind == "Interact" for one in wanted):
            wanted = (default_tools()[0], *wanted)
        ids = {(one.kind, one.name): one.id for one in self}
        self._tools.clear()
        for one in wanted[:TOOLS_MAX]:
            self._put(one, ids.pop((one.kind, one.name), ""))

    def renew(self, tools: Iterable[ToolSpec]) -> None:
        """Have these with the ids that they have."""
        self._tools = {one.id: one for one in tools}

    def add(self, kind: str, name: str = "") -> ToolSpec:
        """Add one at the end; without a name it gets that of its kind, or a numbered one.

        Raises:
            ToolError: There are too many, or there is no such kind.
        """
        if len(self._tools) >= TOOLS_MAX:
            raise ToolError(f"There are {TOOLS_MAX} tools: remove one first.")
        return self._put(ToolSpec("", kind, name or self._free_name(kind_of(kind).name)))

    def remove(self, tool: str) -> None:
        """Take one away.

        Raises:
            ToolError: It is the last Interact tool.
        """
        found = self.get(tool)
        others = [one for one in self if one is not found and one.kind == found.kind]
        if found.kind == "Interact" and not others:
            raise ToolError("One Interact tool stays: the other tools return to it.")
        del self._tools[tool]

    def rename(self, tool: str, name: str) -> None:
        """Give one another name.

        Raises:
            ToolError: The name is empty.
        """
        if not name.strip():
            raise ToolError("A tool needs a name of at least one letter.")
        self._tools[tool] = replace(self.get(tool), name=name.strip())

    def set(self, tool: str, name: str, value: object) -> ToolSpec:
        """Change a property.

        Raises:
            ToolError: There is no such property.
            DisplayPropertyError: It does not take the value.
        """
        found = self.get(tool)
        wanted = kind_of(found.kind).property(name)
        checked = wanted.checked(value)
        values = {key: one for key, one in found.values.items() if key != name}
        if checked != wanted.default:
            values[name] = checked
        self._tools[tool] = changed = replace(found, values=values)
        return changed

    def _put(self, spec: ToolSpec, id_: str = "") -> ToolSpec:
        if not id_:
            self._given += 1
            id_ = f"t{self._given}"
        self._tools[id_] = added = replace(spec, id=id_)
        return added

    def _free_name(self, wanted: str) -> str:
        taken = {one.name for one in self}
        names = (wanted, *(f"{wanted} {number}" for number in range(2, TOOLS_MAX + 2)))
        return next(name for name in names if name not in taken)


def _readable(tool: ToolSpec) -> ToolSpec | None:
    """Return what can be used of a tool that was kept; None: nothing."""
    kind = TOOL_KINDS.get(tool.kind)
    if kind is None:
        return None
    values: dict[str, Value] = {}
    for name, value in tool.values.items():
        with suppress(StudioError):
            values[name] = kind.property(name).checked(value)
    return replace(tool, name=tool.name.strip() or kind.name, values=values)
