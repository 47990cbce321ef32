"""What stands in one tag of a package.xml."""

from __future__ import annotations

from typing import TYPE_CHECKING
from xml.parsers import expat

from studio.errors import UnreadableFileError
from studio.packages.manifest import FILE_NAME

if TYPE_CHECKING:
    from collections.abc import Callable


def texts_of_tag(manifest: bytes, tag: str) -> list[str]:
    """Give the text of each such element of a manifest, without blanks around it.

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
    parser.EntityDeclHandler = _refuse_entity
    try:
        parser.Parse(manifest, True)  # noqa: FBT003 - expat takes it by position only
    except (expat.ExpatError, LookupError) as error:
        raise UnreadableFileError(FILE_NAME, f"is no XML ({error}).") from None
    return [one.strip() for one in found]


def _popping(open_tags: list[str]) -> Callable[[str], None]:
    def end(_name: str) -> None:
        open_tags.pop()

    return end


def _refuse_entity(*_declaration: object) -> None:
    raise UnreadableFileError(FILE_NAME, "declares entities and was not read.")
