"""Messages about ROS 2 on the wire: the connection, and what of a robot goes out and comes in."""

from __future__ import annotations

from typing import Literal, TypeAlias

from pydantic import Field

from studio.engine.messages.message import CommandMessage, Message

JointSource: TypeAlias = Literal["sliders", "animation", "joint_states", "tf"]
"""Who moves the joints: one of these at a time."""


class ConnectWire(CommandMessage):
    """Join the ROS 2 system, if that was not done yet; done when the connection stands."""

    type: Literal["connect_wire"] = "connect_wire"


class DisconnectWire(CommandMessage):
    """Leave the ROS 2 system: all that went out or came in for any document ends before."""

    type: Literal["disconnect_wire"] = "disconnect_wire"


class SetJointSource(CommandMessage):
    """Choose who moves the joints."""

    type: Literal["set_joint_source"] = "set_joint_source"
    source: JointSource


class PublishRobot(CommandMessage):
    """Publish `/robot_description` and TF as robot_state_publisher does, or stop."""

    type: Literal["publish_robot"] = "publish_robot"
    running: bool


class PublishJoints(CommandMessage):
    """Publish `/joint_states` as joint_state_publisher does, or stop."""

    type: Literal["publish_joints"] = "publish_joints"
    running: bool


class FindWireRobots(CommandMessage):
    """Look which robot descriptions there are on the wire."""

    type: Literal["find_wire_robots"] = "find_wire_robots"


class OpenFromWire(CommandMessage):
    """Open a robot whose description comes from a topic, or from a parameter of a node."""

    type: Literal["open_from_wire"] = "open_from_wire"
    topic: str = Field(default="/robot_description", max_length=300)
    node: str = Field(default="", max_length=300)
    """Full name; empty: take the topic."""
    parameter: str = Field(default="robot_description", max_length=300)


WireCommand: TypeAlias = (
    ConnectWire
    | DisconnectWire
    | SetJointSource
    | PublishRobot
    | PublishJoints
    | FindWireRobots
    | OpenFromWire
)


class WireState(Message):
    """How the studio is connected with a ROS 2 system; told to every page."""

    type: Literal["wire_state"] = "wire_state"
    state: Literal["off", "connecting", "connected", "lost", "failed"]
    """`lost`: the router went away; it is joined again by itself as soon as it is back."""
    router: Literal["", "own", "joined"]
    """Whose router it is: one that the studio started, or one that was there."""
    endpoint: str
    domain: int
    distro: str
    nodes: tuple[str, ...]
    """Full names, without the studio's own; the first ones."""
    node_count: int
    trouble: str
    """Why it failed, in a sentence."""


class WireFeed(Message):
    """What of a document's robot comes from the wire, and what goes there."""

    type: Literal["wire_feed"] = "wire_feed"
    source: Literal["sliders", "joint_states", "tf"]
    """`sliders`: whoever moves them here; whether they swing is told by `joints`."""
    source_state: Literal["", "waiting", "live", "silent"]
    """Of a source on the wire: nothing came yet, it comes, or it came and does not any more."""
    rate_hz: int
    """Messages of the last second."""
    strangers: tuple[str, ...]
    """Joints that came and that the robot does not have; the first ones."""
    publishes_robot: bool
    publishes_joints: bool
    joints_paused: bool
    """Nothing of them goes out now: they follow `/joint_states`, and would be an echo."""
    rivals: tuple[str, ...]
    """Nodes that publish what this robot publishes; the first ones."""
    description_from: str
    """The topic or parameter that the description comes from; empty: from files."""
    trouble: str
    """What is wrong with it, in a sentence."""


class WireRobots(Message):
    """Answer to `find_wire_robots`: topics with a robot description, the usual one first."""

    type: Literal["wire_robots"] = "wire_robots"
    request: int
    topics: tuple[str, ...]
    nodes: tuple[str, ...]
    """Full names of nodes that may have one as a parameter."""


WireEvent: TypeAlias = WireState | WireFeed | WireRobots
