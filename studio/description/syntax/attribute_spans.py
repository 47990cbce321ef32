"""Spans of the attributes of an XML start tag in the bytes, and how their text is written.

Bytes are ASCII compatible here (UTF-8, Latin-1 ...): the source tree refuses the others. The tag is
well-formed: expat has read it, and knows where its `<` is.
"""

from __future__ import annotations

import codecs
import re
from functools import lru_cache

from studio.description.values import Span
from studio.errors import EditError

_TAG_NAME = re.compile(rb"""<[^\s/>=<"']+""")
_ATTRIBUTE = re.compile(rb"""\s+([^\s=/>"'<]+)\s*=\s*(?:"([^"]*)"|'([^']*)')""")
_DECLARATION = re.compile(
    rb"""(?:\xef\xbb\xbf)?<\?xml[^>]*?\sencoding\s*=\s*["']([A-Za-z][\w.-]*)["']"""
)
_PIECE = re.compile(r"&(?:#(?:x[0-9A-Fa-f]+|[0-9]+)|[a-z]+);|\r\n|.", re.DOTALL)
_NOT_PLAIN = re.compile(rb"[&\t\r\n]|[^\x00-\x7f]")
_NOT_XML = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
_ENTITIES = {"&lt;": "<", "&gt;": ">", "&amp;": "&", "&quot;": '"', "&apos;": "'"}
_ESCAPES = {"&": "&amp;", "<": "&lt;", "\t": "&#9;", "\n": "&#10;", "\r": "&#13;"}
_QUOTES = {'"': "&quot;", "'": "&apos;"}


# Asked for every site of a file, of which there may be tens of thousands: each time the same bytes.
@lru_cache(maxsize=4)
def text_encoding(data: bytes) -> str:
    """Return the encoding to read with: UTF-8 if the bytes are, as xacro does; else as declared."""
    try:
        data.decode("utf-8")
    except UnicodeDecodeError:
        return _declared_encoding(data)
    return "utf-8"


def writing_encoding(data: bytes) -> str:
    """Return the encoding of new text: ASCII, with references, in files not declared as UTF-8."""
    return "utf-8" if _declared_encoding(data) == text_encoding(data) == "utf-8" else "ascii"


def _declared_encoding(data: bytes) -> str:
    declared = _DECLARATION.match(data)
    if declared is None:
        return "utf-8"
    try:
        return codecs.lookup(declared[1].decode("ascii")).name
    except LookupError:
        return "utf-8"  # expat would have refused the file


def attribute_spans(data: bytes, offset: int) -> dict[str, Span]:
    """Return the value span of each attribute, by its name, of the tag whose `<` is at `offset`.

    Raises:
        EditError: No start tag is there.
    """
    tag = _TAG_NAME.match(data, offset)
    if tag is None:
        raise EditError(f"No element starts at byte {offset}: reload the file.")
    spans: dict[str, Span] = {}
    found = _ATTRIBUTE.match(data, tag.end())
    while found is not None:
        group = 2 if found[2] is not None else 3
        name = found[1].decode("utf-8", "replace")
        spans[name] = Span(found.start(group), found.end(group), '"' if group == 2 else "'")
        found = _ATTRIBUTE.match(data, found.end())
    return spans


def attribute_text(raw: bytes, encoding: str = "utf-8") -> str:
    """Return the text of a value's raw bytes: references resolved, blanks to spaces.

    Raises:
        EditError: The bytes are not of that encoding.
    """
    if _NOT_PLAIN.search(raw) is None:
        return raw.decode("ascii")
    return "".join(character for character, _ in _pieces(raw, encoding))


def character_offsets(raw: bytes, encoding: str = "utf-8") -> tuple[str, list[int]]:
    """Return a value's text, and where each character starts in `raw`; one more for the end.

    Raises:
        EditError: The bytes are not of that encoding.
    """
    characters: list[str] = []
    offsets = [0]
    for character, size in _pieces(raw, encoding):
        characters.append(character)
        offsets.append(offsets[-1] + size)
    return "".join(characters), offsets


def _pieces(raw: bytes, encoding: str) -> list[tuple[str, int]]:
    """Return each character of a value with the number of raw bytes that spell it."""
    try:
        written = raw.decode(encoding)
    except UnicodeDecodeError as error:
        raise EditError(f"A value is not {encoding} text, as its file says it is.") from error
    return [
        (_character(piece), len(piece.encode(encoding)))
        for piece in (found[0] for found in _PIECE.finditer(written))
    ]


def _character(piece: str) -> str:
    if piece in {"\t", "\n", "\r", "\r\n"}:
        return " "
    if piece.startswith("&#"):
        return _referenced(piece[2:-1])
    return _ENTITIES.get(piece, piece)


def _referenced(number: str) -> str:
    code = int(number[1:], 16) if number.startswith("x") else int(number)
    return chr(code) if code < 0x110000 else "\ufffd"


def attribute_bytes(text: str, quote: str, encoding: str = "utf-8") -> bytes:
    """Spell `text` for a value in these quotes; what the encoding lacks as character references.

    Raises:
        EditError: The text holds a character that XML cannot hold.
    """
    forbidden = _NOT_XML.search(text)
    if forbidden is not None:
        raise EditError(f"The character {forbidden[0]!r} cannot stand in XML: leave it out.")
    return _escaped(text, quote).encode(encoding, "xmlcharrefreplace")


def quoted(text: str) -> str:
    """`text` as the value of an attribute, in double quotes."""
    quote = '"'
    return f"{quote}{_escaped(text, quote)}{quote}"


def _escaped(text: str, quote: str) -> str:
    escapes = {**_ESCAPES, quote: _QUOTES[quote]}
    return "".join(escapes.get(character, character) for character in text)
