"""Masses as pictures: the box that turns as a link does, its centre of mass, and the robot's."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from studio.robot.rotations import matrix_from_rpy

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from studio.robot.kinematics import Kinematics
    from studio.robot.values import Inertial, Link, Robot

    Floats: TypeAlias = NDArray[np.float64]


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
    """The equivalent box of a link; None when it has no mass."""
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
