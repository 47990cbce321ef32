"""A type as `interface show` prints it: its own text, nested fields indented below theirs."""

from __future__ import annotations

import re
from enum import Enum, auto
from typing import TYPE_CHECKING

from studio.ros.types.definitions import messages_of
from studio.ros.types.interface_text import text_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.ros.types.definitions import Interface
    from studio.ros.types.library import TypeLibrary

_FIELD = re.compile(r"\s*([A-Za-z][\w/]*)\S*\s+([A-Za-z]\w*)\s*(?!\s*=)")


class Comments(Enum):
    """Which comments of the texts are kept."""

    NONE = auto()
    OWN = auto()
    """Those of the type that was asked for."""
    ALL = auto()


def type_text(library: TypeLibrary, name: str, comments: Comments) -> str:
    """Write a type by its full name, each line with its end.

    Raises:
        UnknownTypeError: It, or what it is made of, is not known.
    """
    interface = library.interface(name)
    text = library.text_of(name) or _written(interface)
    nested = [
        {field.name: field.type.base for field in part.fields if field.type.nested}
        for part in messages_of(interface)
    ]
    return "".join(f"{line}\n" for line in _Writer(library, comments).lines(text, nested, 0))


class _Writer:
    def __init__(self, library: TypeLibrary, comments: Comments) -> None:
        self._library, self._comments = library, comments

    def lines(self, text: str, nested: list[dict[str, str]], level: int) -> Iterator[str]:
        """Give the lines of a text; below each field of a message, those of that message."""
        part = 0
        keeps = self._comments is Comments.ALL or (self._comments is Comments.OWN and not level)
        for line in text.strip("\n").split("\n"):
            code = _without_comment(line)
            if keeps or code.strip():
                yield "\t" * level + (line if keeps else code).rstrip()
            if code.strip() == "---":
                part += 1
                continue
            field = _FIELD.match(code)
            if field and field[2] in nested[part]:
                yield from self._inner(nested[part][field[2]], level + 1)

    def _inner(self, name: str, level: int) -> Iterator[str]:
        message = self._library.find(name)
        fields = {field.name: field.type.base for field in message.fields if field.type.nested}
        text = self._library.text_of(name) or _written(message)
        yield from self.lines(text, [fields], level)


def _written(interface: Interface) -> str:
    """Write a type that came without a text, its package's own types without the package."""
    package = interface.name.partition("/")[0]
    return re.sub(rf"^{package}/", "", text_of(interface), flags=re.MULTILINE)


def _without_comment(line: str) -> str:
    """Cut a comment off; a `#` within quotes is none."""
    quote = ""
    for at, letter in enumerate(line):
        if quote:
            quote = "" if letter == quote and line[at - 1] != "\\" else quote
        elif letter in "\"'":
            quote = letter
        elif letter == "#":
            return line[:at]
    return line
