"""Faults of a text that is no XML: places, and sentences for people who write it by hand."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, Protocol
from xml.parsers.expat import ErrorString, errors

from studio.problems import Place

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from xml.parsers.expat import ExpatError

    from studio.problems import Fix

_SENTENCES: Final = {
    errors.XML_ERROR_MISPLACED_XML_PI: (
        "<?xml ...?> must be the very first thing of the file: move it up or remove it."
    ),
    errors.XML_ERROR_JUNK_AFTER_DOC_ELEMENT: (
        "The root element is closed above: remove what follows it or move it inside."
    ),
    errors.XML_ERROR_DUPLICATE_ATTRIBUTE: "An attribute stands twice in this tag: remove one.",
    errors.XML_ERROR_UNCLOSED_TOKEN: (
        "What begins here goes on to the end of the file: is its > missing, or a quote?"
    ),
    errors.XML_ERROR_UNCLOSED_CDATA_SECTION: "<![CDATA[ is never closed: write ]]> behind it.",
    errors.XML_ERROR_UNDEFINED_ENTITY: (
        "This &name; is not known: write &amp; for an ampersand that means itself."
    ),
}
_SEARCHED_BYTES: Final = 400
"""Bytes before a fault that are searched for its cause."""
_UNQUOTED: Final = re.compile(rb"[\s\"']([\w:.-]+)\s*=\s*$")
_VALUELESS: Final = re.compile(rb"\s([\w:.-]+)\s*$")
_QUOTED: Final = re.compile(rb"\"[^\"]*\"|'[^']*'")
_IN_COMMENT: Final = re.compile(rb"<!--(?!.*-->)", re.DOTALL)
_IN_TAG: Final = re.compile(rb"<([\w:.-]+)([^<]*)$")
FAULTS_LIMIT: Final = 200
"""Limit for one text; behind that many nothing more is read."""


class Element(Protocol):
    """An element as it was begun."""

    tag: str
    place: Place


def sentence_of(error: ExpatError, data: bytes, byte: int, still_open: Sequence[Element]) -> str:
    """Return one sentence on what is wrong and what to do.

    Args:
        error: Raised by expat.
        data: The whole file.
        byte: Where expat stopped.
        still_open: The elements that are open there, the root first.
    """
    reason = ErrorString(error.code)
    if reason == errors.XML_ERROR_TAG_MISMATCH:
        return _mismatch(data, byte, still_open[-1])
    if reason == errors.XML_ERROR_NO_ELEMENTS:
        return _unfinished(still_open)
    if reason == errors.XML_ERROR_INVALID_TOKEN:
        return _odd_character(data, byte)
    return _SENTENCES.get(reason, f"The XML is not well-formed here: {reason}.")


def cause_of(error: ExpatError, data: bytes, byte: int) -> int:
    """Return where the fault begins: a tag without its > or a quote ends lines above the error.

    Args:
        error: Raised by expat.
        data: The whole file.
        byte: Where expat stopped.
    """
    if ErrorString(error.code) != errors.XML_ERROR_INVALID_TOKEN or data[byte : byte + 1] != b"<":
        return byte
    tag = _OpenTag.around(data[max(0, byte - _SEARCHED_BYTES) : byte])
    if tag is None or (tag.within_quotes and b"\n" not in data[byte - tag.length : byte]):
        return byte
    return byte - tag.length


def _mismatch(data: bytes, byte: int, innermost: Element) -> str:
    closing = re.match(rb"(?:</)?([^\s>]{1,80})", data[byte : byte + 82])
    name = closing[1].decode("utf-8", "replace") if closing else "…"
    still = f"<{innermost.tag}> of line {innermost.place.line} is still open."
    return f"</{name}> closes nothing here: {still}"


def _unfinished(still_open: Sequence[Element]) -> str:
    if not still_open:
        return "The file ends before its root element does: close every tag."
    innermost = still_open[-1]
    return (
        f"The file ends while <{innermost.tag}> of line {innermost.place.line} is open: close it."
    )


def _odd_character(data: bytes, byte: int) -> str:
    before, here = data[max(0, byte - _SEARCHED_BYTES) : byte], data[byte : byte + 12]
    for cause in _CAUSES:
        if sentence := cause(before, here):
            return sentence
    character = here.decode("utf-8", "ignore")[:1]
    shown = f'"{character}"' if character.isprintable() and character else "This character"
    return f"{shown} cannot stand here: is a quote, a > or a = missing before it?"


def _comment(before: bytes, _here: bytes) -> str:
    if before.endswith(b"--") and _IN_COMMENT.search(before):
        return 'A comment cannot hold "--": take one of the dashes out.'
    return ""


def _no_name(before: bytes, _here: bytes) -> str:
    if before.endswith((b"<", b"</")):
        return "A tag's name follows its < at once: a < that means itself is written &lt;."
    return ""


def _ampersand(before: bytes, here: bytes) -> str:
    if here.startswith(b"&") or before.endswith(b"&"):
        return "An ampersand that means itself is written &amp;."
    return ""


def _open_value(before: bytes, here: bytes) -> str:
    tag = _OpenTag.around(before)
    if tag and tag.within_quotes and here.startswith(b"<"):
        return "A value cannot hold <: is its closing quote missing? (A < itself is written &lt;.)"
    return ""


def _attribute(before: bytes, here: bytes) -> str:
    """Return what is wrong with an attribute or with how its value is quoted."""
    tag = _OpenTag.around(before)
    if not tag or tag.within_quotes:
        return ""
    if found := _UNQUOTED.search(before):
        return f'The value of {_name(found)} needs quotes: write {_name(found)}="...".'
    if found := _VALUELESS.search(tag.outside_quotes):
        return f'{_name(found)} has no value: write {_name(found)}="...".'
    if before.endswith((b'"', b"'")) and here[:1].isalpha():
        return "A space is missing between the value before this and the name here."
    return f"The tag <{tag.name}> has no > yet." if here.startswith(b"<") else ""


class _OpenTag:
    """A start tag whose > has not come yet."""

    def __init__(self, name: str, rest: bytes, length: int) -> None:
        self.name = name
        self.length = length
        self.outside_quotes = _QUOTED.sub(b'""', rest)
        self.within_quotes = bool(re.search(rb"[\"']", self.outside_quotes.replace(b'""', b"")))

    @classmethod
    def around(cls, before: bytes) -> _OpenTag | None:
        """Return the tag within which a text ends."""
        found = _IN_TAG.search(before)
        if found is None:
            return None
        tag = cls(_name(found), found[2], len(before) - found.start())
        return None if b">" in tag.outside_quotes and not tag.within_quotes else tag


def _name(found: re.Match[bytes]) -> str:
    return found[1].decode("utf-8", "replace")


_CAUSES: Final[tuple[Callable[[bytes, bytes], str], ...]] = (
    _comment,
    _no_name,
    _ampersand,
    _open_value,
    _attribute,
)


@dataclass(frozen=True, slots=True)
class XmlFault:
    """One fault of a text; `fix` mends it when that is safe."""

    code: str
    sentence: str
    place: Place
    fix: Fix | None


class EnoughFaultsError(Exception):
    """There are so many faults that the rest is not read."""


class FaultBook:
    """The faults of one text; it knows on which line and column a byte stands."""

    def __init__(self, path: str, data: bytes, encoding: str) -> None:
        self._path, self._data, self._encoding = path, data, encoding
        self._found: list[XmlFault] = []
        self._at, self._line, self._column = 0, 1, 1

    def add(self, code: str, sentence: str, at: int, fix: Fix | None) -> None:
        """Note a fault at a byte.

        Raises:
            EnoughFaultsError: There are too many.
        """
        self._found.append(XmlFault(code, sentence, self.place(at), fix))
        if len(self._found) >= FAULTS_LIMIT:
            raise EnoughFaultsError

    @property
    def malformed(self) -> int:
        """The number of faults so far that break the XML: an undeclared prefix does not."""
        return sum(one.code != "xml-unbound-prefix" for one in self._found)

    @property
    def faults(self) -> tuple[XmlFault, ...]:
        """All faults, in the order in which they were met: what closes first is mended first."""
        return tuple(self._found)

    def pass_by(self, at: int) -> Place:
        """Return the place of a byte behind all earlier ones; counting goes on there."""
        self._line, self._column = self._counted(self._at, self._line, self._column, at)
        self._at = at
        return Place(self._path, self._line, self._column)

    def place(self, at: int) -> Place:
        """Return the place of any byte."""
        if at >= self._at:
            return Place(self._path, *self._counted(self._at, self._line, self._column, at))
        return Place(self._path, *self._counted(0, 1, 1, at))

    def _counted(self, begin: int, line: int, column: int, at: int) -> tuple[int, int]:
        """Line and column of a byte, from those of an earlier one: what is between is counted."""
        breaks = self._data.count(b"\n", begin, at)
        if breaks:
            line, column = line + breaks, 1
            begin = self._data.rfind(b"\n", begin, at) + 1
        text = self._data[begin:at]
        if begin == 0:
            text = text.removeprefix(b"\xef\xbb\xbf")
        return line, column + len(text.decode(self._encoding, "replace"))
