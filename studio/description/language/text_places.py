"""From bytes of a file to lines and columns of an editor, also after the text has been typed on."""

from __future__ import annotations

import codecs
import re
from bisect import bisect_right
from functools import cached_property
from typing import Final

from studio.description.language.questions import TextPlace
from studio.description.syntax.attribute_spans import text_encoding

_LINE_BREAK: Final = re.compile(rb"\r\n|\r|\n")


class TextPlaces:
    """Places of one state of a file; `data` are its bytes."""

    def __init__(self, file: str, data: bytes) -> None:
        self.file, self.data = file, data
        self._encoding = text_encoding(data)
        self._bom_bytes = len(codecs.BOM_UTF8) if data.startswith(codecs.BOM_UTF8) else 0

    def place(self, start: int, end: int | None = None) -> TextPlace:
        """The place of the bytes [start, end); outside the file the nearest end of it."""
        start = max(self._bom_bytes, min(start, len(self.data)))
        line = bisect_right(self._line_starts, start) - 1
        first = self._line_starts[line]
        column = self._units(self.data[first:start]) + 1
        length = self._units(self.data[start : max(start, end)]) if end is not None else 0
        return TextPlace(self.file, line + 1, column, length)

    def line(self, number: int) -> str:
        """The line of text of a number from 1, without the blanks around it."""
        starts = self._line_starts
        first = starts[min(number, len(starts)) - 1]
        end = starts[number] if number < len(starts) else len(self.data)
        return self.data[first:end].decode(self._encoding, "replace").strip()

    @cached_property
    def _line_starts(self) -> list[int]:
        breaks = (found.end() for found in _LINE_BREAK.finditer(self.data))
        return [self._bom_bytes, *breaks]

    def _units(self, data: bytes) -> int:
        """Length in UTF-16 code units."""
        if data.isascii():
            return len(data)
        return len(data.decode(self._encoding, "replace").encode("utf-16-le")) // 2


class Drift:
    """Where the bytes of an old text are in a new one, when one stretch of it was changed."""

    def __init__(self, old: bytes, new: bytes) -> None:
        self._old, self._new = len(old), len(new)
        self._is_same = old == new
        # The end first: what is inserted before a tag begins with `<` like the tag itself.
        self._behind = 0 if self._is_same else _common(old[::-1], new[::-1])
        left = min(len(old), len(new)) - self._behind
        self._before = 0 if self._is_same else _common(old[:left], new[:left])

    def to_new(self, byte: int) -> int:
        """The place in the new text; what is gone is where the change begins."""
        return self._moved(byte, self._old, self._new)

    def to_old(self, byte: int) -> int:
        """The place in the old text; what is new is where the change begins."""
        return self._moved(byte, self._new, self._old)

    def _moved(self, byte: int, length: int, to_length: int) -> int:
        if self._is_same or byte < self._before:
            return byte
        if byte >= length - self._behind:
            return byte + to_length - length
        return self._before


def _common(left: bytes, right: bytes) -> int:
    """Length of what two texts begin with alike."""
    low, high = 0, min(len(left), len(right))
    while low < high:
        middle = (low + high + 1) // 2
        if left[low:middle] == right[low:middle]:
            low = middle
        else:
            high = middle - 1
    return low
