"""A robot as a whole: how heavy, how far it reaches, how large it is in a pose."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, TypeAlias

import numpy as np

from studio.robot.difference_rows import Row, number_row, text_row, vector_rows
from studio.robot.rotations import matrix_from_rpy
from studio.robot.values import Box, Cylinder, JointType, Mesh, Sphere

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from studio.robot.kinematics import Kinematics
    from studio.robot.values import Geometry, Joint, Link, Robot, Vector3

    Floats: TypeAlias = NDArray[np.float64]

Bounds: TypeAlias = "tuple[Vector3, Vector3]"
"""Least and greatest corner, m."""
_SIGNS: Final = np.array(list(itertools.product((-1.0, 1.0), repeat=3)))


@dataclass(frozen=True, slots=True)
class Measures:
    """What a robot comes to; `box` is None while one of its meshes is not known."""

    name: str
    links: int
    joints: int
    mass_kg: float
    reach_m: float
    box: Bounds | None


def measure(
    robot: Robot,
    kinematics: Kinematics,
    positions: Floats,
    mesh_bounds: Callable[[str], Bounds | None],
) -> Measures:
    """Measure a robot in a pose.

    Args:
        robot: What the kinematics are of.
        kinematics: Where its links are.
        positions: Of its movable joints, as in Kinematics.
        mesh_bounds: Of a mesh file by its URI, unscaled; None when it is not known.
    """
    inertials = (link.inertial for link in robot.links.values())
    return Measures(
        name=robot.name,
        links=len(robot.links),
        joints=len(robot.joints),
        mass_kg=math.fsum(one.mass_kg for one in inertials if one and math.isfinite(one.mass_kg)),
        reach_m=reach_m(robot),
        box=box_around(robot, kinematics, positions, mesh_bounds),
    )


def whole_rows(one: Measures, other: Measures) -> tuple[Row, ...]:
    """What differs between two robots as a whole."""
    rows = [*text_row("name", one.name, other.name)]
    rows += number_row("links", one.links, other.links, "")
    rows += number_row("joints", one.joints, other.joints, "")
    rows += number_row("total_mass", one.mass_kg, other.mass_kg, "kg")
    rows += number_row("reach", one.reach_m, other.reach_m, "m")
    if one.box and other.box:
        rows += vector_rows("size", _size(one.box), _size(other.box), "m")
    return tuple(rows)


def _size(box: Bounds) -> tuple[float, ...]:
    return tuple(high - low for low, high in zip(*box, strict=True))


def reach_m(robot: Robot) -> float:
    """Length of the longest chain of joints from a root, stretched out, slides drawn out."""
    steps = {joint.child: (joint.parent, _step_m(joint)) for joint in robot.joints.values()}
    known: dict[str, float] = {}
    for link in robot.links:
        path: list[str] = []
        at = link
        while at not in known and at in steps and at not in path:
            path.append(at)
            at = steps[at][0]
        length_m = known.setdefault(at, 0.0)
        for one in reversed(path):
            length_m = known[one] = length_m + steps[one][1]
    return max(known.values(), default=0.0)


def _step_m(joint: Joint) -> float:
    step_m = math.hypot(*joint.origin.xyz)
    if joint.type is JointType.PRISMATIC and joint.limit:
        bounds_m = map(abs, joint.limit.bounds)
        step_m += max((one for one in bounds_m if math.isfinite(one)), default=0.0)
    return step_m if math.isfinite(step_m) else 0.0


def box_around(
    robot: Robot,
    kinematics: Kinematics,
    positions: Floats,
    mesh_bounds: Callable[[str], Bounds | None],
) -> Bounds | None:
    """The box around all visuals in a pose, in the root's frame; arguments as for `measure`.

    Returns:
        None while a mesh is not known, for a robot without visuals, and where numbers are none.
    """
    world_from_links = kinematics.world_from_links(positions)
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    for world_from_link, name in zip(world_from_links, kinematics.link_names, strict=True):
        corners_link = _link_corners(robot.links[name], mesh_bounds)
        if corners_link is None:
            return None
        if len(corners_link):
            corners = corners_link @ world_from_link[:3, :3].T + world_from_link[:3, 3]
            low, high = np.minimum(low, corners.min(0)), np.maximum(high, corners.max(0))
    if not np.isfinite((low, high)).all():
        return None
    (x, y, z), (to_x, to_y, to_z) = low.tolist(), high.tolist()
    return (x, y, z), (to_x, to_y, to_z)


def _link_corners(link: Link, mesh_bounds: Callable[[str], Bounds | None]) -> Floats | None:
    """Corners of the boxes around the visuals, (8 N, 3), in the link's frame, m."""
    found = [np.empty((0, 3))]
    for visual in link.visuals:
        bounds = geometry_bounds(visual.geometry, mesh_bounds)
        if bounds is None:
            return None
        low, high = np.array(bounds[0]), np.array(bounds[1])
        corners = (low + high) / 2 + _SIGNS * (high - low) / 2
        turn = matrix_from_rpy(np.array(visual.origin.rpy))
        found.append(corners @ turn.T + np.array(visual.origin.xyz))
    return np.concatenate(found)


def geometry_bounds(
    geometry: Geometry, mesh_bounds: Callable[[str], Bounds | None]
) -> Bounds | None:
    """The box around a geometry in its own frame; None while its mesh is not known."""
    match geometry:
        case Box((x, y, z)):
            half = (x / 2, y / 2, z / 2)
        case Cylinder(radius_m, length_m):
            half = (radius_m, radius_m, length_m / 2)
        case Sphere(radius_m):
            half = (radius_m, radius_m, radius_m)
        case Mesh():
            return _scaled(mesh_bounds(geometry.uri), geometry.scale)
    return (-half[0], -half[1], -half[2]), half


def _scaled(bounds: Bounds | None, scale: Vector3) -> Bounds | None:
    if bounds is None:
        return None
    (x, y, z), (to_x, to_y, to_z) = bounds
    return (
        (x * scale[0], y * scale[1], z * scale[2]),
        (to_x * scale[0], to_y * scale[1], to_z * scale[2]),
    )
