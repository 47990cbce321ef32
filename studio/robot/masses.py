"""Masses and inertias of links: principal moments, boxes of the same inertia, centres of mass."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from studio.robot.rotations import matrix_from_rpy

if TYPE_CHECKING:
    from studio.robot.kinematics import Kinematics
    from studio.robot.rotations import Floats
    from studio.robot.values import Inertial, Link, Robot, Vector3

Six: TypeAlias = tuple[float, float, float, float, float, float]


@dataclass(frozen=True, slots=True, eq=False)
class InertiaBox:
    """The box of even density with a link's mass and inertia; arrays are read-only.

    A tensor that no body can have gets the nearest box: negative squares become zero.
    """

    link: str
    mass_kg: float
    size_m: Floats
    """Shape (3,), along the principal axes."""
    link_from_box: Floats
    """Shape (4, 4); its translation is the centre of mass."""


@dataclass(frozen=True, slots=True, eq=False)
class Total:
    """Mass of the whole robot and its centre of mass in the world, NaN while it has no mass."""

    mass_kg: float
    centre_m: Floats


def inertia_box(link: Link) -> InertiaBox | None:
    """Return the equivalent box of a link; None when it has no mass."""
    inertial = link.inertial
    if inertial is None or inertial.mass_kg <= 0:
        return None
    moments, axes = _principal(inertial)
    # a box of sides a, b, c: Ix = m (b² + c²) / 12, so a² = 6 (Iy + Iz - Ix) / m
    squares = 6 * (moments.sum() - 2 * moments) / inertial.mass_kg
    link_from_box = _link_from_inertial(inertial)
    link_from_box[:3, :3] = link_from_box[:3, :3] @ axes
    size_m = np.sqrt(np.maximum(squares, 0.0))
    for array in (size_m, link_from_box):
        array.setflags(write=False)
    return InertiaBox(link.name, inertial.mass_kg, size_m, link_from_box)


def total(robot: Robot, kinematics: Kinematics, positions: Floats) -> Total:
    """Mass and centre of mass of the robot in a pose; `positions` as in Kinematics."""
    world_from_links = kinematics.world_from_links(positions)
    mass_kg, moment = 0.0, np.zeros(3)
    for world_from_link, name in zip(world_from_links, kinematics.link_names, strict=True):
        inertial = robot.links[name].inertial
        if inertial is None or inertial.mass_kg <= 0:
            continue
        mass_kg += inertial.mass_kg
        centre = world_from_link @ np.array([*inertial.origin.xyz, 1.0])
        moment += inertial.mass_kg * centre[:3]
    return Total(mass_kg, moment / mass_kg if mass_kg > 0 else np.full(3, np.nan))


def _principal(inertial: Inertial) -> tuple[Floats, Floats]:
    """Principal moments (3,) and their axes as the columns of a rotation (3, 3)."""
    one = inertial
    tensor = np.array(
        [[one.ixx, one.ixy, one.ixz], [one.ixy, one.iyy, one.iyz], [one.ixz, one.iyz, one.izz]]
    )
    if not np.any(tensor - np.diag(np.diagonal(tensor))):  # keep the file's axes, unsorted
        return np.diagonal(tensor).copy(), np.eye(3)
    moments, axes = np.linalg.eigh(tensor)
    axes[:, 2] *= np.sign(np.linalg.det(axes))
    return moments, axes


def _link_from_inertial(inertial: Inertial) -> Floats:
    pose = np.eye(4)
    pose[:3, :3] = matrix_from_rpy(np.array(inertial.origin.rpy))
    pose[:3, 3] = inertial.origin.xyz
    return pose


@dataclass(frozen=True, slots=True)
class LinkMass:
    """Mass and inertia of one link, as written."""

    mass_kg: float
    centre_m: Vector3
    """Centre of mass in the frame of the link."""
    inertia_kg_m2: Six
    """ixx, ixy, ixz, iyy, iyz, izz about the centre, in the axes of the inertial."""
    moments_kg_m2: Vector3 | None
    """Principal, the least first; None where the numbers are too large to be turned."""


def link_mass(link: Link) -> LinkMass | None:
    """Return mass and inertia of a link; None when it has no inertial."""
    one = link.inertial
    if one is None:
        return None
    tensor = (one.ixx, one.ixy, one.ixz, one.iyy, one.iyz, one.izz)
    return LinkMass(one.mass_kg, one.origin.xyz, tensor, principal_moments(one))


@lru_cache(maxsize=16_384)
def principal_moments(inertial: Inertial) -> Vector3 | None:
    """Moments about the axes in which no product of inertia is left, kg m2, the least first.

    An edit leaves most links as they were: theirs are remembered.
    """
    one = inertial
    tensor = np.array(
        [[one.ixx, one.ixy, one.ixz], [one.ixy, one.iyy, one.iyz], [one.ixz, one.iyz, one.izz]]
    )
    with np.errstate(all="ignore"):
        moments = np.linalg.eigvalsh(tensor)
    if not np.isfinite(moments).all():
        return None
    least, middle, most = moments.tolist()
    return least, middle, most
