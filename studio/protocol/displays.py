"""Displays of topics in a document's 3D view, its fixed frame, and TF."""

from __future__ import annotations

from typing import Annotated, Literal, TypeAlias

from pydantic import Field, StringConstraints

from studio.protocol.message import Command, Event, Message

RosName: TypeAlias = Annotated[str, StringConstraints(max_length=300, pattern=r"^[^\x00]*$")]
"""Name of a topic, a frame or a property with its link; checked where it is used."""
ShortName: TypeAlias = Annotated[str, StringConstraints(max_length=80, pattern=r"^[^\x00-\x1f]*$")]
DisplayId: TypeAlias = Annotated[str, StringConstraints(max_length=20)]
GroupPath: TypeAlias = Annotated[str, StringConstraints(max_length=400, pattern=r"^[^\x00-\x1f]*$")]
"""A group in a group is named with the outer ones before it, as `Navigation/Local`."""
PropertyValue: TypeAlias = bool | int | float | str


class AddDisplay(Command):
    """Add a display; with a topic, it listens with what fits the topic's publishers."""

    type: Literal["add_display"] = "add_display"
    kind: ShortName
    topic: RosName = ""


class RemoveDisplay(Command):
    """Remove a display, or a group with all that is in it; `restore_displays` takes it back."""

    type: Literal["remove_display"] = "remove_display"
    display: DisplayId = ""
    group: GroupPath = ""
    """The group as a whole, if `display` is empty."""


class RestoreDisplays(Command):
    """Put displays back that were removed, where they stood and as they were set."""

    type: Literal["restore_displays"] = "restore_displays"
    displays: tuple[DisplayId, ...] = Field(min_length=1, max_length=200)


class DuplicateDisplay(Command):
    """Add one with the same settings, below it."""

    type: Literal["duplicate_display"] = "duplicate_display"
    display: DisplayId


class ArrangeDisplay(Command):
    """Give a display another name, group or place; what is None stays."""

    type: Literal["arrange_display"] = "arrange_display"
    display: DisplayId
    name: ShortName | None = None
    group: GroupPath | None = None
    before: DisplayId | None = None
    """The display that it comes to stand before; empty: at the end."""


class ArrangeGroup(Command):
    """Give a group, with all that is in it, another path or place; what is None stays."""

    type: Literal["arrange_group"] = "arrange_group"
    group: GroupPath
    to: GroupPath | None = None
    """Its new path; empty: it is dissolved. A group that has this path takes its displays in."""
    before: DisplayId | None = None
    """The display that it comes to stand before; empty: at the end."""


class SwitchDisplays(Command):
    """Show or hide displays: one, a group as a whole, or each one of them."""

    type: Literal["switch_displays"] = "switch_displays"
    display: DisplayId = ""
    group: GroupPath = ""
    """The group as a whole, if `display` is empty; if this is empty, too: all displays, each."""
    enabled: bool


class SetDisplayTopic(Command):
    """Subscribe to another topic or with another QoS; None chooses by the topic's publishers."""

    type: Literal["set_display_topic"] = "set_display_topic"
    display: DisplayId
    topic: RosName
    reliable: bool | None = None
    latched: bool | None = None
    depth: int | None = Field(default=None, ge=1, le=10_000)


class SetDisplayProperty(Command):
    """Change a property of a display, by RViz's name."""

    type: Literal["set_display_property"] = "set_display_property"
    display: DisplayId
    name: RosName
    value: PropertyValue


class SetFixedFrame(Command):
    """Draw everything in this frame; empty: in that of the robot's root link."""

    type: Literal["set_fixed_frame"] = "set_fixed_frame"
    frame: RosName


class GetDisplayKinds(Command):
    """Ask for the kinds of displays."""

    type: Literal["get_display_kinds"] = "get_display_kinds"


class GetTopics(Command):
    """Ask for the topics, and the display that shows each."""

    type: Literal["get_topics"] = "get_topics"


class GetTf(Command):
    """Ask for the frames, and for the pose of one in another if both are named."""

    type: Literal["get_tf"] = "get_tf"
    frame: RosName = ""
    seen_from: RosName = ""
    pose_only: bool = False
    """Leaves out the list of frames, so that it may be asked many times a second."""


class FollowFrame(Command):
    """Keep a frame that is no link in the scene for some seconds, for a camera to follow."""

    type: Literal["follow_frame"] = "follow_frame"
    frame: RosName


class DisplayKindView(Message):
    """A kind of display."""

    kind: str
    doc: str
    icon: str
    types: tuple[str, ...]
    """Message types that it shows; none: it subscribes to no topic."""
    plugin: str
    """The file that it comes from, if it is the owner's own."""
    properties: tuple[PropertyView, ...]


