"""Reads XML that is broken: the elements that were meant, and each fault with what mends it.

What is well-formed is read as `parse_source` reads it. Else tags are taken as they come: those that
nobody closes are closed where URDF cannot go on inside them, those that close nothing are left out.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from studio.description.syntax.broken_tags import LONE_AMPERSAND, TagReader
from studio.description.syntax.fault_book import EnoughFaultsError, FaultBook, XmlFault
from studio.description.syntax.open_elements import OpenElements
from studio.description.syntax.source_tree import (
    OUTSIDE_XML,
    SourceComment,
    SourceError,
    SourceText,
    SourceTree,
    blank_tree,
    parse_source,
)
from studio.description.syntax.text_mends import TextMends

if TYPE_CHECKING:
    from collections.abc import Callable


RECOVERABLE: Final = frozenset({"xml-malformed", "xml-unbound-prefix", "xml-not-first"})
"""Codes of what a text can have and still be read; the others are refused as before."""

_END_TAG: Final = re.compile(rb"</\s*([^\s<>/]*)\s*[^<>]*(>?)")
_NAME_APART: Final = re.compile(rb"<[ \t]+(?=[A-Za-z_][\w:.-]*(?:\s+[\w:.-]+\s*=|\s*/?>))")
_ENTITY: Final = re.compile(r"&(?:#\d{1,7}|#x[0-9A-Fa-f]{1,6}|lt|gt|amp|quot|apos);")
_DASHES: Final = re.compile(rb"-{2,}")
_NAMES: Final = {"&lt;": "<", "&gt;": ">", "&amp;": "&", "&quot;": '"', "&apos;": "'"}


@dataclass(frozen=True, slots=True)
class Recovered:
    """What a text holds as far as it can be read; without faults it is well-formed."""

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
        if not faults:  # it is broken in a way that nothing here looks for
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
        tag = self._tags.read(self._name_of(at))
        if tag is None:
            fix = self._mends.fix("Write &lt;", self._mends.replaced(at, at + 1, "&lt;"))
            sentence = "A tag's name follows its < at once: a < that means itself is written &lt;."
            self._book.add("xml-less-than", sentence, at, fix)
            return at + 1
        self._elements.start(tag, at)
        self._elements.content_end = at + len(self._data[at : tag.end].rstrip())
        return tag.end

    def _name_of(self, at: int) -> int:
        """Right before the name of a tag; blanks between it and the < are told."""
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
        """Text before or behind the robot: what a paste brought along, a fence of Markdown say."""
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
