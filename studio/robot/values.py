"""A robot as plain frozen values: the URDF in SI units, nothing computed.

Source: the URDF specification as urdfdom reads it. Angles in rad, lengths in m, masses in kg.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Final, TypeAlias

Vector3: TypeAlias = tuple[float, float, float]
UNBOUNDED: Final = 1e12
"""A limit, rad or m, from which on a joint has none: some robots write 1e16 and mean that."""


@dataclass(frozen=True, slots=True)
class Origin:
    """Pose of a child in its parent: translation in m, then fixed-axis roll, pitch, yaw in rad."""

    xyz: Vector3 = (0.0, 0.0, 0.0)
    rpy: Vector3 = (0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Box:
    """A box centred on its origin."""

    size_m: Vector3


@dataclass(frozen=True, slots=True)
class Cylinder:
    """A cylinder along z, centred on its origin."""

    radius_m: float
    length_m: float


@dataclass(frozen=True, slots=True)
class Sphere:
    """A sphere centred on its origin."""

    radius_m: float


@dataclass(frozen=True, slots=True)
class Mesh:
    """A mesh file by its URI as written, scaled per axis."""

    uri: str
    scale: Vector3 = (1.0, 1.0, 1.0)


Geometry: TypeAlias = Box | Cylinder | Sphere | Mesh


@dataclass(frozen=True, slots=True)
class Material:
    """A colour (RGBA in [0, 1]) and a texture URI; either may be missing."""

    name: str = ""
    rgba: tuple[float, float, float, float] | None = None
    texture_uri: str = ""


@dataclass(frozen=True, slots=True)
class Visual:
    """Shape and material to draw; `material` may be a mere name, one of the robot's materials."""

    origin: Origin
    geometry: Geometry
    material: Material | None = None
    name: str = ""


@dataclass(frozen=True, slots=True)
class Collision:
    """Shape for collisions."""

    origin: Origin
    geometry: Geometry
    name: str = ""


@dataclass(frozen=True, slots=True)
class Inertial:
    """Mass and rotational inertia about the centre of mass, in the axes of `origin`."""

    origin: Origin
    mass_kg: float
    ixx: float = 0.0
    ixy: float = 0.0
    ixz: float = 0.0
    iyy: float = 0.0
    iyz: float = 0.0
    izz: float = 0.0


@dataclass(frozen=True, slots=True)
class Link:
    """One rigid body."""

    name: str
    visuals: tuple[Visual, ...] = ()
    collisions: tuple[Collision, ...] = ()
    inertial: Inertial | None = None


class JointType(StrEnum):
    """The six joint types of URDF."""

    FIXED = "fixed"
    REVOLUTE = "revolute"
    CONTINUOUS = "continuous"
    PRISMATIC = "prismatic"
    PLANAR = "planar"
    FLOATING = "floating"


@dataclass(frozen=True, slots=True)
class Limit:
    """Joint limits: rad or m, N m or N, rad/s or m/s."""

    lower: float = 0.0
    upper: float = 0.0
    effort: float = 0.0
    velocity: float = 0.0

    @property
    def bounds(self) -> tuple[float, float]:
        """Least and greatest position; infinite where a number is so large that it bounds none."""
        return (
            self.lower if self.lower > -UNBOUNDED else -math.inf,
            self.upper if self.upper < UNBOUNDED else math.inf,
        )


@dataclass(frozen=True, slots=True)
class Mimic:
    """This joint follows another: position = multiplier * other + offset."""

    joint: str
    multiplier: float = 1.0
    offset: float = 0.0


@dataclass(frozen=True, slots=True)
class Joint:
    """Joins `child` to `parent`; `axis` is in the joint frame and need not be normalised here."""

    name: str
    type: JointType
    parent: str
    child: str
    origin: Origin = Origin()
    axis: Vector3 = (1.0, 0.0, 0.0)
    limit: Limit | None = None
    mimic: Mimic | None = None


@dataclass(frozen=True, slots=True)
class Robot:
    """A whole robot: links and joints in document order, materials by name."""

    name: str
    links: dict[str, Link] = field(default_factory=dict[str, Link])
    joints: dict[str, Joint] = field(default_factory=dict[str, Joint])
    materials: dict[str, Material] = field(default_factory=dict[str, Material])

    @property
    def root(self) -> str:
        """The first link that hangs on no other; empty where there is none."""
        children = {joint.child for joint in self.joints.values()}
        return next((name for name in self.links if name not in children), "")
