"""Line and column where the text of an attribute begins."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final

from studio.description.evaluator.param_spans import param_defaults
from studio.description.syntax.attribute_spans import attribute_spans
from studio.errors import EditError
from studio.problems import Place

if TYPE_CHECKING:
    from studio.description.syntax.source_tree import SourceElement

_LINE_END: Final = re.compile(rb"\r\n?|\n")


def attribute_place(element: SourceElement, attribute: str, param: str = "") -> Place:
    """Where an attribute's text begins; with `param`, the default of that macro parameter.

    An element that has no such attribute is answered by its own place.
    """
    data = element.tree.data
    try:
        span = attribute_spans(data, element.offset)[attribute]
        start = span.start
        if param:
            defaults = param_defaults(data, span, element.tree.encoding)
            start = next((one.span.start for one in defaults if one.name == param), start)
    except (EditError, KeyError):
        return element.place
    return _place_at(element, start)


def _place_at(element: SourceElement, byte: int) -> Place:
    """The place of a byte at or behind the `<` of an element."""
    before = element.tree.data[element.offset : byte]
    ends = list(_LINE_END.finditer(before))
    if not ends:
        column = element.column + _characters(element, before)
        return Place(element.tree.path, element.line, column)
    column = _characters(element, before[ends[-1].end() :]) + 1
    return Place(element.tree.path, element.line + len(ends), column)


def _characters(element: SourceElement, data: bytes) -> int:
    return len(data) if data.isascii() else len(data.decode(element.tree.encoding, "replace"))
