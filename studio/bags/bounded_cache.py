"""What was read or decompressed last, within a number of bytes."""

from __future__ import annotations

import threading
from collections import OrderedDict
from typing import TYPE_CHECKING, Generic, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable, Hashable

T = TypeVar("T")


class BoundedCache(Generic[T]):
    """Keeps values by key until their bytes are more than `bytes_max`; the newest one stays always.

    Thread-safe; two threads that want one missing value may both make it.
    """

    def __init__(self, bytes_max: int) -> None:
        self._bytes_max = bytes_max
        self._bytes = 0
        self._kept: OrderedDict[Hashable, tuple[T, int]] = OrderedDict()
        self._lock = threading.Lock()

    @property
    def size_bytes(self) -> int:
        """Bytes of what it keeps."""
        return self._bytes

    def found(self, key: Hashable) -> T | None:
        """Return a value that is kept; None: it is not."""
        with self._lock:
            kept = self._kept.get(key)
        return kept[0] if kept else None

    def get(self, key: Hashable, make: Callable[[], tuple[T, int]]) -> T:
        """Return a value; `make` makes it and says how many bytes it takes."""
        with self._lock:
            found = self._kept.get(key)
            if found is not None:
                self._kept.move_to_end(key)
                return found[0]
        made = make()
        with self._lock:
            if key not in self._kept:
                self._kept[key] = made
                self._bytes += made[1]
            while self._bytes > self._bytes_max and len(self._kept) > 1:
                self._bytes -= self._kept.popitem(last=False)[1][1]
        return made[0]

    def forget(self, key: Hashable) -> None:
        """Drop a value."""
        with self._lock:
            self._bytes -= self._kept.pop(key, (None, 0))[1]
