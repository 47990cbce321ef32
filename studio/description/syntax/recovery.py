"""Reads broken XML: the elements that were meant, and each fault with its fix.

Well-formed text is read as `parse_source` reads it. In other texts tags are taken one by one:
unclosed ones are closed where URDF cannot continue inside them, those that close nothing
are left out.
"""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import dataclass
from difflib import get_close_matches
from typing import TYPE_CHECKING, Final

from studio.description.syntax.broken_tags import LEAVES, LONE_AMPERSAND, TagReader
from studio.description.syntax.mends import TextMends
from studio.description.syntax.source_tree import (
    DEPTH_LIMIT,
    OUTSIDE_XML,
    XACRO_NAMESPACES,
    SourceComment,
    SourceElement,
    SourceError,
    SourceText,
    SourceTree,
    blank_tree,
    parse_source,
    unbound_sentence,
)
from studio.description.syntax.xml_faults import EnoughFaultsError, FaultBook, XmlFault

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.description.syntax.broken_tags import BrokenTag

_TAG_COUNTED: Final = re.compile(rb"<(/?)([\w:.-]+)(?:[^<>]*?(/?)>)?")
_SIBLINGS: Final = frozenset({"link", "joint"})
_WITHIN_PARTS: Final = frozenset({"collision", "geometry", "inertial", "material", "visual"})
_FRAGMENTS: Final = frozenset({"link", "joint", "material", "transmission", "gazebo"})
_NAMESPACE: Final = "http://www.ros.org/wiki/xacro"
RECOVERABLE: Final = frozenset({"xml-malformed", "xml-unbound-prefix", "xml-not-first"})
"""Codes of what a text can have and still be read; the others are refused as before."""
_END_TAG: Final = re.compile(rb"</\s*([^\s<>/]*)\s*[^<>]*(>?)")
_NAME_APART: Final = re.compile(rb"<[ \t]+(?=[A-Za-z_][\w:.-]*(?:\s+[\w:.-]+\s*=|\s*/?>))")
_ENTITY: Final = re.compile(r"&(?:#\d{1,7}|#x[0-9A-Fa-f]{1,6}|lt|gt|amp|quot|apos);")
_DASHES: Final = re.compile(rb"-{2,}")
_NAMES: Final = {"&lt;": "<", "&gt;": ">", "&amp;": "&", "&quot;": '"', "&apos;": "'"}


class OpenElements:
    """Puts elements where they belong; `content_end` is behind the last thing that is not blank."""

    def __init__(self, tree: SourceTree, mends: TextMends, book: FaultBook) -> None:
        self._tree, self._data = tree, tree.data
        self._mends, self._book = mends, book
        self._open: list[SourceElement] = []
        self._start_ends: dict[int, int] = {}
        """End of the start tag, by the ordinal of an element that was open."""
        self._faults_before: dict[int, int] = {}
        """Number of faults before it, by the ordinal of an element that was open."""
        self._unclosed = _unclosed_tags(tree.data)
        self._root_end: tuple[int, int] | None = None
        self._root_is_moved = False
        self._prefixes: dict[str, None] = dict.fromkeys(("xml", "xmlns"))
        self.content_end = 0

    @property
    def innermost(self) -> SourceElement | None:
        """The innermost open element."""
        return self._open[-1] if self._open else None

    def start(self, tag: BrokenTag, at: int, faults_before: int) -> None:
        """A start tag, whose < is at a place, and how many faults stand before it."""
        if not self._open and not self._begin_root(tag, at):
            return
        self._close_before(tag.name, at)
        element = self._element(tag.name, tag.attributes, at)
        self._check_prefixes(element, at)
        if not tag.closes_itself:
            self._open.append(element)
            self._start_ends[element.ordinal] = tag.end
            self._faults_before[element.ordinal] = faults_before
            return
        if self._data.endswith(b"/>", at, tag.end):
            element.end_tag = tag.end
        if not self._open:
            self._root_end = (at, tag.end)

    def _element(self, name: str, attributes: dict[str, str], at: int) -> SourceElement:
        tree, place = self._tree, self._book.pass_by(at)
        element = SourceElement(tree, self._open[-1] if self._open else None, name, place)
        element.offset, element.ordinal = at, len(tree.elements)
        element.attributes = attributes
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
        element = self._open.pop()
        if self._book.malformed == self._faults_before.get(element.ordinal):
            element.end_tag = at
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
                self._prefixes[prefix] = None  # reported once
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
    """Return names of which more begin than end."""
    counts: Counter[bytes] = Counter()
    for found in _TAG_COUNTED.finditer(data):
        if found[1]:
            counts[found[2]] -= 1
        elif not found[3]:
            counts[found[2]] += 1
    return {name.decode("utf-8", "replace") for name, count in counts.items() if count > 0}


