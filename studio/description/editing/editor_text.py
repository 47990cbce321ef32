"""Conversion between a file's bytes and the text that a browser's editor holds.

The editor's text has no byte order mark, every line break (CRLF, LF, CR) is one LF, and offsets
count UTF-16 code units from 0, as JavaScript does. A byte that is not valid in the file's encoding
is shown as U+FFFD and stays the byte that it is. What an edit does not touch keeps its bytes.

`changes_between` returns what changed between two such texts, for editors that follow it.
"""

from __future__ import annotations

import codecs
import re
from bisect import bisect_left, bisect_right
from dataclasses import dataclass
from functools import cached_property
from itertools import accumulate
from typing import TYPE_CHECKING, Final

from studio.description.editing.edits import common_start
from studio.description.syntax.attribute_spans import text_encoding, writing_encoding
from studio.description.values import Edit
from studio.errors import EditError

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

_LINE_BREAK: Final = re.compile(r"\r\n|\r|\n")
_BREAK_TO_COME: Final = re.compile(r"\r\n?|\n")
_NOT_TEXT: Final = re.compile("[\udc80-\udcff]")
_BEYOND_ONE_UNIT: Final = re.compile("[\U00010000-\U0010ffff]")


class EditorText:
    """The text of one state of a file; `data` are its bytes."""

    def __init__(self, data: bytes) -> None:
        self.data = data
        self._encoding = _readable_encoding(data)
        self._bom_bytes = len(codecs.BOM_UTF8) if data.startswith(codecs.BOM_UTF8) else 0
        self._raw = data[self._bom_bytes :].decode(self._encoding, "surrogateescape")
        shown = self._raw if data.isascii() else _NOT_TEXT.sub("\ufffd", self._raw)
        self.text = _LINE_BREAK.sub("\n", shown) if "\r" in shown else shown
        """The text in the editor."""

    @cached_property
    def line_break(self) -> str:
        """The file's own line break: its first; LF when it has none."""
        found = _LINE_BREAK.search(self._raw)
        return found[0] if found else "\n"

    @property
    def length(self) -> int:
        """Length of the editor's text in code units."""
        return self.offset_of(len(self.text))

    def byte_at(self, offset: int) -> int:
        """Return the byte at which the character at an editor's offset begins.

        Raises:
            EditError: The offset lies outside the text, or within a character.
        """
        return self._bom_bytes + self._bytes_between(0, self.index_of(offset))

    def offset_at(self, byte: int) -> int:
        """Return the editor's offset of a byte's character; the nearest end outside."""
        decoder = codecs.getincrementaldecoder(self._encoding)("surrogateescape")
        before = decoder.decode(self.data[self._bom_bytes : max(byte, self._bom_bytes)])
        in_break = before.endswith("\r") and self._raw[len(before) : len(before) + 1] == "\n"
        return self.offset_of(len(before) - before.count("\r\n") - in_break)

    def index_of(self, offset: int) -> int:
        """Return the index into `text` of an editor's offset.

        Raises:
            EditError: The offset lies outside the text, or within a character.
        """
        passed = bisect_left(self._wide_offsets, offset)
        is_within = self._wide_offsets[passed : passed + 1] == [offset]
        if is_within or not 0 <= offset - passed <= len(self.text):
            raise EditError(f"The text has no place {offset} to edit: load it again.")
        return offset - passed

    def offset_of(self, index: int) -> int:
        """Return the editor's offset of an index into `text`."""
        return index + bisect_left(self._wide_indices, index)

    def edit(self, file: str, start: int, end: int, text: str) -> Edit:
        """Return the edit of the bytes that puts `text` in the place of the editor's [start, end).

        Line breaks of `text` become the file's own.

        Raises:
            EditError: The place is not in the text, or the encoding lacks a character of it.
        """
        if end < start:
            raise EditError(f"The text has no place {start} to {end} to edit: load it again.")
        new = _BREAK_TO_COME.sub(self.line_break, text)
        return Edit(file, self.byte_at(start), self.byte_at(end), self._encoded(new))

    def replacements(self, file: str, spans: Iterable[tuple[int, int]], text: str) -> list[Edit]:
        """Return the edits that put `text` in the place of [start, end)s, the last place first.

        Args:
            file: Of this text.
            spans: Indices into the shown text, one behind the other.
            text: Its line breaks become the file's own.

        Raises:
            EditError: The encoding lacks a character of it.
        """
        new = self._encoded(_BREAK_TO_COME.sub(self.line_break, text))
        edits: list[Edit] = []
        byte = index = 0
        for start, end in spans:
            first = byte + self._bytes_between(index, start)
            byte, index = first + self._bytes_between(start, end), end
            edits.append(Edit(file, self._bom_bytes + first, self._bom_bytes + byte, new))
        return edits[::-1]

    def _bytes_between(self, start: int, end: int) -> int:
        """Return the number of bytes between two indices into `text`."""
        raw_start, raw_end = self._raw_index(start), self._raw_index(end)
        if self._is_of_single_bytes:
            return raw_end - raw_start
        return len(self._raw[raw_start:raw_end].encode("utf-8", "surrogateescape"))

    def _encoded(self, text: str) -> bytes:
        encoding = writing_encoding(self.data) if self._encoding == "utf-8" else self._encoding
        try:
            return text.encode(encoding)
        except UnicodeEncodeError as error:
            raise EditError(
                f"{text[error.start]!r} cannot be written in the encoding that the file declares: "
                f"write &#{ord(text[error.start])}; or declare UTF-8."
            ) from None

    def _raw_index(self, index: int) -> int:
        if not self._has_crlf:
            return index
        shown_starts, raw_starts = self._line_starts
        line = bisect_right(shown_starts, index) - 1
        return raw_starts[line] + index - shown_starts[line]

    @cached_property
    def _has_crlf(self) -> bool:
        return "\r\n" in self._raw

    @cached_property
    def _is_of_single_bytes(self) -> bool:
        return self._encoding != "utf-8" or self.data.isascii()

    @cached_property
    def _line_starts(self) -> tuple[list[int], list[int]]:
        """Return where each line starts: in `text`, and in the text with its own line breaks."""
        raw = [0, *(found.end() for found in _LINE_BREAK.finditer(self._raw))]
        widths = (len(found[0]) - 1 for found in _LINE_BREAK.finditer(self._raw))
        shifts = accumulate(widths, initial=0)
        return [start - shift for start, shift in zip(raw, shifts, strict=True)], raw

    @cached_property
    def _wide_indices(self) -> list[int]:
        """Indices into `text` of the characters that take two code units."""
        if self.data.isascii():
            return []
        return [found.start() for found in _BEYOND_ONE_UNIT.finditer(self.text)]

    @cached_property
    def _wide_offsets(self) -> list[int]:
        """Offsets of the second code units of those characters."""
        return [index + number + 1 for number, index in enumerate(self._wide_indices)]


