"""Deskewing: points that a moving sensor met one after the other, each put where it was met."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Final

import numpy as np

from studio.displays.drawing import Points, Solids
from studio.tf.rotations import compose, inverse

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from studio.displays.drawing import Drawing, Placed, Pose, Shape, Sweep
    from studio.tf.rotations import Pose as Row

_STILL: Final = 1e-6
"""m, and parts of a unit quaternion: what moved less than this stood still."""


class Deskewing:
    """Puts points where they were met, and remembers: what is the same stays the same object."""

    def __init__(self) -> None:
        self._done: dict[str, tuple[Placed, Row, Placed]] = {}

    def deskewed(
        self, drawing: Drawing, poses: Mapping[str, Pose | None], ends: Mapping[str, Pose]
    ) -> Drawing:
        """Return the same drawing as its frames at their stamps would have seen it.

        Args:
            drawing: Of which some parts have a sweep.
            poses: Of the paths in the fixed frame, at their stamps.
            ends: Of those with a sweep, at its end.
        """
        done: dict[str, tuple[Placed, Row, Placed]] = {}
        for path, end in ends.items():
            begin, placed = poses.get(path), drawing[path]
            if begin is not None and placed.sweep is not None:
                motion = compose(inverse((*begin[0], *begin[1])), (*end[0], *end[1]))
                if _moved(motion):
                    done[path] = self._deskew(path, placed, placed.sweep, motion)
        self._done = done
        return {**drawing, **{path: one[2] for path, one in done.items()}} if done else drawing

    def _deskew(
        self, path: str, placed: Placed, sweep: Sweep, motion: Row
    ) -> tuple[Placed, Row, Placed]:
        before = self._done.get(path)
        if before is not None and before[0] is placed and before[1] == motion:
            return before
        shapes = {name: _deskewed(one, sweep, motion) for name, one in placed.shapes.items()}
        return placed, motion, replace(placed, shapes=shapes)


def _moved(motion: Row) -> bool:
    return max(map(abs, motion[1:])) > _STILL


def _deskewed(shape: Shape, sweep: Sweep, motion: Row) -> Shape:
    if not isinstance(shape, Points | Solids) or len(shape.positions) != len(sweep.shares):
        return shape
    return replace(shape, positions=deskewed_points(shape.positions, sweep.shares, motion))


def deskewed_points(
    points_m: NDArray[np.float32], shares: NDArray[np.float32], begin_from_end: Row
) -> NDArray[np.float32]:
    """Return points as seen from the sensor's first pose.

    As laser_geometry: the sensor moves along a line, and turns evenly about one axis by the
    smaller angle.

    Args:
        points_m: Shape (N, 3), each as seen at its own time.
        shares: Shape (N,), time of each point: 0 at the begin, 1 at the end.
        begin_from_end: Pose of the sensor at the end, in its frame at the begin.
    """
    quaternion = np.array(begin_from_end[:4])
    if quaternion[0] < 0.0:
        quaternion = -quaternion
    sine = float(np.linalg.norm(quaternion[1:]))
    moved = points_m.astype(np.float64)
    if sine > 0.0:
        angles = 2.0 * np.arctan2(sine, quaternion[0]) * shares.astype(np.float64)
        moved = _turned(moved, quaternion[1:] / sine, angles)
    moved += shares[:, None] * np.array(begin_from_end[4:])
    return moved.astype(np.float32)


def _turned(
    points: NDArray[np.float64], axis: NDArray[np.float64], angles: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return points turned about an axis of length 1, each by an angle of its own, by Rodrigues."""
    x, y, z = axis
    aside = np.empty_like(points)
    aside[:, 0] = y * points[:, 2] - z * points[:, 1]
    aside[:, 1] = z * points[:, 0] - x * points[:, 2]
    aside[:, 2] = x * points[:, 1] - y * points[:, 0]
    along = x * points[:, 0] + y * points[:, 1] + z * points[:, 2]
    cosines = np.cos(angles)
    turned = points * cosines[:, None]
    turned += aside * np.sin(angles)[:, None]
    turned += (along * (1.0 - cosines))[:, None] * axis
    return turned