class DisplayKinds(Event):
    """Answer to `get_display_kinds`."""

    type: Literal["display_kinds"] = "display_kinds"
    request: int
    kinds: tuple[DisplayKindView, ...]
    plugin_faults: dict[str, str]
    """Why files of the owner's own displays are switched off, by their names."""


class PropertyView(Message):
    """A property of a kind of display."""

    name: str
    kind: Literal[
        "switch", "whole", "number", "colour", "choice", "text", "frame", "topic", "fact",
        "marker_server",
    ]  # fmt: skip
    default: PropertyValue
    doc: str
    low: float | None
    high: float | None
    unit: str
    choices: tuple[str, ...]
    when: str
    """The property that it depends on; empty: none."""
    when_values: tuple[PropertyValue, ...]


class ListeningView(Message):
    """QoS that a display asks for; None: as fits the publishers of its topic."""

    reliable: bool | None
    latched: bool | None
    depth: int | None


class DisplayView(Message):
    """A display as it is set."""

    id: str
    kind: str
    icon: str
    name: str
    group: str
    """Path of the group that it is in; empty: none."""
    enabled: bool
    topic: str
    reliable: bool
    latched: bool
    depth: int
    wished: ListeningView
    """What the user chose; `reliable`, `latched` and `depth` are those in use."""
    values: dict[str, PropertyValue]
    more: tuple[PropertyView, ...]
    """Properties besides those of its kind, such as namespaces of markers received."""


class LiveDisplays(Event):
    """All displays of a document, in order, and the frame they are drawn in."""

    type: Literal["live_displays"] = "live_displays"
    displays: tuple[DisplayView, ...]
    groups_off: tuple[str, ...]
    """Groups that are hidden as a whole, by their paths."""
    fixed_frame: str
    """As chosen; empty: the robot's root link."""
    paused: bool
    """Whether drawing is paused, for all who look at the document."""
    background: str = ""
    """Colour behind the 3D view, as `#rrggbb`; empty: that of the theme."""
    frame_rate: int = 0
    """Pictures of the 3D view per second at most; 0: as many as there can be."""
    kinds: int = 0
    """Another number whenever the kinds of displays are others."""


class Mend(Message):
    """One click that may help."""

    label: str
    command: dict[str, PropertyValue]
    """The command to send, by field, as JSON; the page adds `request` and `document`."""


class Remark(Message):
    """A remark about a display."""

    level: Literal["ok", "warn", "error"]
    reason: str
    sentence: str
    mend: Mend | None = None


class DisplayState(Message):
    """State of a display."""

    id: str
    rate_hz: float
    age_s: float | None
    """Since the last message."""
    received: int
    """Messages on its main topic since it was subscribed."""
    lost: int
    remarks: tuple[Remark, ...]


class FixedFrameState(Message):
    """Whether there is such a frame, as RViz's global status has it."""

    frame: str
    """The one in use."""
    level: Literal["ok", "warn", "error"]
    sentence: str


class DisplayStates(Event):
    """States of all displays; sent when they change, at most twice a second."""

    type: Literal["display_states"] = "display_states"
    states: tuple[DisplayState, ...]
    fixed_frame: FixedFrameState
    fixed_frame_trouble: str
    """Why the robot cannot be drawn in the fixed frame, in a sentence."""


class TopicView(Message):
    """A topic that has a publisher."""

    name: str
    types: tuple[str, ...]
    """Types of its publishers; those of subscriptions do not count."""
    publishers: int
    kind: str
    """The display that shows it; empty: none does."""
    kinds: tuple[str, ...]
    """All displays that can show it, the best first."""


class Topics(Event):
    """Answer to `get_topics`."""

    type: Literal["topics"] = "topics"
    request: int
    topics: tuple[TopicView, ...]


class FrameView(Message):
    """A frame of TF."""

    name: str
    parent: str
    """Empty: it is the root of a tree."""
    publisher: str
    static: bool
    rate_hz: float
    age_s: float | None
    state: Literal["fresh", "stale", "broken"]


class TfPose(Message):
    """Pose of a frame in another."""

    wxyz: tuple[float, float, float, float]
    xyz: tuple[float, float, float]
    """m."""
    chain: tuple[str, ...]
    """Frames from the reference frame to this one, both included."""


class TfFrames(Event):
    """Answer to `get_tf`."""

    type: Literal["tf_frames"] = "tf_frames"
    request: int
    fixed: str
    """The frame that everything is drawn in; one that nothing connects with it is broken."""
    frames: tuple[FrameView, ...]
    more: int
    """Frames that are left out of the list."""
    refused: tuple[str, ...]
    """Transforms that were refused lately, in sentences."""
    pose: TfPose | None
    trouble: str
    """Why there is no pose, in a sentence."""


class FrameFollowed(Event):
    """Answer to `follow_frame`."""

    type: Literal["frame_followed"] = "frame_followed"
    request: int
    trouble: str
    """Why it is not known where the frame is, in a sentence; empty: it is."""
