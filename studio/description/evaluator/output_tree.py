"""The tree that an evaluation makes, and how it is written as XML text."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final, TypeAlias, cast

from studio.description.faults import Refusal
from studio.description.syntax.source_tree import SourceComment, SourceElement, SourceText
from studio.problems import MacroCall

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from studio.description.evaluator.graph import Record

_AS_WRITTEN: Final[Mapping[str, Record]] = {}


class CallFrame:
    """One macro call on the way to an element; `outer` is the call around it."""

    __slots__ = ("call", "depth", "macro", "outer")

    def __init__(self, macro: str, call: SourceElement, outer: CallFrame | None) -> None:
        self.macro, self.call, self.outer = macro, call, outer
        self.depth: int = outer.depth + 1 if outer else 1


class OutputElement:
    """One element that came out; it can be evaluated again, as xacro does with blocks."""

    __slots__ = ("attributes", "calls", "children", "makers", "origin", "tag")

    def __init__(self, tag: str, origin: SourceElement, calls: CallFrame | None) -> None:
        self.tag, self.origin, self.calls = tag, origin, calls
        self.attributes: dict[str, str] = {}
        """Replaced, never changed: elements share it with each other and with their source."""
        self.children: list[OutputChild] = []
        """Comments only where they were asked for."""
        self.makers: Mapping[str, Record] = _AS_WRITTEN
        """By attribute, the evaluation that made it; those that stand as written are missing."""

    @property
    def comes_out(self) -> bool:
        """Whether it is an element of the robot, not what xacro evaluates children in."""
        return not self.tag.startswith("xacro:")

    def made(self, name: str, record: Record) -> None:
        """Note which evaluation made an attribute."""
        if self.makers is _AS_WRITTEN:
            self.makers = {}
        cast("dict[str, Record]", self.makers)[name] = record

    def elements(self) -> Iterator[OutputElement]:
        """Its child elements, in order."""
        return (child for child in self.children if isinstance(child, OutputElement))

    def walk(self) -> Iterator[OutputElement]:
        """Itself and all elements below, in document order."""
        yield self
        for child in self.children:
            if isinstance(child, OutputElement):
                yield from child.walk()


Node: TypeAlias = SourceElement | OutputElement
OutputChild: TypeAlias = OutputElement | SourceText | SourceComment
ChildNode: TypeAlias = SourceElement | OutputElement | SourceText | SourceComment

OUTPUT_LIMIT: Final = 64_000_000
"""Characters of one robot."""
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


def macro_calls(frame: CallFrame | None) -> tuple[MacroCall, ...]:
    """The calls that lead to a frame, the outermost first."""
    calls: list[MacroCall] = []
    while frame is not None:
        calls.append(MacroCall(frame.macro, frame.call.place))
        frame = frame.outer
    return tuple(reversed(calls))


def write_xml(element: OutputElement, extra_attributes: dict[str, str] | None = None) -> str:
    """One line of XML, attributes in their order; `extra_attributes` go on the element itself.

    Raises:
        Refusal: It would be longer than OUTPUT_LIMIT: few texts in a file can come out often.
    """
    out: list[str] = []
    attributes = element.attributes
    _write(element, out, attributes | extra_attributes if extra_attributes else attributes)
    if sum(map(len, out)) > OUTPUT_LIMIT:
        raise Refusal("output-too-large", "The robot comes to more text than can be shown.")
    return "".join(out)


def _write(element: OutputElement, out: list[str], attributes: dict[str, str]) -> None:
    out.append("<" + element.tag)
    for name, value in attributes.items():
        text = _IN_ATTRIBUTE.sub(_escape, value) if _IN_ATTRIBUTE.search(value) else value
        out.append(f' {name}="{text}"')
    if not element.children:
        out.append("/>")
        return
    out.append(">")
    for child in element.children:
        if isinstance(child, OutputElement):
            _write(child, out, child.attributes)
        elif isinstance(child, SourceComment):
            out.append(f"<!--{child.text}-->")
        else:
            out.append(_IN_TEXT.sub(_escape, child.text))
    out.append(f"</{element.tag}>")


def _escape(match: re.Match[str]) -> str:
    return _ESCAPES[match[0]]
