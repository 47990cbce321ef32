"""The Ground: how low the robot reaches, so that the grid can lie under it."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from studio.robot.rotations import matrix_from_rpy
from studio.robot.values import Box, Cylinder, Mesh, Sphere

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from studio.robot.values import Geometry, Link, Visual
    from studio.scene.geometry_drawing import MeshShelf

    Floats: TypeAlias = NDArray[np.float64]

_SIGNS = np.array(list(itertools.product((-0.5, 0.5), repeat=3)))


class Ground:
    """Corners of the boxes around the visuals of each link."""

    def __init__(self) -> None:
        self._corners: dict[str, Floats] = {}

    def note(self, link: Link, shelf: MeshShelf) -> None:
        """Look at a link as it is now; meshes that have not come count for nothing."""
        corners = _corners_of(link, shelf)
        self._corners.pop(link.name, None)
        if corners.size:
            self._corners[link.name] = corners

    def forget(self, link: str) -> None:
        """A link is no more."""
        self._corners.pop(link, None)

    def height_m(self, link_names: Sequence[str], wxyz_xyz: NDArray[np.floating]) -> float:
        """Lowest corner in the root frame, at most 0: a robot above its origin hovers on purpose.

        Args:
            link_names: L names.
            wxyz_xyz: Shape (L, 7), as for `DocumentScene.set_poses`.
        """
        lowest = 0.0
        for name, pose in zip(link_names, np.asarray(wxyz_xyz, dtype=np.float64), strict=True):
            corners = self._corners.get(name)
            if corners is not None:
                heights = corners @ _up_in_link(pose) + pose[6]
                lowest = min(lowest, float(heights.min()))
        return lowest if np.isfinite(lowest) else 0.0


def _up_in_link(pose: Floats) -> Floats:
    """The third row of the rotation: how much each axis of the link points up."""
    w, x, y, z = pose[:4]
    return np.array([2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)])


def _corners_of(link: Link, shelf: MeshShelf) -> Floats:
    """Shape (8 n, 3), in the link's frame."""
    boxes = [_corners(visual, shelf) for visual in link.visuals]
    return np.concatenate([box for box in boxes if box is not None] or [np.empty((0, 3))])


def _corners(visual: Visual, shelf: MeshShelf) -> Floats | None:
    box = _box(visual.geometry, shelf)
    if box is None:
        return None
    low, high = box
    corners = (low + high) / 2 + _SIGNS * (high - low)
    origin = visual.origin
    placed = corners @ matrix_from_rpy(np.array(origin.rpy)).T + np.array(origin.xyz)
    return placed if np.isfinite(placed).all() else None


def _box(geometry: Geometry, shelf: MeshShelf) -> tuple[Floats, Floats] | None:
    """Least and greatest corner in the frame of the geometry."""
    match geometry:
        case Box():
            half = np.array(geometry.size_m) / 2
        case Cylinder():
            half = np.array([geometry.radius_m, geometry.radius_m, geometry.length_m / 2])
        case Sphere():
            half = np.full(3, geometry.radius_m)
        case Mesh():
            loaded = shelf.get(geometry.uri)
            if loaded is None:
                return None
            scaled = np.array(loaded.bounds_m) * np.array(geometry.scale)
            return scaled.min(axis=0), scaled.max(axis=0)
    return -half, half
