"""Arrays that grow by doubling."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

_T = TypeVar("_T", bound=np.generic)


def grown(array: NDArray[_T], rows: int) -> NDArray[_T]:
    """The array, or a longer copy with zeros at its end, so that it has this many rows."""
    if rows <= len(array):
        return array
    longer: NDArray[Any] = np.zeros((max(rows, 2 * len(array)), *array.shape[1:]), array.dtype)
    longer[: len(array)] = array
    return longer
