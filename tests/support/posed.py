"""A small arm with its joints, as OwnFrames needs it of a document's model."""

from __future__ import annotations

from dataclasses import dataclass, field

from studio.documents.model import JointPositions
from studio.robot.kinematics import Kinematics
from studio.robot.values import Box, Joint, JointType, Limit, Link, Origin, Robot, Visual

LIMIT = Limit(lower=-1.0, upper=1.0, effort=1.0, velocity=1.0)


def arm(reach_m: float = 0.5, tip: str = "tip") -> Robot:
    """A shoulder that turns about x, and a tip beside it."""
    links = {name: Link(name) for name in ("base", "upper", tip)}
    shoulder = Joint("shoulder", JointType.REVOLUTE, "base", "upper", limit=LIMIT)
    mount = Joint("mount", JointType.FIXED, "upper", tip, Origin((reach_m, 0.0, 0.0)))
    return Robot("arm", links, {"shoulder": shoulder, "mount": mount})


def seen_arm() -> Robot:
    """The same, each link a box; its last joint slides."""
    made = arm()
    box = (Visual(Origin(), Box((0.1, 0.1, 0.1))),)
    links = {name: Link(name, visuals=box) for name in (*made.links, "hand")}
    slide = Joint("slide", JointType.PRISMATIC, "tip", "hand", axis=(0.0, 0.0, 1.0), limit=LIMIT)
    return Robot("arm", links, {**made.joints, "slide": slide})


@dataclass
class Posed:
    """A robot with its joints at 0."""

    robot: Robot
    kinematics: Kinematics = field(init=False)
    joints: JointPositions = field(init=False)

    def __post_init__(self) -> None:
        self.become(self.robot)

    def become(self, robot: Robot) -> None:
        """Be another robot."""
        self.robot, self.kinematics = robot, Kinematics(robot)
        self.joints = JointPositions(self.kinematics)
