"""The robot of a document: links, joints, frames, masses, poses, and what is shown of it."""

from __future__ import annotations

from typing import Literal, TypeAlias

from pydantic import Field

from studio.protocol.message import Command, Event, Message


class SetJoints(Command):
    """Move joints: positions by name, rad or m; clamped to the limits, mimics follow."""

    type: Literal["set_joints"] = "set_joints"
    positions: dict[str, float]


class ZeroJoints(Command):
    """Move all joints to zero, or to the nearest position within their limits."""

    type: Literal["zero_joints"] = "zero_joints"


class RandomizeJoints(Command):
    """Move all joints to random positions within their limits."""

    type: Literal["randomize_joints"] = "randomize_joints"


class AnimateJoints(Command):
    """Swing the joints through their limits, or stop."""

    type: Literal["animate_joints"] = "animate_joints"
    running: bool


class SetDisplay(Command):
    """Change one setting of a shared display, e.g. `robot`, `collision`, True."""

    type: Literal["set_display"] = "set_display"
    display: Literal["grid", "robot", "ghost"]
    name: str
    value: bool | float | str


class LinkView(Message):
    """One link as the page lists it; the parent joint is in the joints."""

    name: str
    visuals: int
    collisions: int
    mass_kg: float | None
    meshes: tuple[str, ...]
    file: str
    line: int
    macros: tuple[str, ...]


class JointView(Message):
    """One joint as the page shows and drags it; rad or m; `axis` normalised, in the child frame."""

    name: str
    type: Literal["fixed", "revolute", "continuous", "prismatic", "planar", "floating"]
    parent: str
    child: str
    axis: tuple[float, float, float]
    lower: float | None
    upper: float | None
    mimic: str
    """Name of the joint that moves this one; empty when it is free."""
    multiplier: float = 1.0
    """Motion of this joint for one unit of the joint that it mimics."""
    file: str
    line: int


class RobotState(Event):
    """The robot's tree. `revision` counts structural changes; joint frames carry it."""

    type: Literal["robot"] = "robot"
    revision: int
    name: str
    root: str
    links: tuple[LinkView, ...]
    joints: tuple[JointView, ...]


class JointPositions(Event):
    """Positions of all movable joints by name, after a command; streams are binary frames."""

    type: Literal["joints"] = "joints"
    positions: dict[str, float]
    animating: bool


class Displays(Event):
    """The shared display settings: display, then setting, then value."""

    type: Literal["displays"] = "displays"
    displays: dict[str, dict[str, bool | float | str]]


class PoseView(Message):
    """One named pose as the page lists it."""

    key: str
    """The name that commands use."""
    name: str
    group: str
    """The planning group of an SRDF that it is stated for; empty: none."""
    kind: Literal["own", "srdf", "initial"]
    """Saved here, a group state of an SRDF, or a file of initial positions."""
    file: str
    line: int
    positions: dict[str, float]
    """By freely moving joint of the robot, rad or m."""
    unknown: tuple[str, ...]
    """Joints that the robot does not have, or that take no single number; the first ones."""
    unknown_count: int
    beyond: tuple[str, ...]
    """Joints whose limits do not let them go so far; the first ones."""


class Poses(Event):
    """All named poses that fit the robot."""

    type: Literal["poses"] = "poses"
    poses: tuple[PoseView, ...]
    path: str
    """The file that one's own are kept in."""
    only_here: str
    """Why one's own are kept for this session only; empty: they are in the file."""
    trouble: str
    """What is wrong with that file, in a sentence."""


class ApplyPose(Command):
    """Move the joints to a named pose; joints that it does not name stay."""

    type: Literal["apply_pose"] = "apply_pose"
    key: str = Field(max_length=5000)
    duration_s: float = Field(default=0.0, ge=0.0, le=5.0)
    """Duration of the motion; 0: at once."""


class SavePose(Command):
    """Keep where the joints are under a name; with `replace` also under one that there is."""

    type: Literal["save_pose"] = "save_pose"
    name: str = Field(max_length=100)
    replace: bool = False


class RenamePose(Command):
    """Give one's own pose another name."""

    type: Literal["rename_pose"] = "rename_pose"
    name: str = Field(max_length=100)
    new_name: str = Field(max_length=100)


class DeletePose(Command):
    """Forget one's own pose; the joints stay where they are."""

    type: Literal["delete_pose"] = "delete_pose"
    name: str = Field(max_length=100)


_Three: TypeAlias = tuple[float, float, float]
_Six: TypeAlias = tuple[float, float, float, float, float, float]


class GetFrames(Command):
    """Ask for the frames of the joints of the last good robot; links follow from the positions."""

    type: Literal["get_frames"] = "get_frames"


class Frames(Event):
    """Answer to `get_frames`, true of the robot now: ask again when something was built.

    By joint the frame of the joint in its parent link: x, y, z in m, then roll, pitch, yaw in rad.
    """

    type: Literal["frames"] = "frames"
    request: int
    revision: int
    """As in `robot`."""
    origins: dict[str, _Six]


class GetMasses(Command):
    """Ask for the masses of the links of the last good robot, and the volumes of their shapes."""

    type: Literal["get_masses"] = "get_masses"


class VolumeView(Message):
    """Volume of all visuals or all collisions of a link, m3; an upper bound."""

    volume_m3: float
    is_exact: bool


class LinkMassView(Message):
    """A link with an inertial; None where no number can be given."""

    link: str
    mass_kg: float
    centre_m: _Three
    """Centre of mass in the frame of the link."""
    moments_kg_m2: _Three | None
    """Principal, the least first."""
    inertia_kg_m2: _Six
    """ixx, ixy, ixz, iyy, iyz, izz as written: about the centre, in the axes of the inertial."""
    visual: VolumeView | None
    """None without such shapes, and while the size of a mesh is not known."""
    collision: VolumeView | None


class Masses(Event):
    """Answer to `get_masses`, true of the robot now: ask again when something was built."""

    type: Literal["masses"] = "masses"
    request: int
    links: tuple[LinkMassView, ...]
    """In the order of the robot, without links that have no inertial."""
