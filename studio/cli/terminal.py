"""Texts of others on a terminal: what would steer it is shown, not carried out."""

from __future__ import annotations

import io
import re
import sys

_STEERING = re.compile(r"[\x00-\x08\x0b-\x1f\x7f-\x9f\u200e\u200f\u202a-\u202e\u2066-\u2069]")


def shown(text: str) -> str:
    """Return a text as it may be printed: whole into a file or pipe, harmless on a terminal."""
    return harmless(text) if sys.stdout.isatty() else text


def take_any_letters() -> None:
    """Let input and output hold what their encodings do not: messages are in any language."""
    for stream, errors in ((sys.stdout, "backslashreplace"), (sys.stdin, "replace")):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors=errors)


def harmless(text: str) -> str:
    """Write control characters as Python does in texts, save tabs and ends of lines."""
    return _STEERING.sub(lambda found: ascii(found[0])[1:-1], text)
