"""The files of the corpus that can be read, one after the other."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from studio.description.syntax.source_tree import SourceError, SourceTree, parse_source

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

_XML_SUFFIXES = frozenset({".xacro", ".urdf", ".sdf", ".srdf", ".xml", ".launch"})
_YAML_SUFFIXES = frozenset({".yaml", ".yml"})


def xml_trees(corpus: Path) -> Iterator[SourceTree]:
    """Every XML file that the source tree accepts."""
    for path in _files(corpus, _XML_SUFFIXES):
        try:
            yield parse_source(str(path), path.read_bytes())
        except SourceError:
            continue


def yaml_files(corpus: Path) -> Iterator[Path]:
    """Every YAML file."""
    return _files(corpus, _YAML_SUFFIXES)


def _files(corpus: Path, suffixes: frozenset[str]) -> Iterator[Path]:
    return (
        path
        for path in sorted(corpus.rglob("*"))
        if path.suffix.lower() in suffixes and path.is_file()
    )


def package_folders(corpus: Path) -> dict[str, tuple[str, ...]]:
    """The folders of each package of the corpus, by name."""
    found: dict[str, tuple[str, ...]] = {}
    for path in sorted(corpus.rglob("package.xml")):
        name = re.search(r"<name>\s*([^<\s]+)", path.read_text("utf-8", "replace"))
        if name:
            found[name[1]] = (*found.get(name[1], ()), str(path.parent))
    return found
