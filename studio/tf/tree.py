"""TransformTree: the newest transform of every frame, and where they put each other."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from studio.errors import TransformError, UnconnectedFramesError, UnknownFrameError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

Floats: TypeAlias = "NDArray[np.float64]"
_NORM_MIN = 1e-6
FRAMES_MAX = 20_000


class TransformTree:
    """Every frame has one parent: who tells of another moves the frame there. Any thread."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._parents: dict[str, tuple[str, Floats]] = {}

    def put(
        self, parent: str, child: str, xyz_m: Sequence[float], quaternion_xyzw: Sequence[float]
    ) -> None:
        """Take up a transform: the pose of `child` in `parent`.

        Raises:
            TransformError: A number is none, the quaternion is zero, a frame is its own parent, or
                there are too many frames.
        """
        parent, child = _plain(parent), _plain(child)
        matrix = np.eye(4)
        matrix[:3, 3] = xyz_m
        quaternion = np.array(quaternion_xyzw, dtype=np.float64)
        norm = float(np.linalg.norm(quaternion))
        if not parent or not child or parent == child:
            raise TransformError(parent, child, "it needs two frames")
        if not (np.isfinite(matrix).all() and np.isfinite(norm)):
            raise TransformError(parent, child, "not all its numbers are finite")
        if norm < _NORM_MIN:
            raise TransformError(parent, child, "its quaternion is zero")
        matrix[:3, :3] = _rotation(quaternion / norm)
        matrix.setflags(write=False)
        with self._lock:
            if child not in self._parents and len(self._parents) >= FRAMES_MAX:
                raise TransformError(parent, child, f"there are {FRAMES_MAX} frames already")
            self._parents[child] = (parent, matrix)

    def frames(self) -> list[str]:
        """Name all frames, in the order of the alphabet."""
        with self._lock:
            parents = {parent for parent, _ in self._parents.values()}
            return sorted(parents | self._parents.keys())

    def target_from_source(self, target: str, source: str) -> Floats:
        """Give the matrix, shape (4, 4), that expresses points of `source` in `target`.

        Raises:
            UnknownFrameError: No transform has told of one of them.
            UnconnectedFramesError: No chain leads from one to the other.
        """
        target, source = _plain(target), _plain(source)
        known = set(self.frames())
        for frame in (target, source):
            if frame not in known:
                raise UnknownFrameError(frame)
        with self._lock:
            up_from_target, up_from_source = self._chain(target), self._chain(source)
        for frame, frame_from_source in up_from_source.items():
            if frame in up_from_target:
                return np.linalg.inv(up_from_target[frame]) @ frame_from_source
        raise UnconnectedFramesError(target, source)

    def _chain(self, frame: str) -> dict[str, Floats]:
        """Each ancestor with the pose of `frame` in it, itself first; a circle ends the chain."""
        ancestor_from_frame = np.eye(4)
        chain = {frame: ancestor_from_frame}
        while frame in self._parents:
            frame, parent_from_child = self._parents[frame]
            if frame in chain:
                break
            ancestor_from_frame = parent_from_child @ ancestor_from_frame
            chain[frame] = ancestor_from_frame
        return chain


def _plain(frame: str) -> str:
    """Names of tf2 begin with no slash; some that publish still write the old one."""
    return frame.removeprefix("/")


def _rotation(unit_xyzw: Floats) -> Floats:
    x, y, z, w = unit_xyzw
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )
