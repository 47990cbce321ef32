"""Places of strings and numbers in the CDR of a message, found once for messages built alike.

A publisher of transforms or markers sends the same names over and over with other numbers. If all
bytes but the numbers equal those of an earlier message, the numbers are in the same places, and
numpy takes them all at once.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Generic, Protocol, TypeVar

import numpy as np

from studio.errors import CdrError, MessageValueError
from studio.ros.duration import NANOSECONDS

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

HEADER_BYTES = 4
_COUNTS = {b"\0\1": struct.Struct("<I").unpack_from, b"\0\0": struct.Struct(">I").unpack_from}
_HEADER = b"\0\1\0\0"
_TIME = struct.Struct("<iI").pack
_WORD = struct.Struct("<I").pack
Places = np.ndarray[Any, np.dtype[np.intp]]
SKELETON_BYTES_MAX = 8 << 20
"""Of one layout: 10,000 markers take 2 MB."""
_KEPT_BYTES_MAX = 16 << 20
"""Of all layouts of a codec together, but for the newest."""
_LENGTHS_MAX = 16
_OF_ONE_LENGTH_MAX = 4
N = TypeVar("N", bound=np.generic)


class BytesReader:
    """Reads counts and strings one after another; numbers are skipped, for numpy to take.

    Attributes:
        raw: The whole message, its header of four bytes included.
        order: `<` or `>`, from the header.
        at: Index in `raw` of what comes next.
    """

    __slots__ = ("_count_at", "_type_name", "at", "order", "raw", "size")

    def __init__(self, raw: bytes, type_name: str) -> None:
        count_at = _COUNTS.get(raw[:2])
        if count_at is None or len(raw) < HEADER_BYTES:
            raise CdrError(type_name, "they do not begin with the header of plain CDR")
        self.raw, self.size, self._type_name = raw, len(raw), type_name
        self.order = "<" if raw[1] else ">"
        self._count_at = count_at
        self.at = HEADER_BYTES

    def word(self) -> int:
        """Read a uint32, where one would lie next.

        Raises:
            CdrError: The bytes end before it.
        """
        at = (self.at + 3) & ~3
        self.at = at + 4
        if self.at > self.size:
            raise self.cut_off()
        return self._count_at(self.raw, at)[0]

    def count(self, bytes_least: int) -> int:
        """Read how many items follow, each of which takes at least so many bytes.

        Raises:
            CdrError: They cannot all follow.
        """
        count = self.word()
        if count * bytes_least > self.size - self.at:
            raise CdrError(self._type_name, f"{count} items are announced, and their bytes missing")
        return count

    def text(self) -> str:
        """Read a text.

        Raises:
            CdrError: It is cut off, does not end in a zero or is no UTF-8.
        """
        at = (self.at + 3) & ~3
        begin = at + 4
        if begin > self.size:
            raise self.cut_off()
        end = self.at = begin + self._count_at(self.raw, at)[0]
        if end == begin or end > self.size or self.raw[end - 1]:
            raise CdrError(self._type_name, f"the text at byte {at} does not end within it")
        try:
            return self.raw[begin : end - 1].decode()
        except UnicodeDecodeError as error:
            raise CdrError(self._type_name, f"a text is no UTF-8 ({error.reason})") from None

    def numbers(self, each_bytes: int, total_bytes: int) -> int:
        """Pass over numbers; return where the first of them lies.

        Raises:
            CdrError: The bytes end before they do.
        """
        begin = self.at + (HEADER_BYTES - self.at) % each_bytes
        self.at = begin + total_bytes
        if self.at > self.size:
            raise self.cut_off()
        return begin

    def time_ns(self) -> int:
        """Read a builtin_interfaces/Time, ns since the epoch.

        Raises:
            CdrError: The bytes end before it does.
        """
        sec, nanosec = struct.unpack_from(f"{self.order}iI", self.raw, self.numbers(4, 8))
        return sec * NANOSECONDS + nanosec

    def cut_off(self) -> CdrError:
        """Make the error for bytes that end too early."""
        return CdrError(self._type_name, "they end in the middle")


class BytesWriter:
    """Grows a message, little endian; `written` begins with the header of four bytes."""

    __slots__ = ("_type_name", "written")

    def __init__(self, type_name: str) -> None:
        self.written = bytearray(_HEADER)
        self._type_name = type_name

    def word(self, value: int) -> None:
        """Write a uint32."""
        self.ready(_WORD(value))

    def ready(self, packed: bytes) -> None:
        """Write what is already packed and begins with a 32-bit word."""
        self.written += bytes(-len(self.written) % 4) + packed

    def time(self, seconds: int, rest_ns: int) -> None:
        """Write a time or duration.

        Raises:
            MessageValueError: It does not fit the 32 bits of its seconds.
        """
        try:
            packed = _TIME(seconds, rest_ns)
        except struct.error:
            raise MessageValueError(self._type_name, f"{seconds} s do not fit a time") from None
        self.ready(packed)

    def text(self, text: str) -> None:
        """Write a text.

        Raises:
            MessageValueError: It is no text, or holds half a letter.
        """
        try:
            encoded = text.encode()
        except (AttributeError, UnicodeEncodeError):
            raise MessageValueError(self._type_name, f"{text!r} is no text of UTF-8") from None
        self.word(len(encoded) + 1)
        self.written += encoded + b"\0"

    def numbers(self, each_bytes: int, total_bytes: int) -> int:
        """Leave room for numbers; return where the first of them will lie."""
        written = self.written
        written += bytes((len(_HEADER) - len(written)) % each_bytes)
        begin = len(written)
        written += bytes(total_bytes)
        return begin


class Skeleton:
    """The 32-bit words of a message that are no numbers, counted behind the header."""

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


class KnownLayouts(Generic[L]):
    """The layouts of the last messages, found by their lengths; a bounded number of them."""

    def __init__(self) -> None:
        self._of_length: dict[int, list[L]] = {}
        self._kept_bytes = 0

    def __len__(self) -> int:
        return sum(map(len, self._of_length.values()))

    def find(self, raw: bytes) -> L | None:
        """Return the layout of a message like those before, None for one of a new kind."""
        for layout in self._of_length.get(len(raw), ()):
            if layout.skeleton.fits(raw):
                return layout
        return None

    def keep(self, raw: bytes, layout: L) -> None:
        """Remember how a message lies, unless it is very large."""
        if len(raw) > SKELETON_BYTES_MAX:
            return
        if len(self._of_length) >= _LENGTHS_MAX and len(raw) not in self._of_length:
            self._drop_oldest()
        kept = self._of_length.get(len(raw), [])[: _OF_ONE_LENGTH_MAX - 1]
        self._of_length[len(raw)] = [layout, *kept]
        self._count_bytes()
        while self._kept_bytes > _KEPT_BYTES_MAX and len(self) > 1:
            if len(self._of_length) > 1:
                self._drop_oldest()
            else:
                self._of_length[len(raw)].pop()
            self._count_bytes()

    def _drop_oldest(self) -> None:
        self._of_length.pop(next(iter(self._of_length)))

    def _count_bytes(self) -> None:
        self._kept_bytes = sum(each * len(kept) for each, kept in self._of_length.items())


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
    """Return the types of numbers in a message, by its header."""
    return LITTLE if raw[1] else BIG


def view(raw: bytes | bytearray, kind: np.dtype[N]) -> NDArray[N]:
    """View what is behind the header as numbers of one kind."""
    count = (len(raw) - HEADER_BYTES) // kind.itemsize
    return np.frombuffer(raw, dtype=kind, count=count, offset=HEADER_BYTES)


def places_of(byte_places: list[int] | Places, items: int | list[int], each_bytes: int) -> Places:
    """Return the places of numbers, from the bytes at which rows of them begin.

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


def nanoseconds_at(raw: bytes, places: Places, kinds: Numbers) -> NDArray[np.int64]:
    """Read times or durations.

    Args:
        raw: A whole message.
        places: Shape (N, 2), of the 32-bit words of seconds and nanoseconds.
        kinds: Types of its numbers.

    Returns:
        Shape (N,).
    """
    seconds = view(raw, kinds.i4).take(places[:, 0])
    rest = view(raw, kinds.u4).take(places[:, 1])
    return seconds.astype(np.int64) * NANOSECONDS + rest


def put_nanoseconds(
    written: bytearray, places: Places, times_ns: NDArray[np.int64], type_name: str
) -> None:
    """Write times into a message, little endian.

    Raises:
        MessageValueError: A time does not fit the 32 bits of its seconds.
    """
    seconds = times_ns // NANOSECONDS
    short = seconds.astype(np.int32)
    if not np.array_equal(short, seconds):
        raise MessageValueError(type_name, "a time lies beyond the 32 bits of its seconds")
    words = view(written, LITTLE.i4)
    words[places[:, 0]] = short
    # The bits of a uint32 below 10**9 are those of an int32.
    words[places[:, 1]] = times_ns - seconds * NANOSECONDS
