"""What mends a run that failed at a name that nobody knows: the name that was likely meant."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final

from studio.description.checks.element_mends import ElementMends
from studio.description.syntax.attribute_spans import attribute_spans
from studio.description.syntax.text_mends import TextMends
from studio.errors import EditError

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from studio.description.faults import Fault
    from studio.description.syntax.source_tree import SourceElement, SourceTree
    from studio.problems import Fix, Replacement

_SEGMENT: Final = re.compile(rb"\$\{[^}]*\}|\$\([^)]*\)")
_CALL: Final = "xacro:"


def mend_of(fault: Fault, trees: Mapping[str, SourceTree]) -> Fix | None:
    """Write the other name where the wrong one stands; None where that is not one sure place."""
    if fault.misnamed is None or fault.place is None:
        return None
    wrong, meant = fault.misnamed
    tree, place = trees.get(fault.place.file), fault.place
    at = [
        one
        for one in (tree.elements if tree else ())
        if (one.line, one.column) == (place.line, place.column)
    ]
    if not at:
        return None
    edits = tuple(edit for one in at for edit in _edits(fault.code, one, wrong, meant))
    return ElementMends(at[0]).fix(f'Write "{meant}"', *edits)


def _edits(code: str, element: SourceElement, wrong: str, meant: str) -> Iterator[Replacement]:
    mends = ElementMends(element)
    if code == "unknown-macro" and element.tag == f"{_CALL}{wrong}":
        yield from mends.tag(f"{_CALL}{meant}")
    elif code == "unknown-parameter":
        yield from (edit for edit in (mends.attribute_name(wrong, meant),) if edit)
    elif code in {"unknown-macro", "unknown-block"}:
        for name in ("macro", "name"):
            if element.attributes.get(name) == wrong and (edit := mends.value(name, meant)):
                yield edit
    elif code == "file-unreadable":
        yield from _file_name(element, wrong, meant)
    else:
        yield from _in_expressions(element, wrong, meant)


def _file_name(element: SourceElement, wrong: str, meant: str) -> Iterator[Replacement]:
    """The end of the path that an include or an expression names."""
    tree = element.tree
    mends = TextMends(tree.path, tree.data, tree.encoding)
    name = re.compile(rb"(?<=[/'\"])" + re.escape(wrong.encode()) + rb"(?=['\"])")
    try:
        spans = attribute_spans(tree.data, element.offset)
    except EditError:
        return
    for span in spans.values():
        found = name.search(tree.data, span.start - 1, span.end + 1)
        if found is not None:
            yield mends.replaced(*found.span(), meant)


def _in_expressions(element: SourceElement, wrong: str, meant: str) -> Iterator[Replacement]:
    """The name wherever an attribute of the element evaluates it."""
    tree = element.tree
    if not any(wrong in text for text in element.attributes.values()):
        return
    mends = TextMends(tree.path, tree.data, tree.encoding)
    name = re.compile(rb"(?<![\w.'\"])" + re.escape(wrong.encode()) + rb"(?![\w'\"(])")
    try:
        spans = attribute_spans(tree.data, element.offset)
    except EditError:
        return
    for span in spans.values():
        for segment in _SEGMENT.finditer(tree.data, span.start, span.end):
            for found in name.finditer(tree.data, *segment.span()):
                yield mends.replaced(*found.span(), meant)
