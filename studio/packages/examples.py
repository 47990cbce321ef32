"""The models that the studio ships, each with one line about what it shows."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple
from xml.parsers import expat

from studio.packages.manifest import FILE_NAME
from studio.packages.presence import is_file

if TYPE_CHECKING:
    from pathlib import Path

_ENDING: Final = "_description"


class Example(NamedTuple):
    """A shipped package."""

    package: str
    robot: str
    text: str
    """Its description, as the package.xml has it."""


def examples(models_folder: Path) -> tuple[Example, ...]:
    """All of them, by name."""
    manifests = sorted(models_folder.glob(f"*/{FILE_NAME}"))
    return tuple(_example(one) for one in manifests if is_file(one))


def _example(manifest: Path) -> Example:
    package = manifest.parent.name
    return Example(package, package.removesuffix(_ENDING), _description(manifest.read_bytes()))


def _description(manifest: bytes) -> str:
    """The text of `description`; the file is one of ours."""
    open_tags: list[str] = []
    texts: list[str] = []
    parser = expat.ParserCreate()
    parser.StartElementHandler = lambda tag, _: open_tags.append(tag)
    parser.EndElementHandler = lambda _: open_tags.pop()
    parser.CharacterDataHandler = lambda text: (
        texts.append(text) if open_tags == ["package", "description"] else None
    )
    parser.Parse(manifest, True)  # noqa: FBT003 - expat takes it by position only
    return " ".join("".join(texts).split())
