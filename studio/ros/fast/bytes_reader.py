"""BytesReader: walks through a message in plain CDR and finds where its texts and numbers lie."""

from __future__ import annotations

import struct

from studio.errors import CdrError

HEADER_BYTES = 4
_COUNTS = {b"\0\1": struct.Struct("<I").unpack_from, b"\0\0": struct.Struct(">I").unpack_from}


class BytesReader:
    """Reads counts and texts one after another; numbers are passed over, for numpy to take.

    Attributes:
        raw: The whole message, its header of four bytes included.
        order: `<` or `>`, as the header says.
        at: The place in `raw` of what comes next.
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
        """Pass over numbers; give where the first of them lies.

        Raises:
            CdrError: The bytes end before they do.
        """
        begin = self.at + (HEADER_BYTES - self.at) % each_bytes
        self.at = begin + total_bytes
        if self.at > self.size:
            raise self.cut_off()
        return begin

    def cut_off(self) -> CdrError:
        """Make the error for bytes that end too early."""
        return CdrError(self._type_name, "they end in the middle")
