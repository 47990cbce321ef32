"""The elements that are open while a broken text is read, and what becomes of odd tags."""

from __future__ import annotations

import re
from collections import Counter
from difflib import get_close_matches
from typing import TYPE_CHECKING, Final

from studio.description.syntax.broken_tags import LEAVES
from studio.description.syntax.source_tree import (
    DEPTH_LIMIT,
    XACRO_NAMESPACES,
    SourceElement,
    SourceError,
    SourceTree,
    unbound_sentence,
)

if TYPE_CHECKING:
    from studio.description.syntax.broken_tags import BrokenTag
    from studio.description.syntax.fault_book import FaultBook
    from studio.description.syntax.text_mends import TextMends

_TAG_COUNTED: Final = re.compile(rb"<(/?)([\w:.-]+)(?:[^<>]*?(/?)>)?")
_SIBLINGS: Final = frozenset({"link", "joint"})
_WITHIN_PARTS: Final = frozenset({"collision", "geometry", "inertial", "material", "visual"})
_FRAGMENTS: Final = frozenset({"link", "joint", "material", "transmission", "gazebo"})
_NAMESPACE: Final = "http://www.ros.org/wiki/xacro"


class OpenElements:
    """Puts elements where they belong; `content_end` is behind the last thing that is not blank."""

    def __init__(self, tree: SourceTree, mends: TextMends, book: FaultBook) -> None:
        self._tree, self._data = tree, tree.data
        self._mends, self._book = mends, book
        self._open: list[SourceElement] = []
        self._start_ends: dict[int, int] = {}
        """By the ordinal of an element that was open, where its start tag ends."""
        self._unclosed = _unclosed_tags(tree.data)
        self._root_end: tuple[int, int] | None = None
        self._root_is_moved = False
        self._prefixes: dict[str, None] = dict.fromkeys(("xml", "xmlns"))
        self.content_end = 0

    @property
    def innermost(self) -> SourceElement | None:
        """What is open now."""
        return self._open[-1] if self._open else None

    def start(self, tag: BrokenTag, at: int) -> None:
        """A start tag, whose < is at a place."""
        if not self._open and not self._begin_root(tag, at):
            return
        self._close_before(tag.name, at)
        element = self._element(tag.name, tag.attributes, at)
        self._check_prefixes(element, at)
        if not tag.closes_itself:
            self._open.append(element)
            self._start_ends[element.ordinal] = tag.end
        elif len(self._open) == 0:
            self._root_end = (at, tag.end)

    def _element(self, name: str, attributes: dict[str, str], at: int) -> SourceElement:
        tree = self._tree
        element = SourceElement(tree, self._open[-1] if self._open else None, name)
        place = self._book.pass_by(at)
        element.line, element.column, element.offset = place.line, place.column, at
        element.ordinal, element.attributes = len(tree.elements), attributes
        if len(self._open) >= DEPTH_LIMIT:
            sentence = f"Elements are nested deeper than {DEPTH_LIMIT}."
            raise SourceError("xml-too-deep", sentence, place)
        if self._open:
            self._open[-1].children.append(element)
        else:
            tree.root = element
        tree.elements.append(element)
        return element

    def _begin_root(self, tag: BrokenTag, at: int) -> bool:
        """Make sure that the first element is a root, and the only one; whether to go on."""
        if not self._tree.elements:
            if tag.name in _FRAGMENTS or tag.name.startswith("xacro:"):
                self._wrap(at)
            return True
        if self._root_end is None:
            return True
        start, end = self._root_end
        self._root_end = None
        self._open.append(self._tree.root)
        self._start_ends.setdefault(self._tree.root.ordinal, end)
        fix = None
        if self._data.startswith(b"</", start):
            edits = [self._mends.replaced(start, end, "")]
            text = self._mends.text(start, end)
            if self._data.rfind(text.encode(self._tree.encoding)) <= start:
                edits.append(self._mends.put_in(len(self._data.rstrip()), f"\n{text}\n"))
            fix = self._mends.fix(f"Move {text} to the end", *edits)
            self._root_is_moved = len(edits) == 2
        sentence = "The root element is closed above: remove what follows it or move it inside."
        self._book.add("xml-after-end", sentence, at, fix)
        return True

    def _wrap(self, at: int) -> None:
        """Read a piece of a robot as the robot that it is meant for."""
        root = self._element("robot", {"name": "robot"}, at)
        self._open.append(root)
        self._start_ends[root.ordinal] = at
        self._unclosed.add("robot")
        begin = '<robot name="robot">\n'
        uses_xacro = re.search(rb"<xacro:", self._data)
        if uses_xacro:
            begin = f'<robot name="robot" xmlns:xacro="{_NAMESPACE}">\n'
            self._prefixes["xacro"] = None
        name = re.match(rb"<[^\s>/<]+", self._data[at:])
        first = name[0].decode(self._tree.encoding, "replace") if name else "<"
        edit = self._mends.replaced(at, at + len(name[0] if name else b"<"), begin + first)
        sentence = "There is no <robot> around these elements: write one."
        self._book.add("xml-no-root", sentence, at, self._mends.fix("Put <robot> around", edit))

    def _close_before(self, name: str, at: int) -> None:
        """Close what cannot hold the element that begins."""
        while self._open and self._open[-1].tag in LEAVES & self._unclosed:
            self._close_unclosed(at)
        if name not in _SIBLINGS:
            return
        for above, element in enumerate(reversed(self._open)):
            if element.tag in _SIBLINGS & self._unclosed:
                for _ in range(above + 1):
                    self._close_unclosed(at)
                return
            if element.tag not in _WITHIN_PARTS:
                return

    def _close_unclosed(self, at: int) -> None:
        """Close the innermost element, which lacks its end tag before a place."""
        element = self._open.pop()
        place = f"<{element.tag}> of line {element.line}"
        if element.tag in LEAVES:
            end = self._start_ends[element.ordinal]
            edit = self._mends.replaced(end - 1, end, "/>")
            fix = self._mends.fix(f"Close <{element.tag}>", edit)
            self._book.add("xml-open-element", f"{place} is never closed.", element.offset, fix)
            return
        behind = self.content_end
        indent = self._mends.indent_at(element.offset)
        separate = self._mends.begins_line(element.offset)
        line_break = self._mends.line_break + indent if separate else ""
        edit = self._mends.put_in(behind, f"{line_break}</{element.tag}>")
        fix = self._mends.fix(f"Write </{element.tag}>", edit)
        if at >= len(self._data):
            sentence = f"The file ends while {place} is open: close it."
            self._book.add("xml-open-element", sentence, max(behind - 1, 0), fix)
        else:
            self._book.add("xml-open-element", f"{place} is never closed.", element.offset, fix)

    def end(self, name: str, at: int, end: int) -> None:
        """An end tag from byte `at` to `end`."""
        tags = [element.tag for element in self._open]
        if name in tags:
            while self._open[-1].tag != name:
                self._close_unclosed(at)
            self._pop(at, end)
        elif tags and get_close_matches(name, tags[-1:], cutoff=0.6):
            self._rename_end(name, at)
            self._pop(at, end)
        else:
            self._stray(name, at, end)

    def _pop(self, at: int, end: int) -> None:
        self._open.pop()
        if not self._open:
            self._root_end = (at, end)

    def _rename_end(self, name: str, at: int) -> None:
        tag = self._open[-1].tag
        start = self._data.index(name.encode(self._tree.encoding, "replace"), at)
        size = len(name.encode(self._tree.encoding, "replace"))
        edit = self._mends.replaced(start, start + size, tag)
        sentence = f"</{name[:80]}> is to close <{tag}> of line {self._open[-1].line}."
        self._book.add("xml-end-tag", sentence, at, self._mends.fix(f"Write </{tag}>", edit))

    def _stray(self, name: str, at: int, end: int) -> None:
        fix = self._mends.fix(f"Remove </{name[:80]}>", self._mends.replaced(at, end, ""))
        still = ""
        if self._open:
            still = f": <{self._open[-1].tag}> of line {self._open[-1].line} is still open"
        self._book.add("xml-end-tag", f"</{name[:80]}> closes nothing here{still}.", at, fix)

    def finish(self) -> None:
        """Close what is open at the end of the text."""
        while self._open and not (self._root_is_moved and len(self._open) == 1):
            self._close_unclosed(len(self._data))

    def _check_prefixes(self, element: SourceElement, at: int) -> None:
        for name, value in element.attributes.items():
            if name.startswith("xmlns:"):
                self._prefixes[name[6:]] = None
                self._tree.uses_xacro |= value in XACRO_NAMESPACES
        for name in (element.tag, *element.attributes):
            prefix, colon, _ = name.partition(":")
            if colon and prefix not in self._prefixes and not self._misspelt(element, prefix, at):
                self._prefixes[prefix] = None  # told once
                self._unbound(prefix, at)

    def _misspelt(self, element: SourceElement, prefix: str, at: int) -> bool:
        """Whether a tag is nearly one of xacro's; it is then read as such."""
        if "xacro" not in self._prefixes or not element.tag.startswith(f"{prefix}:"):
            return False
        if not get_close_matches(prefix, ["xacro"]):
            return False
        element.tag = f"xacro:{element.tag.removeprefix(f'{prefix}:')}"
        size = len(prefix.encode(self._tree.encoding, "replace"))
        edit = self._mends.replaced(at + 1, at + 1 + size, "xacro")
        sentence = f'The prefix "{prefix}:" is not declared: did you mean "xacro:"?'
        fix = self._mends.fix("Write xacro:", edit)
        self._book.add("xml-unbound-prefix", sentence, at, fix)
        return True

    def _unbound(self, prefix: str, at: int) -> None:
        root, fix = self._tree.root, None
        if prefix == "xacro":
            end = root.offset + 1 + len(root.tag.encode(self._tree.encoding, "replace"))
            edit = self._mends.put_in(end, f' xmlns:xacro="{_NAMESPACE}"')
            fix = self._mends.fix("Declare xacro", edit)
        self._book.add("xml-unbound-prefix", unbound_sentence(prefix), at, fix)


def _unclosed_tags(data: bytes) -> set[str]:
    """Names of which more begin than end."""
    counts: Counter[bytes] = Counter()
    for found in _TAG_COUNTED.finditer(data):
        if found[1]:
            counts[found[2]] -= 1
        elif not found[3]:
            counts[found[2]] += 1
    return {name.decode("utf-8", "replace") for name, count in counts.items() if count > 0}
