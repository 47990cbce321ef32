"""An element of an expanded robot: a plain value that crosses pipes, and its XML text."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final, NamedTuple, overload

if TYPE_CHECKING:
    from collections.abc import Iterator

_IN_TEXT: Final = re.compile(r"[&<>]")
_IN_ATTRIBUTE: Final = re.compile(r"[&<>\"\t\n\r]")
_ESCAPES: Final = {
    "&": "&amp;",
    "<": "&lt;",
    ">": "&gt;",
    '"': "&quot;",
    "\t": "&#9;",
    "\n": "&#10;",
    "\r": "&#13;",
}


class Element(NamedTuple):
    """Tag and attributes as written, prefixes included; attributes are never changed."""

    tag: str
    attributes: dict[str, str]
    children: tuple[Element | str, ...] = ()
    """Elements and the texts between them."""

    @overload
    def get(self, name: str) -> str | None: ...
    @overload
    def get(self, name: str, default: str) -> str: ...
    def get(self, name: str, default: str | None = None) -> str | None:
        """Return the text of an attribute."""
        return self.attributes.get(name, default)

    def elements(self, tag: str | None = None) -> Iterator[Element]:
        """Yield the child elements in order, or those of one tag."""
        for child in self.children:
            if not isinstance(child, str) and (tag is None or child.tag == tag):
                yield child

    def find(self, tag: str) -> Element | None:
        """Return the first child element of a tag."""
        for child in self.children:
            if not isinstance(child, str) and child.tag == tag:
                return child
        return None

    @property
    def xml(self) -> str:
        """The element on one line, attributes in their order."""
        out: list[str] = []
        _write(self, out)
        return "".join(out)


def _write(element: Element, out: list[str]) -> None:
    out.append("<" + element.tag)
    for name, value in element.attributes.items():
        text = _IN_ATTRIBUTE.sub(_escape, value) if _IN_ATTRIBUTE.search(value) else value
        out.append(f' {name}="{text}"')
    if not element.children:
        out.append("/>")
        return
    out.append(">")
    for child in element.children:
        if isinstance(child, str):
            out.append(_IN_TEXT.sub(_escape, child))
        else:
            _write(child, out)
    out.append(f"</{element.tag}>")


def _escape(match: re.Match[str]) -> str:
    return _ESCAPES[match[0]]
