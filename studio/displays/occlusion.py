"""What a nearer thing hides from a depth camera that stands still: it is seen a while longer."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

_NEARER_M: Final = 0.05
"""What is nearer by less is the same surface, measured a little otherwise."""


class Occlusion:
    """Remembers, for each pixel, the farthest depth of late and when it was measured."""

    def __init__(self) -> None:
        self._depths_m: NDArray[np.float32] | None = None
        self._seen_ns: NDArray[np.int64] | None = None

    def hidden(
        self, depths_m: NDArray[np.float32], now_ns: int, timeout_s: float
    ) -> NDArray[np.float32]:
        """Take a depth image, and return the depths that it hides.

        Args:
            depths_m: Shape (H, W); NaN, infinite or not above 0 where nothing was measured.
            now_ns: When it came.
            timeout_s: How long a depth is remembered.

        Returns:
            Shape (H, W), NaN where nothing is hidden.
        """
        measured = np.isfinite(depths_m) & (depths_m > 0.0)
        shape = None if self._depths_m is None else self._depths_m.shape
        if self._depths_m is None or self._seen_ns is None or shape != measured.shape:
            self._depths_m = np.where(measured, depths_m, np.float32("nan"))
            self._seen_ns = np.full(measured.shape, now_ns, np.int64)
            return np.full(measured.shape, np.nan, np.float32)
        old = now_ns - self._seen_ns > timeout_s * 1e9
        with np.errstate(invalid="ignore"):
            is_nearer = self._depths_m - depths_m > _NEARER_M
        known = np.isfinite(self._depths_m) & ~old
        hidden = known & measured & is_nearer
        seen = measured & ~hidden
        self._depths_m[old] = np.nan
        self._depths_m[seen] = depths_m[seen]
        self._seen_ns[seen] = now_ns
        return np.where(hidden, self._depths_m, np.float32("nan"))
