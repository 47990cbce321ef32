"""Fixes of findings in the text of the robot: edits of literal text, or none at all."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final

from studio.description.syntax.attribute_spans import attribute_bytes, attribute_spans, quoted
from studio.description.syntax.source_tree import SourceElement, SourceError, parse_source
from studio.errors import EditError
from studio.problems import Fix, Replacement
from studio.robot.checks.finding import AddChild, RemoveChild, SetAttributes, SwapAttributes

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from studio.description.values import Part, Span
    from studio.problems import Place
    from studio.robot.checks.finding import Mend

_INDENT: Final = re.compile(rb"\n[ \t]*\Z")
_TAG_NAME: Final = re.compile(rb"<[^\s/>]+")


class Mender:
    """Turns mends into fixes; reads each file once.

    Args:
        source: The bytes of a file as it is edited now; None when it cannot be read.
    """

    def __init__(self, source: Callable[[str], bytes | None]) -> None:
        self._source = source
        self._elements: dict[str, dict[Place, SourceElement]] = {}

    def fix(self, mend: Mend, part: Part) -> Fix | None:
        """Return the fix of a mend at the element that a part was written as.

        None where that would not be safe: the text is not literal, a macro writes other parts
        with it, or the file is no longer what the part came from.
        """
        element = self._element(part)
        if element is None:
            return None
        try:
            edits = tuple(_edits(mend, element, is_from_macro=bool(part.calls)))
        except EditError:
            return None
        return Fix(mend.label, "edit", edits=edits) if edits else None

    def _element(self, part: Part) -> SourceElement | None:
        place = part.place
        if place.file not in self._elements:
            self._elements[place.file] = self._read(place.file)
        found = self._elements[place.file].get(place)
        kind = part.key.partition(":")[0]
        return found if found is not None and found.tag == kind else None

    def _read(self, file: str) -> dict[Place, SourceElement]:
        data = self._source(file)
        if data is None:
            return {}
        try:
            tree = parse_source(file, data)
        except SourceError:
            return {}
        return {one.place: one for one in tree.elements}


def _edits(mend: Mend, element: SourceElement, *, is_from_macro: bool) -> Iterator[Replacement]:
    match mend:
        case SwapAttributes():
            yield from _swap(mend, element, is_from_macro=is_from_macro)
        case SetAttributes():
            if not (mend.is_for_one and is_from_macro):
                for one in _below(element, mend.path):
                    if _is_meant(one, mend.where):
                        yield from _set(one, mend.texts)
        case AddChild():
            yield _add(mend.xml, element)
        case RemoveChild():
            (child,) = _only(element, mend.tag)
            yield _remove(child)


def _swap(
    mend: SwapAttributes, element: SourceElement, *, is_from_macro: bool
) -> Iterator[Replacement]:
    (child,) = _only(element, mend.tag)
    raw = {name: child.attributes.get(name) for name in (mend.one, mend.other)}
    if None in raw.values():  # a missing one counts as 0
        yield from _set(child, tuple((n, raw[o] or "0") for n, o in _crossed(mend)))
        return
    if is_from_macro and any("$" in (text or "") for text in raw.values()):
        raise EditError("Another call of the macro may have them the right way round.")
    spans = attribute_spans(child.tree.data, child.offset)
    texts = {name: _text(child, spans[name]) for name in raw}
    for name, other in _crossed(mend):
        if spans[name].syntax != spans[other].syntax:
            raise EditError("What is in other quotes may not be moved.")
        yield _replaced(child, spans[name], texts[other])


def _crossed(mend: SwapAttributes) -> tuple[tuple[str, str], tuple[str, str]]:
    return (mend.one, mend.other), (mend.other, mend.one)


def _only(element: SourceElement, tag: str) -> tuple[SourceElement]:
    """Return the only child of that tag.

    Raises:
        EditError: It has none, or several: conditions choose among them.
    """
    found = [child for child in element.elements() if child.tag == tag]
    if len(found) != 1:
        raise EditError(f"{element.place}: there is no single <{tag}> here.")
    return (found[0],)


def _below(element: SourceElement, path: tuple[str, ...]) -> list[SourceElement]:
    found = [element]
    for tag in path:
        found = [one for above in found for one in above.elements() if tag in {"*", one.tag}]
    return found


def _is_meant(element: SourceElement, where: tuple[str, str] | None) -> bool:
    return where is None or element.attributes.get(where[0]) == where[1]


def _set(element: SourceElement, texts: tuple[tuple[str, str], ...]) -> Iterator[Replacement]:
    """Write attributes over; those that are missing in one go behind the tag's name."""
    if any("$" in element.attributes.get(name, "") for name, _ in texts):
        raise EditError("What is worked out is not overwritten by a number.")
    spans = attribute_spans(element.tree.data, element.offset)
    missing = [(name, text) for name, text in texts if name not in spans]
    for name, text in texts:
        if name in spans:
            yield _replaced(
                element, spans[name], attribute_bytes(text, spans[name].syntax).decode()
            )
    if missing:
        tag = _TAG_NAME.match(element.tree.data, element.offset)
        if tag is None:
            raise EditError(f"{element.place}: no tag starts here: reload the file.")
        written = tag[0].decode(element.tree.encoding)
        added = "".join(f" {name}={quoted(text)}" for name, text in missing)
        yield Replacement(element.tree.path, *tag.span(), written, written + added)


def _replaced(element: SourceElement, span: Span, text: str) -> Replacement:
    before = _text(element, span)
    if not before:
        raise EditError("An empty text cannot be known again.")
    return Replacement(element.tree.path, span.start, span.end, before, text)


def _text(element: SourceElement, span: Span) -> str:
    return element.tree.data[span.start : span.end].decode(element.tree.encoding)


def _add(xml: str, element: SourceElement) -> Replacement:
    """Put an element in front of the end tag, on a line of its own where the others have one."""
    data, end_tag, end = element.tree.data, element.end_tag, element.end
    if element.closes_itself:
        raise EditError(f"{element.place}: this element holds nothing to stand beside.")
    first = next(element.elements(), None)
    indent = _INDENT.search(data[: first.offset]) if first else None
    own = _INDENT.search(data[:end_tag])
    closing = data[end_tag:end].decode(element.tree.encoding)
    if indent is None or own is None:
        return Replacement(element.tree.path, end_tag, end, closing, xml + closing)
    step, back = indent[0][1:].decode(), own[0].decode()
    start = end_tag - len(back) + 1
    line = data[start:end].decode(element.tree.encoding)
    newline = "\r\n" if data[: own.start()].endswith(b"\r") else "\n"
    return Replacement(element.tree.path, start, end, line, f"{step}{xml}{newline}{line}")


def _remove(element: SourceElement) -> Replacement:
    """Take an element out, with its line where it has that for itself."""
    data, start, end = element.tree.data, element.offset, element.end
    indent = _INDENT.search(data[:start])
    if indent and data[end : end + 2].strip(b"\r")[:1] == b"\n":
        start -= len(indent[0]) + (1 if data[: indent.start()].endswith(b"\r") else 0)
    before = data[start:end].decode(element.tree.encoding)
    if "$" in before:
        raise EditError("What is worked out is not taken away.")
    return Replacement(element.tree.path, start, end, before, "")
