"""The tree that an evaluation makes: its elements, its parts as XML, and what came out where."""

from __future__ import annotations

import re
from functools import cached_property
from typing import TYPE_CHECKING, Final, NamedTuple, TypeAlias, cast

from studio.description.faults import Refusal
from studio.description.syntax.source_tree import SourceComment, SourceElement, SourceText
from studio.description.values import Part
from studio.problems import MacroCall

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from studio.description.evaluator.graph import Record

_AS_WRITTEN: Final[Mapping[str, Record]] = {}
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
_NAMED: Final = frozenset({"link", "joint", "material"})


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


def part_keys(root: OutputElement) -> list[tuple[str, OutputElement]]:
    """A key for each top-level element, in order, as `Part.key` says."""
    keyed: list[tuple[str, OutputElement]] = []
    used: dict[str, int] = {}
    others = 0
    for element in root.elements():
        name = element.attributes.get("name")
        if element.tag in _NAMED and name is not None:
            key = f"{element.tag}:{name}"
        else:
            key, others = f"other:{others}", others + 1
        count = used[key] = used.get(key, 0) + 1
        keyed.append((key if count == 1 else f"{key}#{count}", element))
    return keyed


class WrittenPart(NamedTuple):
    """A part as text; the rest of it is worked out by `part_of` when somebody asks."""

    key: str
    xml: str
    element: OutputElement


def write_parts(root: OutputElement) -> list[WrittenPart]:
    """Write each top-level element as XML that stands alone, prefixes declared.

    Raises:
        Refusal: All of them together are longer than OUTPUT_LIMIT.
    """
    prefixes = _prefixes(root)
    parts = [
        WrittenPart(key, _part_xml(element, prefixes), element) for key, element in part_keys(root)
    ]
    if sum(len(part.xml) for part in parts) > OUTPUT_LIMIT:
        raise Refusal("output-too-large", "The robot comes to more text than can be shown.")
    return parts


def write_part(root: OutputElement, key: str, element: OutputElement) -> WrittenPart:
    """Write one of them."""
    return WrittenPart(key, _part_xml(element, _prefixes(root)), element)


def _prefixes(root: OutputElement) -> dict[str, tuple[str, str]]:
    return {
        name[6:]: (name, value)
        for name, value in root.attributes.items()
        if name.startswith("xmlns:")
    }


def part_of(written: WrittenPart) -> Part:
    """A part with where it was written and the macro calls that led to it."""
    element = written.element
    return Part(written.key, written.xml, element.origin.place, macro_calls(element.calls))


def _part_xml(element: OutputElement, prefixes: Mapping[str, tuple[str, str]]) -> str:
    xml = write_xml(element)
    declared = {
        name: value
        for prefix, (name, value) in prefixes.items()
        if f"{prefix}:" in xml and name not in element.attributes
    }
    return write_xml(element, declared) if declared else xml


class OutputIndex:
    """The tree of one run, looked up from below. Attributes and texts may change meanwhile."""

    def __init__(self, root: OutputElement) -> None:
        self.root = root
        self.keys = {element: key for key, element in part_keys(root)}
        """The key of each part, by its element, in the order of the robot."""
        self.part_of: dict[OutputElement, OutputElement] = {}
        """The part's element, by any element in it; what did not come out is missing."""
        self.came_out: dict[SourceElement, list[OutputElement]] = {root.origin: [root]}
        """The elements that each source element came out as."""
        for part in self.keys:
            for element in part.walk():
                self.part_of[element] = part
                self.came_out.setdefault(element.origin, []).append(element)

    def keys_by_source(self) -> dict[SourceElement, tuple[str, ...]]:
        """Which parts each source element came out in; one that is in no part is missing."""
        found: dict[SourceElement, dict[str, None]] = {}
        for element, part in self.part_of.items():
            found.setdefault(element.origin, {})[self.keys[part]] = None
        return {element: tuple(keys) for element, keys in found.items()}

    @cached_property
    def parts_of_text(self) -> Mapping[SourceText, list[OutputElement]]:
        """The parts in which a text came out; copies of a block share their texts."""
        found: dict[SourceText, list[OutputElement]] = {}
        for element, part in self.part_of.items():
            for child in element.children:
                if isinstance(child, SourceText):
                    found.setdefault(child, []).append(part)
        return found
