"""The inertia that a link would have if it were solid and of even density."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, TypeAlias

import numpy as np

from studio.robot.checks.finding import SetAttributes
from studio.robot.rotations import matrix_from_rpy
from studio.robot.values import Box, Cylinder, Sphere

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from studio.robot.checks.extents import Extent
    from studio.robot.values import Inertial, Link, Vector3

    Floats: TypeAlias = NDArray[np.float64]

_ENTRIES: Final = {
    "ixx": (0, 0),
    "ixy": (0, 1),
    "ixz": (0, 2),
    "iyy": (1, 1),
    "iyz": (1, 2),
    "izz": (2, 2),
}


def inertia_mend(link: Link, extent: Extent) -> SetAttributes | None:
    """Write the inertia of the link's shape at its mass; None when the shape is not known.

    Of a single box, cylinder or sphere its own, else that of the box around the link. The centre
    of mass stays where it is.
    """
    inertial, box = link.inertial, extent.whole
    if inertial is None or inertial.mass_kg <= 0 or box is None:
        return None
    solid = _only_primitive(link)
    if solid is None:
        x, y, z = (box[1] - box[0]).tolist()
        shape, rpy = Box((x, y, z)), (0.0, 0.0, 0.0)
    else:
        shape, rpy = solid
    per_kg = _moments_per_kg(shape)
    if not per_kg.all():
        return None
    tensor = _in_axes_of(inertial, rpy, inertial.mass_kg * per_kg)
    texts = tuple((name, f"{_rounded(tensor, i, j):.6g}") for name, (i, j) in _ENTRIES.items())
    label = f"Take a solid {type(shape).__name__.lower()}'s inertia"
    return SetAttributes(label, ("inertial", "inertia"), texts, is_for_one=True)


def _only_primitive(link: Link) -> tuple[Box | Cylinder | Sphere, Vector3] | None:
    """The one geometry that the link touches with, else looks like, and how it is turned."""
    for side in (link.collisions, link.visuals):
        if len(side) == 1 and isinstance(side[0].geometry, Box | Cylinder | Sphere):
            return side[0].geometry, side[0].origin.rpy
        if side:
            return None
    return None


def _moments_per_kg(shape: Box | Cylinder | Sphere) -> Floats:
    """Moments about the axes of a solid through its centre, (3,), m²."""
    match shape:
        case Box((x, y, z)):
            return np.array([y * y + z * z, x * x + z * z, x * x + y * y]) / 12
        case Cylinder(radius_m, length_m):
            across = (3 * radius_m**2 + length_m**2) / 12
            return np.array([across, across, radius_m**2 / 2])
        case Sphere(radius_m):
            return np.full(3, 0.4 * radius_m**2)


def _in_axes_of(inertial: Inertial, rpy: Vector3, moments: Floats) -> Floats:
    """The tensor (3, 3) of moments about a turned solid's axes, in the axes of the inertial."""
    link_from_solid = matrix_from_rpy(np.array(rpy))
    link_from_inertial = matrix_from_rpy(np.array(inertial.origin.rpy))
    turn = link_from_inertial.T @ link_from_solid
    return turn @ np.diag(moments) @ turn.T


def _rounded(tensor: Floats, i: int, j: int) -> float:
    """An entry, without the dust that turning leaves off the diagonal."""
    entry = float(tensor[i, j])
    return 0.0 if abs(entry) < 1e-9 * float(np.trace(tensor)) else entry
