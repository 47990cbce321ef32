"""Displays of topics in a document's 3D view, its fixed frame, and TF."""

from __future__ import annotations

from typing import Annotated, Literal, TypeAlias

from pydantic import Field, StringConstraints

from studio.protocol.message import Command, Event, Message

RosName: TypeAlias = Annotated[str, StringConstraints(max_length=300, pattern=r"^[^\x00]*$")]
"""Name of a topic, a frame or a property with its link; checked where it is used."""
ShortName: TypeAlias = Annotated[str, StringConstraints(max_length=80, pattern=r"^[^\x00-\x1f]*$")]
DisplayId: TypeAlias = Annotated[str, StringConstraints(max_length=20)]
PropertyValue: TypeAlias = bool | int | float | str


class AddDisplay(Command):
    """Add a display; with a topic, it listens with what fits the topic's publishers."""

    type: Literal["add_display"] = "add_display"
    kind: ShortName
    topic: RosName = ""


class RemoveDisplay(Command):
    """Remove a display."""

    type: Literal["remove_display"] = "remove_display"
    display: DisplayId


class DuplicateDisplay(Command):
    """Add one with the same settings, below it."""

    type: Literal["duplicate_display"] = "duplicate_display"
    display: DisplayId


class ArrangeDisplay(Command):
    """Give a display another name, group or place; what is None stays."""

    type: Literal["arrange_display"] = "arrange_display"
    display: DisplayId
    name: ShortName | None = None
    group: ShortName | None = None
    before: DisplayId | None = None
    """The display that it comes to stand before; empty: at the end."""


class SwitchDisplays(Command):
    """Show or hide displays: one, or all of a group."""

    type: Literal["switch_displays"] = "switch_displays"
    display: DisplayId = ""
    group: ShortName = ""
    """The group as a whole, if `display` is empty."""
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
    kind: Literal["switch", "whole", "number", "colour", "choice", "text", "frame", "topic", "fact"]
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
    """Groups that are hidden as a whole."""
    fixed_frame: str
    """As chosen; empty: the robot's root link."""
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
    lost: int
    remarks: tuple[Remark, ...]


class DisplayStates(Event):
    """States of all displays; sent when they change, at most twice a second."""

    type: Literal["display_states"] = "display_states"
    states: tuple[DisplayState, ...]
    fixed_frame_trouble: str
    """Why nothing can be drawn in the fixed frame, in a sentence."""


class TopicView(Message):
    """A topic that has a publisher."""

    name: str
    types: tuple[str, ...]
    """Types of its publishers; those of subscriptions do not count."""
    publishers: int
    kind: str
    """The display that shows it; empty: none does."""


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