@dataclass(frozen=True, slots=True)
class Recovered:
    """What can be read of a text; without faults it is well-formed."""

    tree: SourceTree
    faults: tuple[XmlFault, ...]


def recover(path: str, data: bytes) -> Recovered:
    """Read a text, broken or not; places and offsets are those of `data`.

    Raises:
        SourceError: It holds no element, or is refused for another reason than being broken: too
            large, binary, UTF-16, nested too deep, declares entities.
    """
    try:
        return Recovered(parse_source(path, data), ())
    except SourceError as error:
        if error.code not in RECOVERABLE or OUTSIDE_XML.search(data):
            raise
        return _Recovery(blank_tree(path, data)).read(error)


class _Recovery:
    """One reading of a broken text."""

    def __init__(self, tree: SourceTree) -> None:
        self._tree, self._data = tree, tree.data
        self._mends = TextMends(tree.path, tree.data, tree.encoding)
        self._book = FaultBook(tree.path, tree.data, tree.encoding)
        self._tags = TagReader(tree.data, tree.encoding, self._mends, self._book.add)
        self._elements = OpenElements(tree, self._mends, self._book)
        self._markup_by_opening: dict[bytes, Callable[[int], int]] = {
            b"<!--": self._comment,
            b"<![CDATA[": self._cdata,
            b"<!": self._doctype,
            b"<?": self._instruction,
            b"</": self._end,
        }

    def read(self, strict: SourceError) -> Recovered:
        """Read all of it.

        Raises:
            SourceError: `strict`, when there is no element; or it is nested too deep.
        """
        at = 3 if self._data.startswith(b"\xef\xbb\xbf") else 0
        try:
            while at < len(self._data):
                begin = self._data.find(b"<", at)
                begin = len(self._data) if begin < 0 else begin
                self._text(at, begin)
                at = self._markup(begin) if begin < len(self._data) else begin
            self._elements.finish()
        except EnoughFaultsError:
            pass
        if not self._tree.elements:
            raise strict
        faults = self._book.faults
        if not faults:  # broken in a way that is not handled here
            faults = (XmlFault(strict.code, strict.sentence, strict.place, None),)
        return Recovered(self._tree, faults)

    def _markup(self, at: int) -> int:
        """Read what a < begins; where it ends."""
        data = self._data
        for opening, read in self._markup_by_opening.items():
            if data.startswith(opening, at):
                end = read(at)
                self._elements.content_end = end
                return end
        faults_before = self._book.malformed
        tag = self._tags.read(self._name_of(at))
        if tag is None:
            fix = self._mends.fix("Write &lt;", self._mends.replaced(at, at + 1, "&lt;"))
            sentence = "A tag's name follows its < at once: a < that means itself is written &lt;."
            self._book.add("xml-less-than", sentence, at, fix)
            return at + 1
        self._elements.start(tag, at, faults_before)
        self._elements.content_end = at + len(self._data[at : tag.end].rstrip())
        return tag.end

    def _name_of(self, at: int) -> int:
        """Return the begin of a tag's name; blanks between it and the < are a fault."""
        apart = _NAME_APART.match(self._data, at)
        if apart is None:
            return at
        fix = self._mends.fix("Remove the blank", self._mends.replaced(at, apart.end(), "<"))
        sentence = "A tag's name follows its < at once: remove the blank."
        self._book.add("xml-tag-name", sentence, at, fix)
        return apart.end() - 1

    def _text(self, start: int, end: int) -> None:
        if start == end:
            return
        raw = self._data[start:end]
        parent = self._elements.innermost
        if parent is None:
            self._text_outside(start, end, raw)
            return
        text = raw.decode(self._tree.encoding, "replace")
        parent.children.append(SourceText(_ENTITY.sub(_referenced, text)))
        if raw.isspace():
            return
        self._elements.content_end = start + len(raw.rstrip())
        if LONE_AMPERSAND.search(raw):
            self._tags.check_ampersands(start, end)

    def _text_outside(self, start: int, end: int, raw: bytes) -> None:
        """Handle text before or behind the robot, such as the Markdown fence of a paste."""
        declares = self._data.startswith(b"<?xml", end) and not self._elements.content_end
        if raw.isspace() and not declares:
            return
        fix = self._mends.fix("Remove the text", self._mends.replaced(start, end, ""))
        if self._tree.elements:
            sentence = "The root element is closed above: remove the text that follows it."
            begin = start + len(raw) - len(raw.lstrip())
            self._book.add("xml-after-end", sentence, begin, fix)
            return
        sentence = "There is text or an empty line before the first tag: remove it."
        self._book.add("xml-not-first", sentence, start, fix)

    def _comment(self, at: int) -> int:
        close = self._data.find(b"-->", at + 4)
        if close < 0:
            sentence = "<!-- is never closed: write --> behind the comment."
            self._book.add("xml-open-comment", sentence, at, None)
            close = len(self._data)
        inner = self._data[at + 4 : close]
        if close < len(self._data) and (b"--" in inner or inner.endswith(b"-")):
            text = _DASHES.sub(b"-", inner).rstrip(b"-").decode(self._tree.encoding, "replace")
            mend = self._mends.replaced(at + 4, close, text or " ")
            fix = self._mends.fix("Write single dashes", mend)
            sentence = 'A comment cannot hold "--": take one of the dashes out.'
            self._book.add("xml-comment", sentence, at, fix)
        parent = self._elements.innermost
        if parent is not None:
            text = inner.decode(self._tree.encoding, "replace")
            node = SourceComment(text, self._book.place(at).line, at)
            parent.children.append(node)
            self._tree.comments.append(node)
        return min(close + 3, len(self._data))

    def _cdata(self, at: int) -> int:
        close = self._data.find(b"]]>", at)
        if close < 0:
            sentence = "<![CDATA[ is never closed: write ]]> behind it."
            self._book.add("xml-open-cdata", sentence, at, None)
            return len(self._data)
        parent = self._elements.innermost
        if parent is not None:
            text = self._data[at + 9 : close].decode(self._tree.encoding, "replace")
            parent.children.append(SourceText(text, literal=True))
        return close + 3

    def _instruction(self, at: int) -> int:
        close = self._data.find(b"?>", at)
        end = self._data.find(b">", at) if close < 0 else close
        if close < 0 or b"<" in self._data[at + 2 : close]:
            sentence = "<? is never closed: write ?> behind it."
            self._book.add("xml-instruction", sentence, at, None)
            return len(self._data) if end < 0 else min(end, close if close > 0 else end) + 2
        if self._data.startswith(b"<?xml", at) and self._elements.content_end > 0:
            fix = self._mends.fix("Remove <?xml ...?>", self._mends.replaced(at, close + 2, ""))
            sentence = "<?xml ...?> must be the very first thing of the file: remove this one."
            self._book.add("xml-instruction", sentence, at, fix)
        return close + 2

    def _doctype(self, at: int) -> int:
        found = re.compile(rb"<!DOCTYPE[^\[>]*(?:\[[^\]]*\][^>]*)?>", re.IGNORECASE)
        whole = found.match(self._data, at)
        if re.search(rb"<!ENTITY", whole[0] if whole else self._data[at:]):
            sentence = "The file declares an XML entity, which is not read: write its text out."
            raise SourceError("xml-entity", sentence, self._book.place(at))
        if whole is None:
            self._book.add("xml-instruction", "<! begins nothing that is known here.", at, None)
            return at + 2
        return whole.end()

    def _end(self, at: int) -> int:
        found = _END_TAG.match(self._data, at)
        if found is None:
            return at + 2
        end, name = found.end(), found[1].decode(self._tree.encoding, "replace")
        if not found[2]:
            end = at + len(found[0].rstrip())
            fix = self._mends.fix("Close the tag", self._mends.put_in(end, ">"))
            self._book.add("xml-open-tag", f"The tag </{name[:80]}> has no > yet.", at, fix)
        self._elements.end(name, at, end)
        return end


def _referenced(found: re.Match[str]) -> str:
    text = found[0]
    if not text.startswith("&#"):
        return _NAMES[text]
    code = int(text[3:-1], 16) if text.startswith("&#x") else int(text[2:-1])
    return chr(code) if code < 0x110000 else "\ufffd"
