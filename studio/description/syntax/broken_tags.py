"""Broken start tags: what their attributes were meant to be, and what is wrong."""

from __future__ import annotations

import re
from itertools import islice
from typing import TYPE_CHECKING, Final, NamedTuple

from studio.description.syntax.attribute_spans import attribute_text
from studio.errors import EditError

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.description.syntax.mends import TextMends
    from studio.problems import Fix

NAME: Final = re.compile(rb"[A-Za-z_\x80-\xff][\w.:\x80-\xff-]*")
LONE_AMPERSAND: Final = re.compile(rb"&(?!#\d{1,8};|#x[0-9A-Fa-f]{1,7};|(?:lt|gt|amp|quot|apos);)")
_LESS_THAN: Final = re.compile(rb"<")
_BLANKS: Final = re.compile(rb"\s*")
_ATTRIBUTE_NAME: Final = re.compile(rb"[^\s=/>\"'<&,;]+")
_BARE_VALUE: Final = re.compile(rb"[^\s\"'<>=]+")
_NEXT_ATTRIBUTE: Final = re.compile(rb"\s+[\w:.-]+\s*=\s*$")
_GOES_ON: Final = re.compile(rb"\s*(?:/?>|[\w:.-]+\s*=|$)")
_SLASH_APART: Final = re.compile(rb"/\s+>")
_STRAY_END: Final = re.compile(rb"</[\w:.-]*>(?=\s*(?:[\"'/>]|[\w:.-]+\s*=))")
_UNCLOSED_VALUE: Final = re.compile(rb"[^<>\r\n\"']*")
_VALUE_LIMIT: Final = 1 << 20
_ATTRIBUTES_LIMIT: Final = 4096
_SEARCHED: Final = 200
"""Bytes at the end of a value that are searched for the name of another attribute."""
_PLACES_LIMIT: Final = 1000
"""Limit of the places of one fault that a fix mends."""

LEAVES: Final = frozenset(
    {
        *("axis", "box", "calibration", "capsule", "child", "color", "cylinder"),
        *("dynamics", "inertia", "limit", "mass", "mesh", "mimic", "origin", "parent"),
        *("safety_controller", "sphere", "texture", "xacro:arg", "xacro:include"),
    }
)
"""Elements that hold no others."""


class BrokenTag(NamedTuple):
    """A start tag as far as it could be read; `end` is behind its `>` or where that should be."""

    name: str
    attributes: dict[str, str]
    end: int
    closes_itself: bool


