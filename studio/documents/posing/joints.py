"""Joint positions of one document: set, cleared, thrown and swung, and kept over every reload."""

from __future__ import annotations

import struct
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from studio.robot.kinematics import Kinematics

_JOINTS_FRAME = struct.Struct("<BxxxI")
JOINTS_FRAME_KIND = 1
_POSITION_LIMIT = 1e9
"""rad or m that no robot is at: beyond it poses are no numbers any more."""


class JointPositions:
    """Positions of the movable joints, rad or m, kept by name so that they outlive the model."""

    def __init__(self, kinematics: Kinematics) -> None:
        self._remembered: dict[str, float] = {}
        self._rng = np.random.default_rng()
        self.kinematics = kinematics
        self.adopt(kinematics)

    def adopt(self, kinematics: Kinematics) -> None:
        """Go on with another model: joints of the same name stay where they are, in its limits."""
        before, self.kinematics = self.kinematics, kinematics
        if kinematics is not before and kinematics.reaches_as(before):
            return
        at_zero = zip(kinematics.movable, kinematics.zero_positions(), strict=True)
        kept = {
            name: kinematics.clamp(name, self._remembered.get(name, float(position)))
            for name, position in at_zero
        }
        self._set_all(kinematics.positions_with_mimic(kept))

    def set(self, positions: Mapping[str, float]) -> None:
        """Move some joints, clamped to their limits; unknown and following joints are ignored."""
        free = set(self.kinematics.free)
        asked = {
            name: self.kinematics.clamp(name, value)
            for name, value in positions.items()
            if name in free and np.isfinite(value)
        }
        self._set_all(self.kinematics.positions_with_mimic(self.by_name() | asked))

    def follow(self, positions: Mapping[str, float]) -> None:
        """Stand where a robot that runs says it does, be it beyond the limits of the model."""
        free = set(self.kinematics.free)
        told = {
            name: value
            for name, value in positions.items()
            if name in free and abs(value) < _POSITION_LIMIT
        }
        self._set_all(self.kinematics.positions_with_mimic(self.by_name() | told))

    def zero(self) -> None:
        """All to zero, or to the nearest position within the limits."""
        self._set_all(self.kinematics.zero_positions())

    def randomize(self) -> None:
        """All to random positions within the limits."""
        self._set_all(self.kinematics.random_positions(self._rng))

    def swing(self, time_s: float, start: NDArray[np.float64]) -> None:
        """Where the joints are `time_s` into their swing, which began at `start`."""
        self._set_all(self.kinematics.swing(time_s, start))

    def by_name(self) -> dict[str, float]:
        """Position of every movable joint of the model."""
        return dict(zip(self.kinematics.movable, self.values.tolist(), strict=True))

    def frame(self, revision: int) -> bytes:
        """The positions as a packed frame: kind, 3 pad bytes, revision (u32), float64 each."""
        return _JOINTS_FRAME.pack(JOINTS_FRAME_KIND, revision) + self.values.tobytes()

    def _set_all(self, values: NDArray[np.float64]) -> None:
        self.values = np.ascontiguousarray(values, dtype="<f8")
        self._remembered |= self.by_name()
