"""The Ground: how low the robot reaches, so that the grid can lie under it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from studio.robot.values import Box, Cylinder, Mesh, Sphere
from studio.scene.pose import rows_from_rpy

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from studio.robot.values import Geometry, Link, Vector3, Visual
    from studio.scene.geometry_drawing import MeshShelf

    Floats: TypeAlias = NDArray[np.float64]
    _Boxes: TypeAlias = tuple[Floats, Floats]


class Ground:
    """The boxes around the visuals of each link.

    Of one link with n visuals: their centres, (n, 3), and half their edges as vectors, (n, 3, 3),
    in the link's frame, m.
    """

    def __init__(self) -> None:
        self._boxes: dict[str, _Boxes] = {}
        self._noted: dict[str, tuple[Link, MeshShelf]] = {}
        """Links that were not looked at since they were noted."""

    def note(self, link: Link, shelf: MeshShelf) -> None:
        """A link is as it is now; meshes that have not come when it matters count for nothing."""
        self._noted[link.name] = link, shelf

    def forget(self, link: str) -> None:
        """A link is no more."""
        self._boxes.pop(link, None)
        self._noted.pop(link, None)

    def height_m(self, link_names: Sequence[str], wxyz_xyz: NDArray[np.floating]) -> float:
        """Lowest corner in the root frame, at most 0: a robot above its origin hovers on purpose.

        Args:
            link_names: L names.
            wxyz_xyz: Shape (L, 7), as for `DocumentScene.set_poses`.
        """
        self._look_at_noted()
        lowest = 0.0
        for name, pose in zip(link_names, np.asarray(wxyz_xyz, dtype=np.float64), strict=True):
            boxes = self._boxes.get(name)
            if boxes is not None:
                centres, edges = boxes
                up = _up_in_link(pose)
                heights = centres @ up - np.abs(edges @ up).sum(axis=1) + pose[6]
                lowest = min(lowest, float(heights.min()))
        return lowest if math.isfinite(lowest) else 0.0

    def bounds_m(
        self, link_names: Sequence[str], wxyz_xyz: NDArray[np.floating]
    ) -> tuple[Floats, Floats]:
        """Lowest and highest corner of all boxes in the root frame, each (3,); zeros for none.

        Args:
            link_names: L names.
            wxyz_xyz: Shape (L, 7), as for `DocumentScene.set_poses`.
        """
        self._look_at_noted()
        low, high = np.full(3, np.inf), np.full(3, -np.inf)
        for name, pose in zip(link_names, np.asarray(wxyz_xyz, dtype=np.float64), strict=True):
            boxes = self._boxes.get(name)
            if boxes is not None:
                rotation = _rotation(pose)
                centres = boxes[0] @ rotation.T + pose[4:]
                halves = np.abs(boxes[1] @ rotation.T).sum(axis=1)
                low = np.minimum(low, (centres - halves).min(axis=0))
                high = np.maximum(high, (centres + halves).max(axis=0))
        is_there = bool(np.isfinite(low).all() and np.isfinite(high).all())
        return (low, high) if is_there else (np.zeros(3), np.zeros(3))

    def _look_at_noted(self) -> None:
        noted, self._noted = self._noted, {}
        for name, (link, shelf) in noted.items():
            found = [box for visual in link.visuals if (box := _box_of(visual, shelf))]
            self._boxes.pop(name, None)
            if found:
                self._boxes[name] = (
                    np.array([centre for centre, _ in found]),
                    np.array([edges for _, edges in found]),
                )


def _up_in_link(pose: Floats) -> Floats:
    """The third row of the rotation: how much each axis of the link points up."""
    w, x, y, z = pose[:4].tolist()
    return np.array([2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)])


def _rotation(pose: Floats) -> Floats:
    """Shape (3, 3): the root frame's axes from the link's."""
    w, x, y, z = pose[:4].tolist()
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def _box_of(visual: Visual, shelf: MeshShelf) -> tuple[Vector3, tuple[Vector3, ...]] | None:
    """Centre, and half of each edge as a vector; None for a visual without extent."""
    found = _extent(visual.geometry, shelf)
    if found is None:
        return None
    (mx, my, mz), half = found
    rows = rows_from_rpy(visual.origin.rpy)
    x, y, z = (
        row[0] * mx + row[1] * my + row[2] * mz + at
        for row, at in zip(rows, visual.origin.xyz, strict=True)
    )
    edges = tuple(
        (rows[0][i] * half[i], rows[1][i] * half[i], rows[2][i] * half[i]) for i in range(3)
    )
    finite = all(map(math.isfinite, (x, y, z, *edges[0], *edges[1], *edges[2])))
    return ((x, y, z), edges) if finite else None


def _extent(geometry: Geometry, shelf: MeshShelf) -> tuple[Vector3, Vector3] | None:
    """Middle and half of the size, in the frame of the geometry."""
    middle = (0.0, 0.0, 0.0)
    match geometry:
        case Box((x, y, z)):
            return middle, (x / 2, y / 2, z / 2)
        case Cylinder(radius_m, length_m):
            return middle, (radius_m, radius_m, length_m / 2)
        case Sphere(radius_m):
            return middle, (radius_m, radius_m, radius_m)
        case Mesh():
            loaded = shelf.get(geometry.uri)
            if loaded is None:
                return None
            low, high = np.array(loaded.bounds_m) * np.array(geometry.scale)
            (mx, my, mz), (hx, hy, hz) = ((low + high) / 2).tolist(), ((high - low) / 2).tolist()
            return (mx, my, mz), (abs(hx), abs(hy), abs(hz))
