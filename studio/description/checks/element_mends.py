"""Edits of one element where it is written; None where the text is no longer what was read."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final
from xml.sax.saxutils import quoteattr

from studio.description.syntax.attribute_spans import attribute_spans
from studio.description.syntax.element_ends import element_end
from studio.description.syntax.text_mends import TextMends
from studio.errors import EditError

if TYPE_CHECKING:
    from studio.description.syntax.source_tree import SourceElement
    from studio.problems import Fix, Replacement

_BLANKS: Final = re.compile(rb"[ \t]*\r?\n")


class ElementMends:
    """Makes fixes at one element of a source tree."""

    def __init__(self, element: SourceElement) -> None:
        self._element, self._tree = element, element.tree
        self._mends = TextMends(element.tree.path, element.tree.data, element.tree.encoding)

    def fix(self, label: str, *edits: Replacement | None) -> Fix | None:
        """A fix that is these edits; none when one of them cannot be made."""
        made = [edit for edit in edits if edit is not None]
        return self._mends.fix(label, *made) if made and len(made) == len(edits) else None

    def written(self, name: str) -> str | None:
        """An attribute that says the same wherever it is used; None: it is worked out, or none."""
        text = self._element.attributes.get(name)
        return None if text is None or "$" in text else text

    def value(self, name: str, text: str) -> Replacement | None:
        """Another literal value of an attribute."""
        try:
            span = attribute_spans(self._tree.data, self._element.offset).get(name)
        except EditError:
            return None
        if span is None or self.written(name) is None or span.start == span.end:
            return None
        return self._mends.replaced(span.start, span.end, quoteattr(text)[1:-1])

    def attribute(self, name: str, text: str) -> Replacement | None:
        """One more attribute, right behind the element's name."""
        start, tag = self._element.offset + 1, self._element.tag.encode()
        if not self._tree.data.startswith(tag, start):
            return None
        return self._mends.put_in(start + len(tag), f" {name}={quoteattr(text)}")

    def attribute_name(self, name: str, other: str) -> Replacement | None:
        """Another name of an attribute."""
        try:
            span = attribute_spans(self._tree.data, self._element.offset).get(name)
        except EditError:
            return None
        at = self._tree.data.rfind(name.encode(), self._element.offset, span.start) if span else -1
        return self._mends.replaced(at, at + len(name.encode()), other) if at > 0 else None

    def tag(self, other: str) -> tuple[Replacement, ...]:
        """Another name of the element, at its start and at its end; empty when that is not sure."""
        data, name = self._tree.data, self._element.tag.encode()
        start = self._element.offset + 1
        try:
            end = element_end(self._element)
        except EditError:
            return ()
        if not data.startswith(name, start):
            return ()
        first = self._mends.replaced(start, start + len(name), other)
        if end.closes_itself:
            return (first,)
        closing = data.find(name, end.tag, end.end)
        return (first, self._mends.replaced(closing, closing + len(name), other))

    def before(self, xml: str) -> Replacement:
        """An element put in on a line before this one."""
        offset = self._element.offset
        indent = self._mends.indent_at(offset)
        return self._mends.put_in(offset, f"{xml}{self._mends.line_break}{indent}")

    def after(self, xml: str) -> Replacement | None:
        """An element put in on a line behind this one."""
        try:
            end = element_end(self._element).end
        except EditError:
            return None
        indent = self._mends.indent_at(self._element.offset)
        return self._mends.put_in(end, f"{self._mends.line_break}{indent}{xml}")

    def gone(self) -> Replacement | None:
        """The element taken out, with its line when it has that for itself."""
        data, start = self._tree.data, self._element.offset
        try:
            end = element_end(self._element).end
        except EditError:
            return None
        line_end = _BLANKS.match(data, end)
        if line_end is not None and self._mends.begins_line(start):
            start, end = data.rfind(b"\n", 0, start) + 1, line_end.end()
        return self._mends.replaced(start, end, "")
