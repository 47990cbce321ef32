"""The files that a mesh file names: its materials and its images."""

from __future__ import annotations

import re
from itertools import islice
from typing import TYPE_CHECKING, Final
from urllib.parse import unquote

from studio.errors import OutsideRootsError, UnreadableFileError
from studio.packages.presence import is_file

if TYPE_CHECKING:
    from pathlib import Path

    from studio.packages.roots import ServedRoots

# One way only to read any text: a mesh may be megabytes of blanks.
_NAMED: Final = {
    ".obj": re.compile(rb"^[ \t]*mtllib[ \t]+([^\r\n]+)", re.MULTILINE),
    ".mtl": re.compile(
        rb"^[ \t]*(?:map_\w+|bump|disp|decal|refl)[ \t]+([^\r\n]+)", re.MULTILINE | re.IGNORECASE
    ),
    ".dae": re.compile(rb"<init_from>\s*+(?:<ref>)?+([^<]++)<"),
    ".gltf": re.compile(rb'"uri"\s*:\s*"([^"]+)"'),
}
_LIMIT: Final = 200
"""Of what one mesh names."""
_READ_LIMIT: Final = 2_000
"""Names that are looked for, whether or not something is there."""
_NAME_LIMIT_BYTES: Final = 4096
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
    found = islice(pattern.finditer(data), _READ_LIMIT)
    written = {one[1][:_NAME_LIMIT_BYTES].decode("utf-8", "replace").strip() for one in found}
    # Several may stand in one line, behind options; and a name may have a blank in it.
    names = {name for one in written for name in (one, *one.split())}
    looked_for = sorted(name for name in names if not name.startswith("data:"))[:_READ_LIMIT]
    paths = (_served(file, name, served) for name in looked_for)
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
