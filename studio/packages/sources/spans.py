"""A text of a package as bytes with lines, and replacements in it that keep all other bytes."""

from __future__ import annotations

import re
from bisect import bisect_right
from functools import cached_property
from typing import TYPE_CHECKING, Final

from studio.problems import Place, Replacement

if TYPE_CHECKING:
    from collections.abc import Iterable

_BESIDE: Final = 24
"""Bytes that are repeated beside what is put in, so that a place that has moved is noticed."""


class SourceText:
    """One file: offsets are bytes, lines and columns are 1-based."""

    def __init__(self, file: str, data: bytes) -> None:
        self.file, self.data = file, data
        self.line_break: Final = "\r\n" if b"\r\n" in data[: 1 << 16] else "\n"

    @cached_property
    def text(self) -> str:
        """The whole text; bytes that are no UTF-8 become replacement characters."""
        return self.data.decode("utf-8", "replace")

    @cached_property
    def is_utf8(self) -> bool:
        """Whether it can be edited: every byte is UTF-8, and none is NUL."""
        try:
            self.data.decode("utf-8")
        except UnicodeDecodeError:
            return False
        return b"\0" not in self.data

    @cached_property
    def _starts(self) -> list[int]:
        return [0, *(found.end() for found in re.finditer(rb"\r\n|\r|\n", self.data))]

    def offset(self, line: int, column_bytes: int = 0) -> int:
        """Return where a line begins, and so many bytes (from 0) behind it."""
        return self._starts[min(max(line, 1), len(self._starts)) - 1] + column_bytes

    def line_of(self, offset: int) -> int:
        """Return the line of a byte."""
        return bisect_right(self._starts, offset)

    def line_start(self, offset: int) -> int:
        """Return where the line of a byte begins."""
        return self._starts[self.line_of(offset) - 1]

    def line_end(self, offset: int) -> int:
        """Return where the line of a byte ends, behind its line break."""
        line = self.line_of(offset)
        return self._starts[line] if line < len(self._starts) else len(self.data)

    def place(self, offset: int) -> Place:
        """Return a byte as a place to show."""
        start = self.line_start(offset)
        column = len(self.data[start:offset].decode("utf-8", "replace")) + 1
        return Place(self.file, self.line_of(offset), column)

    def slice(self, start: int, end: int) -> str:
        """Return the text between two offsets."""
        return self.data[start:end].decode("utf-8", "replace")

    def indent_at(self, offset: int) -> str:
        """Return the blanks at the beginning of the line of a byte."""
        line = self.data[self.line_start(offset) : self.line_end(offset)]
        return line[: len(line) - len(line.lstrip(b" \t"))].decode()

    def replaced(self, start: int, end: int, text: str) -> Replacement:
        """Other text in the place of some bytes; with none of them, put in there.

        Raises:
            ValueError: The file is empty, so that nothing marks the place.
        """
        if start < end:
            return Replacement(self.file, start, end, self.slice(start, end), text)
        return self.put_in(start, text)

    def put_in(self, at: int, text: str) -> Replacement:
        """Text put in at a place, marked by what stands before it, or behind it at the start.

        Raises:
            ValueError: The file is empty, so that nothing marks the place.
        """
        if not self.data:
            raise ValueError(self.file)
        if at > 0:
            start = self._boundary(max(0, at - _BESIDE))
            before = self.slice(start, at)
            return Replacement(self.file, start, at, before, before + text)
        end = self._boundary(min(len(self.data), _BESIDE))
        before = self.slice(0, end) or self.slice(0, len(self.data))
        return Replacement(self.file, 0, len(before.encode()), before, text + before)

    def without_lines(self, start: int, end: int) -> Replacement:
        """Take away bytes, with their whole lines where nothing else is on them."""
        first, last = self.line_start(start), self.line_end(max(start, end - 1))
        alone = not self.data[first:start].strip() and not self.data[end:last].strip()
        return self.replaced(first, last, "") if alone else self.replaced(start, end, "")

    def _boundary(self, at: int) -> int:
        """Never amid the bytes of one character."""
        while 0 < at < len(self.data) and self.data[at] & 0xC0 == 0x80:
            at -= 1
        return at


def with_replacements(data: bytes, replacements: Iterable[Replacement]) -> bytes:
    """Return a file's bytes with these changes; of two at one place, the first comes first.

    Raises:
        ValueError: Other bytes are there, or two changes want the same ones.
    """
    changes: list[tuple[int, int, int, bytes]] = []
    for number, one in enumerate(replacements):
        before, text = one.before.encode(), one.text.encode()
        if not before or data[one.start : one.end] != before:
            raise ValueError(one.file)
        head = _alike(before, text)
        tail = _alike(before[head:][::-1], text[head:][::-1])
        changes.append((one.start + head, one.end - tail, number, text[head : len(text) - tail]))
    made, done = b"", 0
    for start, end, _, text in sorted(changes, key=lambda row: row[:3]):
        if start < done:
            raise ValueError("changes overlap")
        made, done = made + data[done:start] + text, end
    return made + data[done:]


def _alike(one: bytes, other: bytes) -> int:
    """Count the bytes with which both begin."""
    pairs = zip(one, other, strict=False)
    return next((n for n, (a, b) in enumerate(pairs) if a != b), min(len(one), len(other)))