class TagReader:
    """Reads start tags; calls `found` with what is wrong: code, sentence, place, fix."""

    def __init__(
        self,
        data: bytes,
        encoding: str,
        mends: TextMends,
        found: Callable[[str, str, int, Fix | None], None],
    ) -> None:
        self._data, self._encoding, self._mends, self._found = data, encoding, mends, found
        self._attributes: dict[str, str] = {}
        self._tag = ""
        self._begin = self._last_end = 0

    def read(self, at: int) -> BrokenTag | None:
        """Return the tag whose `<` is at a place; None when no name follows."""
        named = NAME.match(self._data, at + 1)
        if named is None:
            return None
        self._tag = named[0].decode(self._encoding, "replace")
        self._attributes, self._begin, self._last_end = {}, at, named.end()
        position: int | None = named.end()
        while True:
            here = _BLANKS.match(self._data, position)
            position = here.end() if here else position
            closed = self._ending(position)
            if closed is not None:
                return closed
            position = self._attribute(position)
            self._last_end = position

    def _ending(self, at: int) -> BrokenTag | None:
        """Return the whole tag when it ends here, as it should or because another one begins."""
        data = self._data
        if data.startswith((b"/>", b">"), at):
            is_empty = data.startswith(b"/", at)
            return BrokenTag(self._tag, self._attributes, at + 1 + is_empty, is_empty)
        apart = _SLASH_APART.match(data, at)
        if apart is not None:
            fix = self._mends.fix("Write />", self._mends.replaced(at, apart.end(), "/>"))
            self._found("xml-attribute", "Between / and > there can be no blank.", at, fix)
            return BrokenTag(self._tag, self._attributes, apart.end(), closes_itself=True)
        is_over = at >= len(data) or len(self._attributes) > _ATTRIBUTES_LIMIT
        if not is_over and (data[at : at + 1] != b"<" or _STRAY_END.match(data, at)):
            return None
        end = self._last_end
        slash = data.startswith(b"/", end - 1)
        is_empty = self._tag in LEAVES and not slash
        mend = self._mends.put_in(end, "/>" if is_empty else ">")
        sentence = f"The tag <{self._tag}> has no > yet."
        fix = self._mends.fix(f"Close the tag <{self._tag}>", mend)
        self._found("xml-open-tag", sentence, self._begin, fix)
        return BrokenTag(self._tag, self._attributes, at, is_empty or slash)

    def _attribute(self, at: int) -> int:
        """Read one attribute, or leave out what is none; where the next one may begin."""
        data = self._data
        stray = _STRAY_END.match(data, at)
        if stray is not None:
            return self._leave_out(at, stray.end())
        named = _ATTRIBUTE_NAME.match(data, at)
        if named is None:
            if data[at : at + 1] == b"/" and data[at + 1 : at + 2] in {b"<", b""}:
                return at + 1  # its > is reported as missing
            return self._leave_out(at, at + 1)
        name = named[0].decode(self._encoding, "replace")
        if at == self._last_end:
            fix = self._mends.fix(
                "Put a space between", self._mends.replaced(at, named.end(), f" {name}")
            )
            sentence = "A space is missing between the value before this and the name here."
            self._found("xml-attribute", sentence, at, fix)
        if NAME.fullmatch(named[0]) is None:
            self._found("xml-attribute", f"{name[:60]} is no name of an attribute.", at, None)
            return named.end()
        return self._value(name, at, named.end())

    def _leave_out(self, start: int, end: int) -> int:
        text = self._mends.text(start, end)
        fix = self._mends.fix(f"Remove {text}", self._mends.replaced(start, end, ""))
        self._found("xml-attribute", f"{text} cannot stand in the tag <{self._tag}>.", start, fix)
        return end

    def _value(self, name: str, begin: int, at: int) -> int:
        """Read the value of an attribute; where it ends."""
        data, mends = self._data, self._mends
        at = _end_of_blanks(data, at)
        if data[at : at + 1] in {b'"', b"'"}:
            fix = mends.fix("Put the = in", mends.put_in(at, "="))
            self._found("xml-attribute", f"The = behind {name} is missing.", at, fix)
            return self._quoted(name, begin, at)
        if data[at : at + 1] != b"=":
            return self._no_value(name, begin, begin + len(name.encode(self._encoding)))
        behind = _end_of_blanks(data, at + 1)
        stray = _STRAY_END.match(data, behind)
        if stray is not None:
            behind = _end_of_blanks(data, self._leave_out(behind, stray.end()))
        if data[behind : behind + 1] in {b'"', b"'"}:
            return self._quoted(name, begin, behind)
        return self._bare(name, begin, at, behind)

    def _bare(self, name: str, begin: int, equals: int, at: int) -> int:
        bare = _BARE_VALUE.match(self._data, at)
        text = bare[0] if bare else b""
        if text.endswith(b"/") and self._data[at + len(text) : at + len(text) + 1] == b">":
            text = text[:-1]
        end = at + len(text)
        is_next_name = _end_of_blanks(self._data, end)
        if not text or self._data[is_next_name : is_next_name + 1] == b"=":
            return self._no_value(name, begin, equals + 1)
        value = text.decode(self._encoding, "replace")
        fix = self._mends.fix("Put it in quotes", self._mends.replaced(at, end, f'"{value}"'))
        sentence = f'The value of {name} needs quotes: write {name}="...".'
        self._found("xml-attribute", sentence, at, fix)
        self._take(name, begin, end, value)
        return end

    def _no_value(self, name: str, begin: int, end: int) -> int:
        start = begin - 1 if self._data[begin - 1 : begin].isspace() else begin
        fix = self._mends.fix(f"Remove {name}", self._mends.replaced(start, end, ""))
        sentence = f'{name} has no value: write {name}="...".'
        self._found("xml-attribute", sentence, begin, fix)
        return end

    def _quoted(self, name: str, begin: int, at: int) -> int:
        """Return a value whose opening quote is at a place."""
        data, quote = self._data, self._data[at : at + 1]
        close = data.find(quote, at + 1, at + _VALUE_LIMIT)
        raw = data[at + 1 : close]
        if close < 0 or not self._closes_there(raw, close):
            return self._unclosed(name, begin, at)
        if b"<" in raw:
            what = "A value cannot hold <: write &lt; for it."
            self._escape(_LESS_THAN, (at + 1, close), "xml-less-than", what, "&lt;")
        self.check_ampersands(at + 1, close)
        self._take(name, begin, close + 1, self._text(raw))
        return close + 1

    def _closes_there(self, raw: bytes, close: int) -> bool:
        """Whether the next quote is the closing one, or opens the value of another attribute."""
        goes_on = _GOES_ON.match(self._data, close + 1) is not None
        if b"<" in raw:
            return goes_on and b"\n" not in raw and not _NEXT_ATTRIBUTE.search(raw[-_SEARCHED:])
        return goes_on or not _NEXT_ATTRIBUTE.search(raw[-_SEARCHED:])

    def _unclosed(self, name: str, begin: int, at: int) -> int:
        """Without its closing quote a value goes as far as its line or the next attribute."""
        data, quote = self._data, self._data[at : at + 1].decode()
        found = _UNCLOSED_VALUE.match(data, at + 1)
        raw = found[0] if found else b""
        following = _NEXT_ATTRIBUTE.search(raw, max(0, len(raw) - _SEARCHED))
        if following is not None:
            raw = raw[: following.start()]
        raw = raw.rstrip()
        if raw.endswith(b"/") and data[at + 1 + len(raw) : at + 2 + len(raw)] == b">":
            raw = raw[:-1].rstrip()
        end = at + 1 + len(raw)
        fix = self._mends.fix(f"Close the value of {name}", self._mends.put_in(end, quote))
        sentence = f"The value of {name} has no closing quote: write {quote} behind it."
        self._found("xml-open-quote", sentence, at, fix)
        self._take(name, begin, end, self._text(raw))
        return end

    def check_ampersands(self, start: int, end: int) -> None:
        """Report each literal & between two places."""
        what = "An ampersand that means itself is written &amp;."
        self._escape(LONE_AMPERSAND, (start, end), "xml-ampersand", what, "&amp;")

    def _escape(
        self, sought: re.Pattern[bytes], span: tuple[int, int], code: str, what: str, instead: str
    ) -> None:
        found = islice(sought.finditer(self._data, *span), _PLACES_LIMIT)
        places = [one.start() for one in found]
        if not places:
            return
        edits = [self._mends.replaced(one, one + 1, instead) for one in places]
        fix = self._mends.fix(f"Write {instead}", *edits)
        self._found(code, what, places[0], fix)

    def _take(self, name: str, begin: int, end: int, value: str) -> None:
        if name not in self._attributes:
            self._attributes[name] = value
            return
        start = begin - 1 if self._data[begin - 1 : begin].isspace() else begin
        fix = self._mends.fix(f"Remove the second {name}", self._mends.replaced(start, end, ""))
        sentence = f"{name} stands twice in the tag <{self._tag}>: remove one."
        self._found("xml-attribute-twice", sentence, begin, fix)

    def _text(self, raw: bytes) -> str:
        try:
            return attribute_text(raw, self._encoding)
        except EditError:
            return raw.decode(self._encoding, "replace")


def _end_of_blanks(data: bytes, at: int) -> int:
    found = _BLANKS.match(data, at)
    return found.end() if found else at
