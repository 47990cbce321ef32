"""Skeleton: all of a message but its numbers, by which those that are built alike are known.

A publisher of transforms or markers sends the same names over and over with other numbers. Where
every byte but the numbers is that of a message which was walked through before, the numbers lie
where they lay then, and numpy takes them all at once.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Generic, Protocol, TypeVar

import numpy as np

from studio.ros.fast.bytes_reader import HEADER_BYTES

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

Places = np.ndarray[Any, np.dtype[np.intp]]
SKELETON_BYTES_MAX = 1 << 20
_LENGTHS_MAX = 16
_OF_ONE_LENGTH_MAX = 4


class Skeleton:
    """The words of a message that are no numbers; words are of four bytes, behind the header."""

    __slots__ = ("_head", "_rest", "_tail", "_words")

    def __init__(self, raw: bytes, number_words: Iterable[Places]) -> None:
        words = view(raw, LITTLE.u4)
        rest = np.ones(words.size, dtype=np.bool_)
        for places in number_words:
            rest[places.reshape(-1)] = False
        self._rest = np.flatnonzero(rest)
        self._words = words.take(self._rest).tobytes()
        self._head = raw[:HEADER_BYTES]
        self._tail = raw[HEADER_BYTES + 4 * words.size :]

    def fits(self, raw: bytes) -> bool:
        """Whether a message of the same length has its numbers where this one has."""
        return (
            raw.startswith(self._head)
            and raw.endswith(self._tail)
            and view(raw, LITTLE.u4).take(self._rest).tobytes() == self._words
        )


class _HasSkeleton(Protocol):
    @property
    def skeleton(self) -> Skeleton: ...


L = TypeVar("L", bound=_HasSkeleton)
N = TypeVar("N", bound=np.generic)


class KnownLayouts(Generic[L]):
    """The layouts of the last messages, found by their lengths; a bounded number of them."""

    def __init__(self) -> None:
        self._of_length: dict[int, list[L]] = {}

    def __len__(self) -> int:
        return sum(map(len, self._of_length.values()))

    def find(self, raw: bytes) -> L | None:
        """Give the layout of a message like those before, None for one of a new kind."""
        for layout in self._of_length.get(len(raw), ()):
            if layout.skeleton.fits(raw):
                return layout
        return None

    def keep(self, raw: bytes, layout: L) -> None:
        """Remember how a message lies, unless it is very large."""
        if len(raw) > SKELETON_BYTES_MAX:
            return
        if len(self._of_length) >= _LENGTHS_MAX and len(raw) not in self._of_length:
            self._of_length.pop(next(iter(self._of_length)))
        kept = self._of_length.get(len(raw), [])
        self._of_length[len(raw)] = [layout, *kept[: _OF_ONE_LENGTH_MAX - 1]]


@dataclass(frozen=True, slots=True)
class Numbers:
    """The kinds of numbers of a message, in its order of bytes."""

    f8: np.dtype[np.float64]
    f4: np.dtype[np.float32]
    i4: np.dtype[np.int32]
    u4: np.dtype[np.uint32]


def _numbers(order: str) -> Numbers:
    f8, f4, i4, u4 = (np.dtype(order + kind) for kind in ("f8", "f4", "i4", "u4"))
    return Numbers(f8, f4, i4, u4)


LITTLE, BIG = _numbers("<"), _numbers(">")


def numbers_of(raw: bytes) -> Numbers:
    """Give the kinds of numbers that a message holds, as its header says."""
    return LITTLE if raw[1] else BIG


def view(raw: bytes | bytearray, kind: np.dtype[N]) -> NDArray[N]:
    """View what is behind the header as numbers of one kind."""
    count = (len(raw) - HEADER_BYTES) // kind.itemsize
    return np.frombuffer(raw, dtype=kind, count=count, offset=HEADER_BYTES)


def places_of(byte_places: list[int] | Places, items: int | list[int], each_bytes: int) -> Places:
    """Give the places of numbers, from the bytes at which rows of them begin.

    Args:
        byte_places: Of N rows, in the whole message.
        items: How many numbers a row has, or which of them and in what order.
        each_bytes: What one number takes.

    Returns:
        Shape (N, items).
    """
    begin = (np.asarray(byte_places, dtype=np.intp) - HEADER_BYTES) // each_bytes
    columns = np.arange(items) if isinstance(items, int) else np.array(items, dtype=np.intp)
    return begin[:, None] + columns
