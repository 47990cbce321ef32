"""The sizes of a robot and its shapes: reach, boxes around geometry, volumes."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, TypeAlias

import numpy as np

from studio.robot.rotations import matrix_from_rpy
from studio.robot.values import Box, Cylinder, JointType, Mesh, Sphere

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from studio.robot.kinematics import Kinematics
    from studio.robot.meshes.loaded_mesh import LoadedMesh
    from studio.robot.rotations import Floats
    from studio.robot.values import Collision, Geometry, Joint, Link, Robot, Vector3, Visual

Bounds: TypeAlias = "tuple[Vector3, Vector3]"
"""Least and greatest corner, m."""
_SIGNS: Final = np.array(list(itertools.product((-1.0, 1.0), repeat=3)))
MeshVolumes: TypeAlias = "Callable[[str], Volume | None]"


@dataclass(frozen=True, slots=True)
class Measures:
    """The measures of a whole robot; `box` is None while one of its meshes is not known."""

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
    """Return the box around all visuals in a pose, in the root's frame; arguments as for `measure`.

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
    """Return the box around a geometry in its own frame; None while its mesh is not known."""
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


@dataclass(frozen=True, slots=True)
class Volume:
    """A volume; not exact: of the box around a surface that is not closed, so at most that."""

    volume_m3: float
    is_exact: bool


def shapes_volume(shapes: Sequence[Visual | Collision], of_mesh: MeshVolumes) -> Volume | None:
    """Return the volume of all visuals, or all collisions, of a link; overlaps count twice.

    Args:
        shapes: Of one link.
        of_mesh: Of a mesh file by its URI, unscaled; None when it is not known.

    Returns:
        None without shapes, and when one of them is not known.
    """
    found = [geometry_volume(shape.geometry, of_mesh) for shape in shapes]
    known = [one for one in found if one is not None]
    if not known or len(known) < len(found):
        return None
    return Volume(math.fsum(one.volume_m3 for one in known), all(one.is_exact for one in known))


def geometry_volume(geometry: Geometry, of_mesh: MeshVolumes) -> Volume | None:
    """Return the volume of one shape; arguments as for `shapes_volume`."""
    match geometry:
        case Box((x, y, z)):
            return _exact(x * y * z)
        case Cylinder(radius_m, length_m):
            return _exact(math.pi * radius_m * radius_m * length_m)
        case Sphere(radius_m):
            return _exact(4 / 3 * math.pi * radius_m * radius_m * radius_m)
        case Mesh(uri, (x, y, z)):
            found = of_mesh(uri)
            return found and _finite(Volume(abs(found.volume_m3 * x * y * z), found.is_exact))


def _exact(volume_m3: float) -> Volume | None:
    return _finite(Volume(abs(volume_m3), is_exact=True))


def _finite(found: Volume) -> Volume | None:
    return found if math.isfinite(found.volume_m3) else None


def mesh_volume(mesh: LoadedMesh) -> Volume:
    """Return what a closed surface encloses, else the volume of the box around it.

    Parts that lie inside out count against the others; ones that overlap count twice.
    """
    if is_closed(mesh.vertices, mesh.faces):
        corners = mesh.vertices.astype(np.float64)[mesh.faces]
        corners -= corners[0, 0]  # far from zero the parts would cancel badly
        sixfold = np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2]))
        if sixfold:
            return Volume(abs(float(sixfold)) / 6, is_exact=True)
    low, high = mesh.bounds_m
    return Volume(math.prod(b - a for a, b in zip(low, high, strict=True)), is_exact=False)


def is_closed(vertices: NDArray[np.float32], faces: NDArray[np.uint32]) -> bool:
    """Whether each edge is gone along as often in one direction as in the other.

    Args:
        vertices: Shape (N, 3); vertices at the very same place are one.
        faces: Shape (M, 3), indices into `vertices`.
    """
    place = _places(vertices)[faces]
    begin, end = place.ravel(), np.roll(place, -1, axis=1).ravel()
    edge = np.minimum(begin, end) * np.int64(len(vertices)) + np.maximum(begin, end)
    direction = np.sign(end - begin)
    order = np.argsort(edge, kind="stable")
    starts = np.flatnonzero(np.diff(edge[order], prepend=-1))
    return not np.add.reduceat(direction[order], starts).any()


def _places(vertices: NDArray[np.float32]) -> NDArray[np.int64]:
    """Return for each vertex the number shared by all at its place, (N,)."""
    exact = vertices + np.float32(0.0)  # -0 is 0
    order = np.lexsort(exact.T)
    moved = np.any(np.diff(exact[order], axis=0, prepend=np.nan), axis=1)
    places = np.empty(len(vertices), np.int64)
    places[order] = np.cumsum(moved) - 1
    return places
