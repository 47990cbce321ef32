"""Where an element of an XML source ends: the source tree knows only where it starts."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING
from xml.parsers import expat

from studio.errors import EditError

if TYPE_CHECKING:
    from studio.description.syntax.source_tree import SourceElement

_START_TAG = re.compile(rb"""<(?:[^"'>]|"[^"]*"|'[^']*')*>""")
_CHUNK_BYTES = 1 << 14
"""Of a large file only what the element takes is looked at."""


@dataclass(frozen=True, slots=True)
class ElementEnd:
    """Byte offsets in the file: behind the start tag, at the end tag, and behind that.

    All three are the same for an element that closes itself, as `<a/>`.
    """

    inside: int
    tag: int
    end: int

    @property
    def closes_itself(self) -> bool:
        """Whether it has no end tag."""
        return self.inside == self.end


def element_end(element: SourceElement) -> ElementEnd:
    """Find the end of an element in the bytes that its tree was parsed from.

    Raises:
        EditError: The bytes there are no element, which cannot be in a tree that was parsed.
    """
    data, offset = element.tree.data, element.offset
    start = _START_TAG.match(data, offset)
    if start is None:
        raise _lost(element)
    inside = start.end()
    if data[inside - 2 : inside] == b"/>":
        return ElementEnd(inside, inside, inside)
    tag = _end_tag(element, offset)
    return ElementEnd(inside, tag, data.index(b">", tag) + 1)


def _end_tag(element: SourceElement, begin: int) -> int:
    """Offset of the end tag of the element whose `<` is at `begin`."""
    ends: list[int] = []
    depth = 0

    def start(_tag: str, _attributes: dict[str, str]) -> None:
        nonlocal depth
        depth += 1

    def end(_tag: str) -> None:
        nonlocal depth
        depth -= 1
        if depth == 0:
            ends.append(parser.CurrentByteIndex)

    parser = expat.ParserCreate(element.tree.encoding)
    parser.StartElementHandler, parser.EndElementHandler = start, end
    data = element.tree.data
    try:
        for at in range(begin, len(data), _CHUNK_BYTES):
            parser.Parse(data[at : at + _CHUNK_BYTES], False)  # noqa: FBT003 - expat's own way
            if ends:
                break
    except expat.ExpatError:
        pass  # it stops behind the element: what follows is not its own
    if not ends:
        raise _lost(element)
    return begin + ends[0]


def _lost(element: SourceElement) -> EditError:
    return EditError(f"{element.place}: the end of this element was not found: reload the file.")
