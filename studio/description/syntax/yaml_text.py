r"""One YAML scalar on one line: its text from its bytes, and its bytes in the style it had.

Source: YAML 1.1 as PyYAML reads it. A scalar is plain (`1.5`), in single quotes (`'it''s'`) or in
double quotes (`"a\tb"`); tags and anchors before it are no part of it.
"""

from __future__ import annotations

import re

from studio.errors import EditError

_ESCAPE = re.compile(r"\\(?:x([0-9A-Fa-f]{2})|u([0-9A-Fa-f]{4})|U([0-9A-Fa-f]{8})|(.))")
_MEANING = {
    "0": "\0", "a": "\a", "b": "\b", "t": "\t", "n": "\n", "v": "\v", "f": "\f", "r": "\r",
    "e": "\x1b", "N": "\x85", "_": "\xa0", "L": "\u2028", "P": "\u2029",
}  # fmt: skip
_SPELLING = {character: f"\\{letter}" for letter, character in _MEANING.items()} | {
    '"': '\\"',
    "\\": "\\\\",
}
_PRINTABLE = re.compile(
    "[\x20-\x7e\xa0-\u2027\u202a-\ud7ff\ue000-\ufefe\uff00-\ufffd\U00010000-\U0010ffff]*"
)
_PLAIN = re.compile(r"(?:[^\s\-?:,\[\]{}#&*!|>'\"%@`]|-(?=\S))(?:.*\S)?")
_NOT_PLAIN = re.compile(r"[,\[\]{}]|:(?:\s|$)|\s#")


def yaml_text(raw: bytes) -> str:
    """The text of a scalar from its bytes.

    Raises:
        EditError: The bytes are not UTF-8.
    """
    try:
        written = raw.decode()
    except UnicodeDecodeError as error:
        raise EditError("A YAML value is not UTF-8 text.") from error
    if len(written) >= 2 and written[0] == written[-1] == "'":
        return written[1:-1].replace("''", "'")
    if len(written) >= 2 and written[0] == written[-1] == '"':
        return _ESCAPE.sub(_meant, written[1:-1])
    return written


def _meant(escape: re.Match[str]) -> str:
    code = escape[1] or escape[2] or escape[3]
    if not code:
        return _MEANING.get(escape[4], escape[4])
    number = int(code, 16)
    return chr(number) if number < 0x110000 else "\ufffd"


def yaml_bytes(text: str, like: bytes) -> bytes:
    """Spell `text` as a scalar in the style of `like`, quoted when it could not be read otherwise.

    A plain scalar stays plain when it can, so that the type follows the text as in an editor.

    Raises:
        EditError: The text holds half a surrogate pair.
    """
    if any("\ud800" <= character <= "\udfff" for character in text):
        raise EditError("The text holds half a character: leave it out.")
    printable = _PRINTABLE.fullmatch(text) is not None
    if like[:1] == b'"' or not printable:
        return f'"{_escaped(text)}"'.encode()
    if like[:1] == b"'" or not _can_be_plain(text):
        return "'{}'".format(text.replace("'", "''")).encode()
    return text.encode()


def _can_be_plain(text: str) -> bool:
    """Whether a plain scalar may be this text, also between brackets and at the line's start."""
    return (
        _PLAIN.fullmatch(text) is not None
        and _NOT_PLAIN.search(text) is None
        and not text.startswith(("---", "..."))
    )


def _escaped(text: str) -> str:
    return "".join(_spelled(character) for character in text)


def _spelled(character: str) -> str:
    if character in _SPELLING:
        return _SPELLING[character]
    if _PRINTABLE.fullmatch(character):
        return character
    return f"\\x{ord(character):02x}" if ord(character) < 0x100 else f"\\u{ord(character):04x}"
