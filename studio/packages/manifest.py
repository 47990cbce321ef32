"""The package.xml of a package: its name, and the texts of a tag."""

from __future__ import annotations

import contextlib
import re
from typing import TYPE_CHECKING, Final
from xml.parsers import expat

from studio.errors import UnreadableFileError

if TYPE_CHECKING:
    from collections.abc import Callable

FILE_NAME: Final = "package.xml"
SIZE_LIMIT_BYTES: Final = 1 << 20

_NAME: Final = re.compile(r"[A-Za-z0-9_.-]{1,200}")


def package_name(manifest: bytes) -> str | None:
    """Find the name; None when there is none of letters, digits, `_`, `-` and `.`.

    Reads no further than the name: what is broken behind it does not matter here, and entities
    are refused.
    """
    reader = _Reader()
    with contextlib.suppress(_DoneError, expat.ExpatError, LookupError, ValueError):
        reader.parse(manifest)
    name = reader.text.strip()
    return name if _NAME.fullmatch(name) else None


class _DoneError(Exception):
    """The name was read, or there will be none."""


class _Reader:
    """Collects the text of the first `name` in `package`."""

    def __init__(self) -> None:
        self.text = ""
        self._path: list[str] = []

    def parse(self, manifest: bytes) -> None:
        parser = expat.ParserCreate()
        parser.buffer_text = True
        parser.StartElementHandler = self._start
        parser.EndElementHandler = self._end
        parser.CharacterDataHandler = self._read
        parser.EntityDeclHandler = _refuse_entity
        parser.Parse(manifest, True)  # noqa: FBT003 - expat takes it by position only

    def _start(self, tag: str, _attributes: dict[str, str]) -> None:
        self._path.append(tag)
        if self._path[0] != "package":
            raise _DoneError

    def _end(self, _tag: str) -> None:
        if self._path == ["package", "name"]:
            raise _DoneError
        self._path.pop()

    def _read(self, text: str) -> None:
        if self._path == ["package", "name"]:
            self.text += text


def _refuse_entity(*_declaration: object) -> None:
    raise _DoneError


def texts_of_tag(manifest: bytes, tag: str) -> list[str]:
    """Return the text of each such element of a manifest, without blanks around it.

    Raises:
        UnreadableFileError: It is no XML, or declares entities.
    """
    found: list[str] = []
    open_tags: list[str] = []
    parser = expat.ParserCreate()
    parser.buffer_text = True

    def start(name: str, _attributes: dict[str, str]) -> None:
        open_tags.append(name)
        if name == tag:
            found.append("")

    def text(letters: str) -> None:
        if tag in open_tags:
            found[-1] += letters

    parser.StartElementHandler = start
    parser.EndElementHandler = _popping(open_tags)
    parser.CharacterDataHandler = text
    parser.EntityDeclHandler = _refuse_entity_in_tags
    try:
        parser.Parse(manifest, True)  # noqa: FBT003 - expat takes it by position only
    except (expat.ExpatError, LookupError) as error:
        raise UnreadableFileError(FILE_NAME, f"is no XML ({error}).") from None
    return [one.strip() for one in found]


def _popping(open_tags: list[str]) -> Callable[[str], None]:
    def end(_name: str) -> None:
        open_tags.pop()

    return end


def _refuse_entity_in_tags(*_declaration: object) -> None:
    raise UnreadableFileError(FILE_NAME, "declares entities and was not read.")
