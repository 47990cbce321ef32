"""From what a description writes as a file name to the file."""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import TYPE_CHECKING, Final
from urllib.parse import unquote

from studio.errors import UnreadableFileError
from studio.packages.presence import is_there
from studio.packages.roots import package_folder_of

if TYPE_CHECKING:
    from studio.packages.index import PackageIndex
    from studio.packages.roots import ServedRoots

_SCHEME: Final = re.compile(r"([A-Za-z][A-Za-z0-9+.-]+):(?://)?(.*)", re.DOTALL)
_DRIVE: Final = re.compile(r"/?[A-Za-z]:[\\/]")
_PACKAGE_SCHEMES: Final = frozenset({"package", "model"})
"""Gazebo's `model://` names a model folder; in a ROS package that is exported it is the package."""


def resolve_uri(uri: str, asking_file: Path | str, index: PackageIndex, roots: ServedRoots) -> Path:
    """Find the file that a URI or path means for the file that it stands in.

    `package://` and `model://` go through the index, `file://` and absolute paths are taken as they
    are, the rest is looked for beside the asking file and then in its package. A name with `%20`
    and the like is tried as written first. Links are resolved; the file is there and is served.

    Raises:
        PackageNotFoundError: No package has that name.
        OutsideRootsError: It leads out of the served folders, by `..`, a link or as it stands.
        UnreadableFileError: Nothing is there, or the scheme is of no file.
    """
    written = uri.strip()
    if not written:
        raise UnreadableFileError(str(asking_file), "a file name is empty.")
    candidates = _candidates(written, Path(asking_file), index)
    resolved = [roots.resolve(one) for one in candidates[:1]]
    for candidate in candidates[1:]:
        if not is_there(resolved[-1]) and roots.serves(candidate):
            resolved.append(roots.resolve(candidate))
    if not is_there(resolved[-1]):
        raise UnreadableFileError(uri, f"does not exist (looked for {resolved[0]}).")
    return resolved[-1]


def _candidates(written: str, asking_file: Path, index: PackageIndex) -> list[Path]:
    """Where it may be, most likely first; unescaped spellings last."""
    places = _places(written, asking_file, index)
    if "%" in written:
        places += _places(unquote(written), asking_file, index)
    return list(dict.fromkeys(places))


def _places(written: str, asking_file: Path, index: PackageIndex) -> list[Path]:
    scheme, rest = _split(written)
    if scheme in _PACKAGE_SCHEMES:
        name, _, inside = rest.lstrip("/").partition("/")
        return [_joined(index.best(name, asking_file), inside)]
    if scheme not in ("", "file"):
        raise UnreadableFileError(written, f'"{scheme}" names no file: write package:// or a path.')
    if scheme == "file":
        rest = rest.removeprefix("localhost/") if rest.startswith("localhost/") else rest
        rest = rest if _is_absolute(rest) else f"/{rest}"
    return _paths(rest, asking_file)


def _split(written: str) -> tuple[str, str]:
    """The scheme in lower case, empty when there is none (`C:/a` has none), and the rest."""
    found = None if _DRIVE.match(written) else _SCHEME.fullmatch(written)
    return (found[1].lower(), found[2]) if found else ("", written)


def _paths(path: str, asking_file: Path) -> list[Path]:
    path = path.replace("\\", "/") if os.name == "nt" or _DRIVE.match(path) else path
    if _DRIVE.match(path):
        return [Path(path.removeprefix("/"))]
    if _is_absolute(path):
        return [Path(path)]
    beside = _joined(asking_file.parent, path)
    package = package_folder_of(asking_file.parent)
    return [beside] if package is None else [beside, _joined(package, path)]


def _is_absolute(path: str) -> bool:
    return path.startswith("/") or bool(_DRIVE.match(path))


def _joined(folder: Path, inside: str) -> Path:
    """Join without letting an absolute `inside` replace the folder."""
    return folder / inside.lstrip("/")
