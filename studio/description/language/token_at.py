"""The token at a cursor in the text of an XML file, however broken the rest of it is.

Indices are characters of the text. An attribute's value never holds `<`, so the last `<` before the
cursor is where its tag begins: a missing quote or `>` further up does little harm. Nothing here
takes longer than one pass over the text before the cursor.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Iterator

WALK_LIMIT: Final = 400_000
"""Characters before the cursor that are searched for the tags open there."""
_TAG_LIMIT: Final = 20_000
"""Characters of one tag; longer ones are not read."""
_NAME: Final = re.compile(r"[^\s<>/=\"']*")
_ATTRIBUTE: Final = re.compile(r"\s*([^\s=<>\"'/]+)(\s*=\s*)?")
_TAG: Final = re.compile(
    r"<(/?)([^\s<>/=\"'!?][^\s<>/=\"']*)((?:[^<>\"']|\"[^\"<]*\"|'[^'<]*')*?)(/?)>"
)
_SILENT: Final = (("<!--", "-->"), ("<![CDATA[", "]]>"), ("<?", "?>"))
_STRAY: Final = re.compile(r"(?:[\s\"'=]|/(?!>))*")
_DECLARATION: Final = re.compile(r"<xacro:(?:property|arg|macro)(?=[\s/>])")
_OPENING: Final = re.compile(r"\$\$+[{(]|\$([{(])")


class Where(StrEnum):
    """The part of the markup that a cursor is in."""

    SILENT = "silent"
    """In a comment, a CDATA section or a processing instruction."""
    CONTENT = "content"
    """Between tags."""
    TAG_NAME = "tag_name"
    CLOSING = "closing"
    """In the name of a closing tag."""
    ATTRIBUTE_NAME = "attribute_name"
    VALUE = "value"


@dataclass(frozen=True, slots=True)
class Attribute:
    """An attribute as written: `start` and `end` are those of its value, without the quotes.

    Without a value yet, both are -1.
    """

    name: str
    name_start: int
    start: int = -1
    end: int = -1

    def holds(self, index: int) -> bool:
        """Whether a cursor is in the value, its ends included."""
        return self.start >= 0 and self.start <= index <= self.end


@dataclass(frozen=True, slots=True)
class Tag:
    """A start tag, or the beginning of one; `start` is its `<`, `end` is behind what was read."""

    name: str
    start: int
    end: int
    attributes: tuple[Attribute, ...] = ()

    @property
    def name_end(self) -> int:
        """Behind its name."""
        return self.start + 1 + len(self.name)


@dataclass(frozen=True, slots=True)
class Token:
    """What a cursor is in. [start, end) is the text under it: a name, or a whole value."""

    where: Where
    start: int
    end: int
    tag: Tag | None = None
    attribute: Attribute | None = None


@dataclass(frozen=True, slots=True)
class Segment:
    """One `${...}` or `$(...)`; `start` and `end` are those of its inside, perhaps unclosed."""

    is_expression: bool
    start: int
    end: int
    is_closed: bool = True

    def holds(self, index: int) -> bool:
        """Whether a cursor is inside, its ends included."""
        return self.start <= index <= self.end


def token_at(text: str, index: int) -> Token:
    """Return what the cursor before the character `index` is in."""
    index = max(0, min(index, len(text)))
    if _is_silent(text, index):
        return Token(Where.SILENT, index, index)
    start = text.rfind("<", max(0, index - _TAG_LIMIT), index)
    if start < 0:
        return _content(text, index)
    if text.startswith(("<!", "<?"), start):
        return _content(text, index)
    if text.startswith("/", start + 1):
        return _closing(text, start, index)
    return _in_tag(text, start, index)


def _is_silent(text: str, index: int) -> bool:
    """Whether a comment or its like begins before the cursor and ends behind it."""
    for opening, closing in _SILENT:
        start = text.rfind(opening, 0, index)
        if start < 0:
            continue
        end = text.find(closing, start + len(opening))
        if index >= start + len(opening) and (end < 0 or index < end + len(closing)):
            return True
    return False


def _content(text: str, index: int) -> Token:
    start = max(text.rfind(">", 0, index), text.rfind("<", 0, index)) + 1
    end = text.find("<", index)
    return Token(Where.CONTENT, start, len(text) if end < 0 else end)


def _closing(text: str, start: int, index: int) -> Token:
    name = _NAME.match(text, start + 2)
    end = name.end() if name else start + 2
    return Token(Where.CLOSING, start + 2, end) if index <= end else _content(text, index)


def _in_tag(text: str, start: int, index: int) -> Token:
    tag = read_tag(text, start)
    if index <= tag.name_end:
        return Token(Where.TAG_NAME, start + 1, tag.name_end, tag)
    if index > tag.end or (index == tag.end and text[tag.end - 1] == ">"):
        return _content(text, index)
    for attribute in tag.attributes:
        if attribute.holds(index):
            return Token(Where.VALUE, attribute.start, attribute.end, tag, attribute)
        name_end = attribute.name_start + len(attribute.name)
        if attribute.name_start <= index <= name_end:
            return Token(Where.ATTRIBUTE_NAME, attribute.name_start, name_end, tag, attribute)
    return Token(Where.ATTRIBUTE_NAME, index, index, tag)


def read_tag(text: str, start: int) -> Tag:
    """Read the start tag whose `<` is at `start`, as far as it can be read."""
    found = _NAME.match(text, start + 1)
    name = found[0] if found else ""
    position = start + 1 + len(name)
    stop = min(_next(text, "<", position), start + _TAG_LIMIT)
    attributes: list[Attribute] = []
    while position < stop and (found := _ATTRIBUTE.match(text, position, stop)):
        attribute, position = _read_value(text, found, stop)
        attributes.append(attribute)
        position = _past_stray_signs(text, position, stop)
    closing = text.find(">", position, stop)
    return Tag(name, start, stop if closing < 0 else closing + 1, tuple(attributes))


def _read_value(text: str, found: re.Match[str], stop: int) -> tuple[Attribute, int]:
    """Return the attribute that begins with this match, and where to go on."""
    name, at = found[1], found.start(1)
    quote = text[found.end() : found.end() + 1] if found[2] else ""
    if found.end() >= stop or quote not in {'"', "'"}:
        return Attribute(name, at), found.end()
    start = found.end() + 1
    end = text.find(quote, start, stop)
    if end < 0:  # never closed: it reaches to the end of its line
        end = min(_next(text, "\n", start), stop)
        return Attribute(name, at, start, end), end
    return Attribute(name, at, start, end), end + 1


def _past_stray_signs(text: str, position: int, stop: int) -> int:
    """Skip what is no attribute, but not the end of the tag."""
    found = _STRAY.match(text, position, stop)
    return found.end() if found else position


def _next(text: str, wanted: str, position: int) -> int:
    found = text.find(wanted, position)
    return len(text) if found < 0 else found


def open_tags(text: str, index: int) -> tuple[Tag, ...]:
    """Return the start tags that are open where the cursor is, the outermost first.

    A closing tag closes the nearest open one of its name; what lies between is taken as closed.
    """
    opened: list[Tag] = []
    for tag, is_closing, is_empty in tags_before(text, index):
        if not is_closing:
            if not is_empty:
                opened.append(tag)
            continue
        names = [one.name for one in opened]
        if tag.name in names:
            del opened[len(names) - 1 - names[::-1].index(tag.name) :]
    return tuple(opened)


def declarations_in(text: str) -> Iterator[Tag]:
    """Yield the properties, args and macros of a text, with their attributes."""
    position = 0
    while found := _DECLARATION.search(text, position, WALK_LIMIT):
        tag = read_tag(text, found.start())
        position = max(tag.end, found.end())
        yield tag


def tags_before(text: str, index: int) -> Iterator[tuple[Tag, bool, bool]]:
    """Yield each whole tag before the cursor: (tag, it closes, it is empty)."""
    position = max(0, index - WALK_LIMIT)
    while (position := text.find("<", position, index)) >= 0:
        silent = next((one for one in _SILENT if text.startswith(one[0], position)), None)
        if silent:
            end = text.find(silent[1], position + len(silent[0]), index)
            if end < 0:
                return
            position = end + len(silent[1])
            continue
        found = _TAG.match(text, position, min(index, position + _TAG_LIMIT))
        if found is None:
            position += 1
            continue
        yield (
            read_tag(text, position) if not found[1] else Tag(found[2], position, found.end()),
            bool(found[1]),
            bool(found[4]),
        )
        position = found.end()


def segments_in(text: str, start: int, end: int) -> Iterator[Segment]:
    """Yield the `${...}` and `$(...)` of a value, cut as by xacro; also unclosed ones."""
    position = start
    while found := _OPENING.search(text, position, end):
        position = found.end()
        if found[1] is None:  # `$${` stands for `${`
            continue
        closing = text.find("}" if found[1] == "{" else ")", position, end)
        inside_end = end if closing < 0 else closing
        yield Segment(found[1] == "{", position, inside_end, is_closed=closing >= 0)
        position = inside_end


def segment_at(text: str, token: Token, index: int) -> Segment | None:
    """Return the innermost segment that a cursor is in, of a value or a text between tags."""
    inside: Segment | None = None
    start, end = token.start, token.end
    while found := next((s for s in segments_in(text, start, end) if s.holds(index)), None):
        inside, start, end = found, found.start, found.end
    return inside
