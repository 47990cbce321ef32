"""Replacements that mend a text, or one element of it.

Each replacement repeats enough of the text around it to be found again after other edits.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final

from studio.description.syntax.attribute_spans import attribute_bytes, attribute_spans, quoted
from studio.errors import EditError
from studio.problems import Fix, Replacement

if TYPE_CHECKING:
    from studio.description.syntax.source_tree import SourceElement

_BESIDE: Final = 12
"""Bytes that are repeated beside what is put in."""
_BLANKS: Final = re.compile(rb"[ \t]*\r?\n")


class TextMends:
    """Makes fixes for one text; offsets are bytes of `data`, new text is escaped by the caller."""

    def __init__(self, file: str, data: bytes, encoding: str) -> None:
        self._file, self._data, self._encoding = file, data, encoding
        self.line_break: Final = "\r\n" if b"\r\n" in data[: 1 << 16] else "\n"

    def text(self, start: int, end: int) -> str:
        """Return the text there."""
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
        """Return a fix that is these edits."""
        return Fix(label, "edit", edits=edits)

    def indent_at(self, at: int) -> str:
        """Return the blanks before what stands there on its line; empty when it begins no line."""
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


class ElementMends:
    """Makes fixes at one element of a source tree."""

    def __init__(self, element: SourceElement) -> None:
        self._element, self._tree = element, element.tree
        self._mends = TextMends(element.tree.path, element.tree.data, element.tree.encoding)

    def fix(self, label: str, *edits: Replacement | None) -> Fix | None:
        """Return a fix that is these edits; none when one of them cannot be made."""
        made = [edit for edit in edits if edit is not None]
        return self._mends.fix(label, *made) if made and len(made) == len(edits) else None

    def written(self, name: str) -> str | None:
        """Return an attribute if it is the same at every use; None: it is computed, or missing."""
        text = self._element.attributes.get(name)
        return None if text is None or "$" in text else text

    def value(self, name: str, text: str) -> Replacement | None:
        """Return an edit that changes the literal value of an attribute."""
        try:
            span = attribute_spans(self._tree.data, self._element.offset).get(name)
            if span is None or self.written(name) is None or span.start == span.end:
                return None
            written = attribute_bytes(text, span.syntax).decode()
        except EditError:
            return None
        return self._mends.replaced(span.start, span.end, written)

    def attribute(self, name: str, text: str) -> Replacement | None:
        """Return an edit that adds an attribute, right behind the element's name."""
        start, tag = self._element.offset + 1, self._element.tag.encode()
        if not self._tree.data.startswith(tag, start):
            return None
        return self._mends.put_in(start + len(tag), f" {name}={quoted(text)}")

    def attribute_name(self, name: str, other: str) -> Replacement | None:
        """Return an edit that renames an attribute."""
        try:
            span = attribute_spans(self._tree.data, self._element.offset).get(name)
        except EditError:
            return None
        at = self._tree.data.rfind(name.encode(), self._element.offset, span.start) if span else -1
        return self._mends.replaced(at, at + len(name.encode()), other) if at > 0 else None

    def tag(self, other: str) -> tuple[Replacement, ...]:
        """Return edits that rename the element at its start and end; empty when in doubt."""
        data, name = self._tree.data, self._element.tag.encode()
        start = self._element.offset + 1
        try:
            end = self._element.end
        except EditError:
            return ()
        if not data.startswith(name, start):
            return ()
        first = self._mends.replaced(start, start + len(name), other)
        if self._element.closes_itself:
            return (first,)
        closing = data.find(name, self._element.end_tag, end)
        return (first, self._mends.replaced(closing, closing + len(name), other))

    def before(self, xml: str) -> Replacement:
        """Return an element put in on a line before this one."""
        offset = self._element.offset
        indent = self._mends.indent_at(offset)
        return self._mends.put_in(offset, f"{xml}{self._mends.line_break}{indent}")

    def after(self, xml: str) -> Replacement | None:
        """Return an element put in on a line behind this one."""
        try:
            end = self._element.end
        except EditError:
            return None
        indent = self._mends.indent_at(self._element.offset)
        return self._mends.put_in(end, f"{self._mends.line_break}{indent}{xml}")

    def gone(self) -> Replacement | None:
        """Return the element taken out, with its line when it has that for itself."""
        data, start = self._tree.data, self._element.offset
        try:
            end = self._element.end
        except EditError:
            return None
        line_end = _BLANKS.match(data, end)
        if line_end is not None and self._mends.begins_line(start):
            start, end = data.rfind(b"\n", 0, start) + 1, line_end.end()
        return self._mends.replaced(start, end, "")
