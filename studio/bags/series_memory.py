"""Room for long arrays of numbers: in memory up to a bound, beyond it in files without a name."""

from __future__ import annotations

import os
import tempfile
import threading
import weakref
from typing import TYPE_CHECKING, Any, Final, TypeVar

import numpy as np

from studio.errors import RecordingError

if TYPE_CHECKING:
    from numpy.typing import NDArray

N = TypeVar("N", bound=np.generic)
BYTES_MAX: Final = 320 * 2**20
"""In memory: ten million samples of two numbers."""
FILES_BYTES_MAX: Final = 8 * 2**30


class SeriesMemory:
    """Gives out arrays, and counts them until nobody has them any more. Thread-safe.

    Args:
        bytes_max: Of all arrays in memory.
        files_bytes_max: Of all arrays in files of the temporary folder, which are gone with them.
    """

    def __init__(self, bytes_max: int = BYTES_MAX, files_bytes_max: int = FILES_BYTES_MAX) -> None:
        self._bytes_max, self._files_bytes_max = bytes_max, files_bytes_max
        self._lock = threading.RLock()  # what is collected meanwhile is counted off in any thread
        self.used_bytes = 0
        self.files_bytes = 0

    def array(self, size: int, dtype: np.dtype[N]) -> NDArray[N]:
        """Return an array with any content.

        Args:
            size: How many numbers, one at least.
            dtype: Their kind.

        Raises:
            RecordingError: There is no room, neither in memory nor on the disk.
        """
        total = size * dtype.itemsize
        with self._lock:
            in_memory = self.used_bytes + total <= self._bytes_max
            if not in_memory and self.files_bytes + total > self._files_bytes_max:
                limit = self._files_bytes_max >> 20
                raise RecordingError(f"The samples of all plots take more than {limit} MB.")
            self._count(total, in_memory=in_memory)
        try:
            made = np.empty(size, dtype) if in_memory else _in_file(size, dtype, total)
        except BaseException:
            self._count(-total, in_memory=in_memory)
            raise
        weakref.finalize(made, self._count, -total, in_memory=in_memory).atexit = False
        return made

    def _count(self, change: int, *, in_memory: bool) -> None:
        with self._lock:
            if in_memory:
                self.used_bytes += change
            else:
                self.files_bytes += change


def _in_file(size: int, dtype: np.dtype[N], total_bytes: int) -> NDArray[N]:
    with tempfile.TemporaryFile(prefix="studio-series-") as file:
        try:
            # All of it at once: a page that the disk has no room for would end the process.
            os.posix_fallocate(file.fileno(), 0, total_bytes)
        except OSError as error:
            raise RecordingError(
                f"The samples of the plot find no room in the temporary folder "
                f"({error.strerror}): make some, or draw fewer lines."
            ) from None
        return np.memmap(file, dtype, "r+", shape=(size,))


class GrowingArray:
    """Numbers that come one piece after another.

    Args:
        memory: Where they lie.
        dtype: Their kind.
        expected: How many are likely to come.
    """

    def __init__(self, memory: SeriesMemory, dtype: type[np.generic], expected: int) -> None:
        self._memory, self._dtype = memory, np.dtype(dtype)
        self._array: NDArray[Any] = memory.array(max(expected, 1_024), self._dtype)
        self.size = 0

    def append(self, numbers: NDArray[Any]) -> None:
        """Add some.

        Raises:
            RecordingError: There is no room.
        """
        size = self.size + numbers.size
        if size > self._array.size:
            larger = self._memory.array(max(size, self._array.size * 3 // 2), self._dtype)
            larger[: self.size] = self._array[: self.size]
            self._array = larger
        self._array[self.size : size] = numbers
        self.size = size

    def filled(self) -> NDArray[Any]:
        """Return a view of what came; it stays as it is when more comes."""
        return self._array[: self.size]

    def reorder(self, order: NDArray[np.intp]) -> None:
        """Put them into another order; views of before stay as they are."""
        other = self._memory.array(self.size, self._dtype)
        np.take(self.filled(), order, out=other)
        self._array = other

    def drop_first(self, count: int) -> None:
        """Drop the first ones; views of before stay as they are."""
        rest = self.filled()[count:]
        other = self._memory.array(max(rest.size * 3 // 2, 1_024), self._dtype)
        other[: rest.size] = rest
        self._array, self.size = other, rest.size
