"""Messages that measure the robot: where its joints stand, what its links weigh."""

from __future__ import annotations

from typing import Literal, TypeAlias

from studio.protocol.message import Command, Event, Message

_Three: TypeAlias = tuple[float, float, float]
_Six: TypeAlias = tuple[float, float, float, float, float, float]


class GetFrames(Command):
    """Where the joints of the last good robot stand; links follow from that and the positions."""

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
    """What the links of the last good robot weigh, and what room their shapes take."""

    type: Literal["get_masses"] = "get_masses"


class VolumeView(Message):
    """Of all visuals or all collisions of a link, m3; not exact: at most that."""

    volume_m3: float
    is_exact: bool


class LinkMassView(Message):
    """A link with an inertial; None stands for what no number can say."""

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
    """In the order of the robot; links without an inertial are not among them."""
