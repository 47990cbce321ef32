"""Messages about the robot that is drawn: its tree, its joints and how it is displayed."""

from __future__ import annotations

from typing import Literal

from studio.protocol.message import Command, Event, Message


class SetJoints(Command):
    """Move joints: positions by name, rad or m; clamped to the limits, mimics follow."""

    type: Literal["set_joints"] = "set_joints"
    positions: dict[str, float]


class ZeroJoints(Command):
    """All joints to zero, or to the nearest position within their limits."""

    type: Literal["zero_joints"] = "zero_joints"


class RandomizeJoints(Command):
    """All joints to random positions within their limits."""

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
    """How far this one moves for one unit of the joint that it mimics."""
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
