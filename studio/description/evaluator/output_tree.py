"""The tree that an evaluation makes: its elements, its parts as values, and what came out where."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Final, NamedTuple, TypeAlias, cast

from studio.description.elements import Element
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
_MARKS: Final = 4
"""Brackets, quotes and blanks of an element or attribute, in characters."""
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
        """By attribute, the evaluation that made it; literal ones are missing."""

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
        """Yield its child elements, in order."""
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
    """Return the calls that lead to a frame, the outermost first."""
    calls: list[MacroCall] = []
    while frame is not None:
        calls.append(MacroCall(frame.macro, frame.call.place))
        frame = frame.outer
    return tuple(reversed(calls))


def write_xml(element: OutputElement) -> str:
    """Return one line of XML, attributes in their order.

    Raises:
        Refusal: As `plain_element`.
    """
    return plain_element(element).xml


def plain_element(element: OutputElement) -> Element:
    """Return an element and all below it as a value; comments are left out.

    Raises:
        Refusal: It is longer than OUTPUT_LIMIT: few texts in a file can come out often.
    """
    return _Plain().element(element)


class _Plain:
    """Makes values of elements, and counts the characters of all of them."""

    def __init__(self) -> None:
        self._characters = 0

    def element(self, element: OutputElement) -> Element:
        """Return one of them."""
        made = self._element(element)
        if self._characters > OUTPUT_LIMIT:
            raise Refusal("output-too-large", "The robot comes to more text than can be shown.")
        return made

    def _element(self, element: OutputElement) -> Element:
        attributes = element.attributes
        self._characters += 2 * len(element.tag) + sum(map(len, attributes.values()))
        self._characters += sum(map(len, attributes)) + _MARKS * (1 + len(attributes))
        if not element.children:
            return Element(element.tag, attributes)
        children: list[Element | str] = []
        for child in element.children:
            if isinstance(child, OutputElement):
                children.append(self._element(child))
            elif isinstance(child, SourceText):
                self._characters += len(child.text)
                children.append(child.text)
        return Element(element.tag, attributes, tuple(children))


def part_keys(root: OutputElement) -> list[tuple[str, OutputElement]]:
    """Return a key for each top-level element, in order, as in `Part.key`."""
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


class PlainPart(NamedTuple):
    """A part as a value; the rest of it is worked out by `part_of` when somebody asks."""

    key: str
    element: Element
    output: OutputElement


def plain_parts(root: OutputElement) -> list[PlainPart]:
    """Return each top-level element as a value that stands alone, prefixes declared.

    Raises:
        Refusal: All of them together are longer than OUTPUT_LIMIT.
    """
    prefixes, plain = _prefixes(root), _Plain()
    return [
        PlainPart(key, _declaring(plain.element(output), prefixes), output)
        for key, output in part_keys(root)
    ]


def plain_part(root: OutputElement, key: str, output: OutputElement) -> PlainPart:
    """Return one of them."""
    return PlainPart(key, _declaring(plain_element(output), _prefixes(root)), output)


def part_of(part: PlainPart) -> Part:
    """Return a part with where it was written and the macro calls that led to it."""
    return Part(part.key, part.element, part.output.origin.place, macro_calls(part.output.calls))


def _prefixes(root: OutputElement) -> dict[str, tuple[str, str]]:
    return {
        name[6:]: (name, value)
        for name, value in root.attributes.items()
        if name.startswith("xmlns:")
    }


def _declaring(element: Element, prefixes: Mapping[str, tuple[str, str]]) -> Element:
    """Return an element that declares the prefixes in it itself, as the root does."""
    if not prefixes:
        return element
    xml = element.xml
    declared = {
        name: value
        for prefix, (name, value) in prefixes.items()
        if f"{prefix}:" in xml and name not in element.attributes
    }
    return element._replace(attributes=element.attributes | declared) if declared else element


class OutputIndex:
    """The tree of one run, indexed from below. Attributes and texts may change meanwhile."""

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
        """Return the parts that each source element came out in; one that is in none is missing."""
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
