"""Replacements that mend a text: each repeats enough of what stands there to be found again."""

from __future__ import annotations

from typing import Final

from studio.problems import Fix, Replacement

_BESIDE: Final = 12
"""Bytes that are repeated beside what is put in."""


class TextMends:
    """Makes fixes for one text; offsets are bytes of `data`, new text is escaped by the caller."""

    def __init__(self, file: str, data: bytes, encoding: str) -> None:
        self._file, self._data, self._encoding = file, data, encoding
        self.line_break: Final = "\r\n" if b"\r\n" in data[: 1 << 16] else "\n"

    def text(self, start: int, end: int) -> str:
        """What stands there."""
        return self._data[start:end].decode(self._encoding, "replace")

    def replaced(self, start: int, end: int, text: str) -> Replacement:
        """Other text in the place of some bytes; with none of them, put in there."""
        if start == end:
            return self.put_in(start, text)
        return Replacement(self._file, start, end, self.text(start, end), text)

    def put_in(self, at: int, text: str) -> Replacement:
        """Text put in at a place, marked by what stands before it, or behind it at the start."""
        if at > 0:
            start = self._boundary(max(0, at - _BESIDE))
            before = self.text(start, at)
            return Replacement(self._file, start, at, before, before + text)
        end = self._boundary(min(len(self._data), _BESIDE))
        before = self.text(0, end)
        return Replacement(self._file, 0, end, before, text + before)

    def fix(self, label: str, *edits: Replacement) -> Fix:
        """A fix that is these edits."""
        return Fix(label, "edit", edits=edits)

    def indent_at(self, at: int) -> str:
        """The blanks before what stands there on its line; empty when it begins no line."""
        line = self._data[self._data.rfind(b"\n", 0, at) + 1 : at]
        return "" if line.strip() else line.decode(self._encoding, "replace")

    def begins_line(self, at: int) -> bool:
        """Whether only blanks stand before it on its line."""
        return not self._data[self._data.rfind(b"\n", 0, at) + 1 : at].strip()

    def _boundary(self, at: int) -> int:
        """Never amid the bytes of one UTF-8 character."""
        while self._encoding == "utf-8" and 0 < at < len(self._data):
            if self._data[at] & 0xC0 != 0x80:
                break
            at -= 1
        return at
