"""The connection to a ROS system, and what of a robot goes out to it and comes in from it."""

from __future__ import annotations

from typing import Literal, TypeAlias

from pydantic import Field

from studio.protocol.message import Command, Event, Message

JointSource: TypeAlias = Literal["sliders", "animation", "joint_states", "tf"]
"""What moves the joints: one of these at a time."""


Distro: TypeAlias = Literal["", "humble", "jazzy", "kilted"]


class WirePlace(Command):
    """A ROS 2 system: router, domain and distribution; what is left out stays as it is."""

    address: str = Field(default="", max_length=300)
    """`robot.local`, `192.0.2.7:7447`, or an endpoint as Zenoh writes it."""
    domain: int | None = Field(default=None, ge=0, le=232)
    distro: Distro = ""


class ConnectWire(WirePlace):
    """Join the ROS 2 system, if that was not done yet; done when the connection stands.

    Another place than that of now: what uses the connection lets go of it before.
    """

    type: Literal["connect_wire"] = "connect_wire"


class ExamineWire(WirePlace):
    """Ask what there is at a router; nothing is joined or started."""

    type: Literal["examine_wire"] = "examine_wire"


class DisconnectWire(Command):
    """Leave the ROS 2 system: all that went out or came in for any document ends before."""

    type: Literal["disconnect_wire"] = "disconnect_wire"


class SetJointSource(Command):
    """Choose who moves the joints."""

    type: Literal["set_joint_source"] = "set_joint_source"
    source: JointSource


class PublishRobot(Command):
    """Publish `/robot_description` and TF as robot_state_publisher does, or stop."""

    type: Literal["publish_robot"] = "publish_robot"
    running: bool


class PublishJoints(Command):
    """Publish `/joint_states` as joint_state_publisher does, or stop."""

    type: Literal["publish_joints"] = "publish_joints"
    running: bool


class FindWireRobots(Command):
    """Ask for the robot descriptions in the ROS system."""

    type: Literal["find_wire_robots"] = "find_wire_robots"


class OpenFromWire(Command):
    """Open a robot whose description comes from a topic, or from a parameter of a node."""

    type: Literal["open_from_wire"] = "open_from_wire"
    topic: str = Field(default="/robot_description", max_length=300)
    node: str = Field(default="", max_length=300)
    """Full name; empty: take the topic."""
    parameter: str = Field(default="robot_description", max_length=300)


BridgeState: TypeAlias = Literal["used", "other_domain", "empty", "twin"]
"""`other_domain`: it passes on another domain, so it is not used; `empty`: no node on DDS is seen
behind it; `twin`: another bridge in the same DDS domain shows all its nodes."""


class SlowedTopics(Message):
    """Topics of which a bridge passes on so many messages a second at most."""

    topics: str
    """A regular expression."""
    rate_hz: float


class BridgeView(Message):
    """A bridge between DDS and Zenoh, as it was started and what is behind it."""

    name: str
    """Its namespace, else the machine of its nodes."""
    version: str
    """Such as `1.10.0`; empty: it does not tell it."""
    domain: int | None
    """Of DDS; None: it does not tell it."""
    namespace: str
    """In front of all its names; `/` without."""
    node_count: int
    """Nodes on DDS behind it, without those that another bridge shows as well."""
    fast_dds_count: int
    """Those of them on Fast DDS: of these the bridge brings topics only."""
    hosts: tuple[str, ...]
    """The machines of its nodes; the first ones."""
    state: BridgeState
    twin: str
    """The bridge that shows some of the same nodes, or all; empty: none does."""
    allows: bool
    """Whether `rules` are what is let through, and not what is kept out."""
    rules: tuple[str, ...]
    """Its allow or deny list, as `publishers: /scan|/tf`; empty: it has none."""
    withheld: tuple[str, ...]
    """Topics, services and actions of its nodes that it does not let through; the first ones."""
    withheld_count: int
    slowed: tuple[SlowedTopics, ...]
    localhost_only: bool
    """Whether it meets only nodes of its own machine."""


class WireState(Event):
    """State of the studio's connection to a ROS 2 system; sent to every page."""

    type: Literal["wire_state"] = "wire_state"
    state: Literal["off", "connecting", "connected", "lost", "failed"]
    """`lost`: the router went away; it is joined again by itself as soon as it is back."""
    router: Literal["", "own", "joined"]
    """Of the router: started by the studio, or found there."""
    endpoint: str
    domain: int
    distro: str
    nodes: tuple[str, ...]
    """Full names, without the studio's own; the first ones."""
    node_count: int
    behind: dict[str, str]
    """Those of `nodes` that are on DDS, each with the name of its bridge."""
    bridges: tuple[BridgeView, ...]
    """The first ones, also of other domains."""
    nearby_count: int
    """While not connected: nodes that are met at the router of this machine."""
    trouble: str
    """Why it failed, in a sentence."""


class WireFeed(Event):
    """What of a document's robot comes from ROS, and what is published."""

    type: Literal["wire_feed"] = "wire_feed"
    source: Literal["sliders", "joint_states", "tf"]
    """`sliders`: the page moves them; whether they swing is in `joints`."""
    source_state: Literal["", "waiting", "live", "silent"]
    """Of a topic as source: nothing came yet, messages come, or they came and stopped."""
    rate_hz: int
    """Messages of the last second."""
    strangers: tuple[str, ...]
    """Joints that came and that the robot does not have; the first ones."""
    publishes_robot: bool
    publishes_joints: bool
    joints_paused: bool
    """The joints are not published: they follow `/joint_states`, so it would be an echo."""
    rivals: tuple[str, ...]
    """Nodes that publish what this robot publishes; the first ones."""
    description_from: str
    """The topic or parameter that the description comes from; empty: from files."""
    trouble: str
    """What is wrong with the description, in a sentence."""


class WireRobots(Event):
    """Answer to `find_wire_robots`: topics with a robot description, the usual one first."""

    type: Literal["wire_robots"] = "wire_robots"
    request: int
    topics: tuple[str, ...]
    nodes: tuple[str, ...]
    """Full names of nodes that may have one as a parameter."""


Verdict: TypeAlias = Literal[
    "fine",
    "no_router",
    "foreign",
    "not_admitted",
    "alone",
    "other_domain",
    "other_distro",
    "bridge",
    "unseen",
]
"""`foreign`: something else holds the place; `not_admitted`: the router wants another name or
certificate; `alone`: a router without nodes; `bridge`: only one for DDS, behind which no node is
seen; `other_distro`: nodes are there, and types of theirs have another form; `unseen`: processes
publish, whose nodes the router does not show, for it is newer than they are."""


class DomainView(Message):
    """The number of other nodes in a domain."""

    domain: int
    nodes: int


class WireReport(Event):
    """Answer to `examine_wire`: what there is at a router, and why nodes are not seen."""

    type: Literal["wire_report"] = "wire_report"
    request: int
    endpoint: str
    domain: int
    distro: str
    """The studio's own."""
    verdict: Verdict
    starts_router: bool
    """Connecting would start a router here."""
    nodes: int
    """Other nodes in the domain, also those on DDS behind bridges."""
    domains: tuple[DomainView, ...]
    """Domains with nodes, sorted; the first ones."""
    distros: tuple[str, ...]
    """Distributions whose types the nodes of the domain have, as far as they show it: nodes on DDS
    that tell no hashes are as those of Humble."""
    types: tuple[str, ...]
    """Types whose hash differs from the studio's; the first ones."""
    unseen: int
    """Processes that publish in the domain, while none of their nodes is seen."""
    bridges: tuple[BridgeView, ...]
    """Bridges to DDS that are met there; the first ones."""
