"""The files that a mesh file names: its materials and its images."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final
from urllib.parse import unquote

from studio.errors import OutsideRootsError, UnreadableFileError
from studio.packages.presence import is_file

if TYPE_CHECKING:
    from pathlib import Path

    from studio.packages.roots import ServedRoots

_NAMED: Final = {
    ".obj": re.compile(rb"^\s*mtllib[ \t]+([^\r\n]+)", re.MULTILINE),
    ".mtl": re.compile(
        rb"^\s*(?:map_\w+|bump|disp|decal|refl)[ \t]+([^\r\n]+)", re.MULTILINE | re.IGNORECASE
    ),
    ".dae": re.compile(rb"<init_from>\s*(?:<ref>)?\s*([^<]+?)\s*<"),
    ".gltf": re.compile(rb'"uri"\s*:\s*"([^"]+)"'),
}
_LIMIT: Final = 200
"""Of what one mesh names."""
_TEXT_LIMIT_BYTES: Final = 256 << 20


def companions(mesh: Path, served: ServedRoots) -> list[Path]:
    """Every served file that a mesh names, beside or below its folder, directly or by another."""
    found: dict[Path, None] = {}
    waiting = [mesh]
    while waiting and len(found) < _LIMIT:
        for path in _named_in(waiting.pop(), served):
            if path not in found and path != mesh and path.is_relative_to(mesh.parent):
                found[path] = None
                waiting.append(path)
    return list(found)


def _named_in(file: Path, served: ServedRoots) -> list[Path]:
    pattern = _NAMED.get(file.suffix.lower())
    if pattern is None:
        return []
    try:
        data = served.read(file, _TEXT_LIMIT_BYTES)
    except (OutsideRootsError, UnreadableFileError):
        return []
    written = {one.decode("utf-8", "replace").strip() for one in pattern.findall(data)}
    # Several may stand in one line, behind options; and a name may have a blank in it.
    names = {name for one in written for name in (one, *one.split())}
    paths = (_served(file, name, served) for name in sorted(names) if not name.startswith("data:"))
    return [path for path in paths if path is not None]


def _served(file: Path, name: str, served: ServedRoots) -> Path | None:
    for spelled in (name, unquote(name)):
        try:
            path = served.resolve(file.parent / spelled.replace("\\", "/").removeprefix("./"))
        except (OutsideRootsError, UnreadableFileError):
            continue
        if is_file(path):
            return path
    return None
