"""BytesWriter: writes texts and counts of a message in plain CDR, and leaves room for numbers."""

from __future__ import annotations

import struct

from studio.errors import MessageValueError

_HEADER = b"\0\1\0\0"
_TIME = struct.Struct("<iI").pack
_WORD = struct.Struct("<I").pack


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
        """Write what is packed already and begins with a word."""
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
        """Leave room for numbers; give where the first of them will lie."""
        written = self.written
        written += bytes((len(_HEADER) - len(written)) % each_bytes)
        begin = len(written)
        written += bytes(total_bytes)
        return begin
