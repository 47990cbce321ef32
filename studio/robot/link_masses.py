"""The inertial of one link as numbers that can be compared."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

if TYPE_CHECKING:
    from studio.robot.values import Inertial, Link, Vector3

Six: TypeAlias = tuple[float, float, float, float, float, float]


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
    """What a link weighs; None when it does not say."""
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