def _readable_encoding(data: bytes) -> str:
    """UTF-8, or the one-byte encoding that an XML file declares; others count as UTF-8."""
    encoding = text_encoding(data)
    if encoding == "utf-8":
        return encoding
    every_byte = bytes(range(256))
    try:
        characters = every_byte.decode(encoding, "surrogateescape")
        is_exact = characters.encode(encoding, "surrogateescape") == every_byte
    except (LookupError, ValueError):
        return "utf-8"
    return encoding if is_exact and len(characters) == len(every_byte) else "utf-8"


@dataclass(frozen=True, slots=True)
class Piece:
    """Replaces characters [start, end) of the text before by `text`."""

    start: int
    end: int
    text: str


def changes_between(old: str, new: str) -> tuple[Piece, ...]:
    """Return the pieces that lead from `old` to `new`, in order, none touching another.

    A single stretch, except where as many lines stood there before: then each changed line alone,
    so that what stands between them stays in place.
    """
    if old == new:
        return ()
    # Only what is between the first and the last difference is compared closely.
    start = old.rfind("\n", 0, common_start(old, new)) + 1
    end = common_start(old[start:][::-1], new[start:][::-1])
    before, after = old[start : len(old) - end], new[start : len(new) - end]
    if before.count("\n") == after.count("\n"):
        return tuple(_line_by_line(before.split("\n"), after.split("\n"), start))
    return (_one_piece(before, after, start),)


def patched(old: str, pieces: Iterable[Piece]) -> str:
    """Return the text that the pieces lead to; in order, none overlapping."""
    parts: list[str] = []
    at = 0
    for piece in pieces:
        parts += [old[at : piece.start], piece.text]
        at = piece.end
    return "".join((*parts, old[at:]))


def _line_by_line(before: list[str], after: list[str], at: int) -> Iterator[Piece]:
    for old, new in zip(before, after, strict=True):
        if old != new:
            yield _one_piece(old, new, at)
        at += len(old) + 1


def _one_piece(old: str, new: str, offset: int) -> Piece:
    start = common_start(old, new)
    end = common_start(old[start:][::-1], new[start:][::-1])
    return Piece(offset + start, offset + len(old) - end, new[start : len(new) - end])
