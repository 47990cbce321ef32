"""RobotModel: a robot from its description, each link where its frame on /tf is."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import islice
from typing import TYPE_CHECKING, ClassVar, Final, Literal, NamedTuple, cast

import numpy as np

from studio.displays.display import Received, Status, StillDisplay, TopicRole, reading_fields
from studio.displays.drawing import NO_TURN, Arrows, Axes, LinkParts, Placed, link_frame
from studio.displays.properties import UPDATE_INTERVAL, Property
from studio.displays.selection import Fact, Item, number_fact, numbers_fact
from studio.displays.trails import Trails
from studio.errors import DisplayError, DisplayMessageError
from studio.robot.rotations import matrix_from_rpy, wxyz_from_matrices
from studio.robot.values import JointType, Robot

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from studio.displays.drawing import Drawing, Lines, Shape
    from studio.displays.properties import Value
    from studio.displays.selection import Picked
    from studio.robot.values import Joint
    from studio.ros.types.library import TypeLibrary
    from studio.tf.frames import FramesNow

LINKS_MAX: Final = 2000
PARTS_MAX: Final = 10_000
"""Shapes of all links."""
_NAME_MAX: Final = 300
_SENTENCE_MAX: Final = 600
"""Limit of texts in a description, which may be of any length."""
DESCRIPTION_MAX: Final = 16_000_000
"""Letters of a description."""
_LINKS: Final = "Links/"
_ALL_LINKS: Final = "Links/All Links Enabled"
_ALPHA: Final = "/Alpha"
_SHOW_AXES: Final = "/Show Axes"
_SHOW_TRAIL: Final = "/Show Trail"
_JOINTS: Final = "Joints/"
_SHOW_AXIS: Final = "/Show Joint Axis"
_JOINT: Final = "/Joint"
_SOURCE: Final = "Description Source"
_PARTS: Final = (
    "Visual Enabled",
    "Collision Enabled",
    "Mass Properties/Mass",
    "Mass Properties/Inertia",
)
# RViz's own, of each link.
_AXIS_LENGTH_M: Final = 0.1
_AXIS_RADIUS_M: Final = 0.01
_TRAIL_M: Final = 2.0
_TRAIL_RGB: Final = (0, 128, 128)
_ARROW_RGB: Final = np.array([0, 204, 0], np.uint8)
_ARROW_M: Final = 0.2
_TURNING: Final = (JointType.REVOLUTE, JointType.CONTINUOUS)
_WITH_AXIS: Final = (*_TURNING, JointType.PRISMATIC, JointType.PLANAR)


class DescriptionSource(NamedTuple):
    """A topic or parameter with a description."""

    kind: Literal["Topic", "Parameter", "File", "Document"]
    where: str = ""
    """The full name of the node, or the file."""
    parameter: str = ""


class RobotModelDisplay(StillDisplay):
    """Takes descriptions and settings; `show` gets the robot that was read from them.

    Attributes:
        description: The last text of the topic; empty before it came.
        robot: What is shown; without links before the first.
    """

    KIND = "RobotModel"
    DOC = "Shows a robot from its description, each link where its frame on /tf is."
    ICON = "robot"
    TOPICS: ClassVar[tuple[TopicRole, ...]] = (
        TopicRole("", ("std_msgs/msg/String",), latched=True, depth=1),
    )
    FIRST_TOPIC = "/robot_description"
    PROPERTIES: ClassVar[tuple[Property, ...]] = (
        Property("Visual Enabled", "switch", default=True, doc="Shows the robot's visuals."),
        Property("Collision Enabled", "switch", default=False, doc="Shows its collision shapes."),
        UPDATE_INTERVAL,
        Property("Alpha", "number", 1.0, "How opaque it is: 0 is not seen.", low=0.0, high=1.0),
        Property(
            _SOURCE, "choice", "Topic", "Where the description comes from.",
            choices=("Topic", "Parameter", "File", "Document"),
        ),
        Property(
            "Description Node", "text", "/robot_state_publisher",
            "The node that has the description as a parameter.", when=(_SOURCE, ("Parameter",)),
        ),
        Property(
            "Description Parameter", "text", "robot_description", "The name of that parameter.",
            when=(_SOURCE, ("Parameter",)),
        ),
        Property(
            "Description File", "text", "", "The file of the description.",
            when=(_SOURCE, ("File",)),
        ),
        Property("TF Prefix", "text", "", "What stands, with a slash, before the frame of a link."),
        Property(
            "Mass Properties/Mass", "switch", default=False, doc="Shows masses as balls of lead."
        ),
        Property(
            "Mass Properties/Inertia", "switch", default=False, doc="Shows inertias as boxes."
        ),
        Property(_ALL_LINKS, "switch", default=True, doc="Shows the links that are on, or none."),
    )  # fmt: skip
    SETTINGS_MAX = 8 * LINKS_MAX

    description = ""
    robot = Robot("")
    _fault = ""
    _left_out = 0

    def __init__(self, types: TypeLibrary, values: Mapping[str, Value] | None = None) -> None:
        super().__init__(types, values)
        self._trails = Trails(length_m=_TRAIL_M)
        self._trailing: tuple[str, ...] = ()
        """Links whose trails are shown."""
        self._fixed = ""
        self._both: tuple[Drawing, Lines | None, Drawing] = ({}, None, {})
        """The links, the trails, and both together as they were drawn last."""

    def properties(self) -> tuple[Property, ...]:
        """Properties of the robot, four of each link and some of each joint that is known."""
        of_links = (
            self._property(f"{_LINKS}{link}{part}")
            for link in self.robot.links
            for part in ("", _ALPHA, _SHOW_AXES, _SHOW_TRAIL)
        )
        of_joints = (
            self._property(f"{_JOINTS}{joint.name}{part}")
            for joint in self.robot.joints.values()
            for part in (_JOINT, _SHOW_AXES, _SHOW_AXIS)
            if part != _SHOW_AXIS or joint.type in _WITH_AXIS
        )
        return (*self.PROPERTIES, *of_links, *of_joints)

    @property
    def wants_frames(self) -> bool:
        """While a trail of a link is shown."""
        return bool(self._trailing)

    def see(self, frames: FramesNow) -> None:
        """Go on with the trails."""
        self._fixed = frames.fixed
        trailing = [self.frame_of(link) for link in self._trailing]
        self._trails.keep(trailing, frames.fixed)
        for frame in trailing:
            pose = frames.pose_of(frame)
            if pose is not None:
                self._trails.add(frame, pose[4:], 0)

    def draw(self, now_ns: int) -> Drawing:
        """Return the links, and the trails of some."""
        drawing = super().draw(now_ns)
        lines = self._trails.lines(_TRAIL_RGB) if self._trailing else None
        if lines is None:
            return drawing
        if self._both[0] is not drawing or self._both[1] is not lines:
            trails = Placed(self._fixed, 0, {"lines": lines}, follows=True)
            self._both = drawing, lines, {**drawing, " trails": trails}
        return self._both[2]

    def changed(self, name: str) -> None:
        """Draw again."""
        self._trailing = tuple(
            link for link in self.robot.links if self.values.get(f"{_LINKS}{link}{_SHOW_TRAIL}")
        )
        super().changed(name)

    def roles(self) -> tuple[TopicRole, ...]:
        """Return its topic, while the description comes from one."""
        return self.TOPICS if self.source.kind == "Topic" else ()

    @property
    def source(self) -> DescriptionSource:
        """The topic or parameter to read."""
        kind = cast('Literal["Topic", "Parameter", "File", "Document"]', self.values[_SOURCE])
        match kind:
            case "Parameter":
                node, name = self.values["Description Node"], self.values["Description Parameter"]
                return DescriptionSource(kind, str(node).strip(), str(name).strip())
            case "File":
                return DescriptionSource(kind, str(self.values["Description File"]).strip())
            case "Topic" | "Document":
                return DescriptionSource(kind)

    def show(self, robot: Robot) -> None:
        """Show this robot from now on; of a very large one the first links.

        Raises:
            DisplayError: It is more than can be drawn; then the one before stays.
        """
        _check(robot)
        self._left_out = max(0, len(robot.links) - LINKS_MAX)
        if self._left_out:
            links = dict(islice(robot.links.items(), LINKS_MAX))
            robot = replace(robot, links=links)
        self.robot = robot
        self.changed("")

    def fail(self, sentence: str) -> None:
        """Why the newest description is not shown, or not as it is; empty when it is."""
        self._fault = sentence[:_SENTENCE_MAX]

    def take(self, received: Received, role: str = "") -> None:
        """Keep a description.

        Raises:
            CdrError: The bytes are no such message.
            DisplayMessageError: The text is no XML, or too long.
        """
        del role
        with reading_fields(received.type_name):
            text = str(self.decode(received).data)
        if len(text) > DESCRIPTION_MAX:
            reason = f"its text has {len(text)} letters, and {DESCRIPTION_MAX} are read"
            raise DisplayMessageError("description", reason)
        if not text.lstrip("\ufeff \t\r\n").startswith("<"):
            raise DisplayMessageError("description", "its text is no XML: choose another topic")
        self.description = text

    def reset(self) -> None:
        """Keep all: a description is as true after a jump of time as before."""

    def frame_of(self, link: str) -> str:
        """Return the frame of a link on /tf."""
        return link_frame(link, str(self.values["TF Prefix"]))

    def statuses(self) -> tuple[Status, ...]:
        """Return what is wrong with the description, and why the robot is invisible."""
        return (*self._of_description(), *self._of_settings())

    def picked(self, picked: Picked) -> Sequence[str]:
        """Return the link that a path is of."""
        return (picked.path,) if picked.path in self.robot.links else ()

    def item(self, key: str) -> Item | None:
        """Return a link that is shown."""
        if key not in self._shown():
            return None
        return Item("link", key, key, self.frame_of(key), 0, None)

    def facts(self, key: str) -> tuple[Fact, ...]:
        """Return what the description says of a link and the joint above it."""
        return link_facts(self.robot, key)

    def _of_description(self) -> tuple[Status, ...]:
        if self._fault:
            return (Status("error", "bad_message", self._fault),)
        if not self.robot.links and (self.description or self.source.kind != "Topic"):
            return (Status("warn", "empty", "The description of the robot is on its way."),)
        if self._left_out:
            sentence = f"{self._left_out:,} links are left out: {LINKS_MAX:,} are shown at most."
            return (Status("warn", "thinned", sentence),)
        return ()

    def _of_settings(self) -> tuple[Status, ...]:
        if not self.values["Alpha"]:
            sentence = "Alpha is 0, so nothing of the robot is seen."
            return (Status("warn", "transparent", sentence, ("Alpha", 1.0)),)
        if not any(self.values[part] for part in _PARTS):
            sentence = "Neither visuals nor collision shapes of the robot are switched on."
            return (Status("warn", "empty", sentence, ("Visual Enabled", True)),)
        links = self.robot.links
        if links and not self._shown():
            off = _ALL_LINKS if not self.values[_ALL_LINKS] else f"{_LINKS}{next(iter(links))}"
            return (Status("warn", "empty", "All links are switched off.", (off, True)),)
        return ()

    def _drawn(self) -> Drawing:
        links = {
            link: Placed(self.frame_of(link), 0, self._shapes_of(link), follows=True)
            for link in self._shown()
        }
        return {**links, **self._joints()}

    def _joints(self) -> dict[str, Placed]:
        """Return the axes of joints where they are mounted on their parent links."""
        drawn: dict[str, Placed] = {}
        for joint in self.robot.joints.values():
            shapes: dict[str, Shape] = {}
            if self.values.get(f"{_JOINTS}{joint.name}{_SHOW_AXES}"):
                shapes["axes"] = _cross()
            if self.values.get(f"{_JOINTS}{joint.name}{_SHOW_AXIS}") and (arrow := _arrow(joint)):
                shapes["axis"] = arrow
            if shapes:
                turn: list[float] = wxyz_from_matrices(
                    matrix_from_rpy(np.nan_to_num(np.array(joint.origin.rpy, np.float64)))
                ).tolist()
                offset = (turn[0], turn[1], turn[2], turn[3]), joint.origin.xyz
                drawn[f" joints/{joint.name}"] = Placed(
                    self.frame_of(joint.parent), 0, shapes, follows=True, offset=offset
                )
        return drawn

    def _shapes_of(self, link: str) -> dict[str, Shape]:
        shapes: dict[str, Shape] = {}
        visual, collision, mass, inertia = (bool(self.values[part]) for part in _PARTS)
        opacity = float(self.values["Alpha"]) * self._alpha_of(link)
        if opacity > 0 and (visual or collision or mass or inertia):
            made = self.robot.links[link]
            shapes["link"] = LinkParts(made, self.robot, visual, collision, mass, inertia, opacity)
        if self.values.get(f"{_LINKS}{link}{_SHOW_AXES}"):
            shapes["axes"] = _cross()
        return shapes

    def _shown(self) -> tuple[str, ...]:
        if not self.values[_ALL_LINKS]:
            return ()
        return tuple(one for one in self.robot.links if self.values.get(f"{_LINKS}{one}", True))

    def _alpha_of(self, link: str) -> float:
        return float(self.values.get(f"{_LINKS}{link}{_ALPHA}", 1.0))

    def _property(self, name: str) -> Property:
        if name.startswith(_JOINTS):
            return self._of_joint(name)
        if name == _ALL_LINKS or not name.startswith(_LINKS):
            return super()._property(name)
        if name.removeprefix(_LINKS) not in self.robot.links:
            if name.endswith(_ALPHA):
                return Property(name, "number", 1.0, "How opaque this link is.", low=0.0, high=1.0)
            if name.endswith(_SHOW_AXES):
                doc = "Shows the axes of this link."
                return Property(name, "switch", default=False, doc=doc)
            if name.endswith(_SHOW_TRAIL):
                doc = "Shows the last two metres of its way."
                return Property(name, "switch", default=False, doc=doc)
        return Property(name, "switch", default=True, doc="Shows this link.")

    def _of_joint(self, name: str) -> Property:
        if name.endswith(_SHOW_AXIS):
            doc = "Shows the axis that this joint turns about or slides along."
            return Property(name, "switch", default=False, doc=doc)
        if name.endswith(_SHOW_AXES):
            return Property(name, "switch", default=False, doc="Shows the axes of this joint.")
        joint = self.robot.joints.get(name.removeprefix(_JOINTS).removesuffix(_JOINT))
        if joint is None or not name.endswith(_JOINT):
            return super()._property(name)
        return Property(name, "fact", words_of(joint), "Its type, its axis and its limits.")


def words_of(joint: Joint) -> str:
    """Return the type, the axis and the limits of a joint, as URDF has them."""
    if joint.type not in _WITH_AXIS:
        return str(joint.type)
    axis = " ".join(f"{one:.4g}" for one in joint.axis)
    words = f"{joint.type}, axis {axis}"
    if joint.limit is None or joint.type in (JointType.CONTINUOUS, JointType.PLANAR):
        return words
    unit = "rad" if joint.type in _TURNING else "m"
    return f"{words}, {joint.limit.lower:.4g} to {joint.limit.upper:.4g} {unit}"


def _cross() -> Axes:
    places, turns = np.zeros((1, 3), np.float32), np.array([NO_TURN], np.float32)
    return Axes(places, turns, _AXIS_LENGTH_M, _AXIS_RADIUS_M)


def _arrow(joint: Joint) -> Arrows | None:
    axis = np.array(joint.axis, np.float64)
    length = float(np.linalg.norm(axis))
    if joint.type not in _WITH_AXIS or not 0.0 < length < math.inf:
        return None
    tip = (axis / length * _ARROW_M).astype(np.float32)
    ends = np.stack((np.zeros(3, np.float32), tip))[None]
    return Arrows(ends, _ARROW_RGB, 0.05, 0.08, 0.05)


def link_facts(robot: Robot, name: str) -> tuple[Fact, ...]:
    """Return the mass of a link, its shapes, and the joint that moves it."""
    link = robot.links.get(name)
    if link is None:
        return ()
    found = [Fact("link", name)]
    joint = next((one for one in robot.joints.values() if one.child == name), None)
    if joint is not None:
        found += [
            Fact("parent", joint.parent), Fact("joint", joint.name), Fact("type", str(joint.type)),
            numbers_fact("axis", joint.axis, "", "vector"),
        ]  # fmt: skip
    if link.inertial is not None:
        found.append(number_fact("mass", link.inertial.mass_kg, "kg"))
    return (*found, Fact("visuals", len(link.visuals)), Fact("collisions", len(link.collisions)))


def _check(robot: Robot) -> None:
    parts = sum(len(one.visuals) + len(one.collisions) for one in robot.links.values())
    if parts > PARTS_MAX:
        raise DisplayError(
            f"The robot has {parts:,} shapes, and {PARTS_MAX:,} are drawn at most: describe it "
            "with meshes instead."
        )
    longest = max(map(len, robot.links), default=0)
    if longest > _NAME_MAX:
        raise DisplayError(
            f"A link has a name of {longest:,} letters: give it one of at most {_NAME_MAX}."
        )
