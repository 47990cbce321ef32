"""Resolves file names in descriptions to files, or to the file that was probably meant."""

from __future__ import annotations

import os
import re
from difflib import SequenceMatcher
from itertools import islice
from pathlib import Path, PurePath
from typing import TYPE_CHECKING, Final
from urllib.parse import unquote

from studio.errors import PackageError, UnreadableFileError
from studio.files import is_there
from studio.packages.roots import package_folder_of

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Sequence

    from studio.packages.index import PackageIndex
    from studio.packages.roots import ServedRoots

_SCHEME: Final = re.compile(r"([A-Za-z][A-Za-z0-9+.-]+):(?://)?(.*)", re.DOTALL)
_DRIVE: Final = re.compile(r"/?[A-Za-z]:[\\/]")
_PACKAGE_SCHEMES: Final = frozenset({"package", "model"})
"""Gazebo's `model://` names a model folder; in a ROS package that is exported it is the package."""
_FILES_MAX: Final = 4_000
_LIKENESS: Final = 0.75
_LEAST_WORD: Final = 4
"""Shorter parts that differ are no typing errors: `fl` and `fr` are two wheels."""
_WORDS: Final = re.compile(r"[\W_]+")
_NUMBERS: Final = re.compile(r"\d+")


def resolve_uri(uri: str, asking_file: Path | str, index: PackageIndex, roots: ServedRoots) -> Path:
    """Find the file that a URI or path means in the file that names it.

    `package://` and `model://` use the index, `file://` and absolute paths are taken as they are,
    others are relative to the asking file, then to its package. A name with `%20` and the like is
    tried as written first. Links are resolved; the file exists and is served.

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
    """Return possible paths, the most likely first; unescaped spellings last."""
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
    """Return the scheme in lower case, empty when there is none (`C:/a` has none), and the rest."""
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


def near_file(
    uri: str,
    asking_file: Path,
    index: PackageIndex,
    roots: ServedRoots,
    suffixes: Collection[str],
    taken: Collection[str] = (),
) -> str:
    """Return the name in the folder that a missing file was likely meant to have; empty if unclear.

    Another letter case goes first, then another of the `suffixes` (lower case, with their dot),
    then a typing error, unless numbers differ or the robot names that file, too.

    Args:
        uri: As for `resolve_uri`, which finds nothing there.
        asking_file: The file that names it.
        index: The packages.
        roots: What may be read: names of files elsewhere are not revealed.
        suffixes: Suffixes of the files that may be meant.
        taken: URIs that the robot names.
    """
    above, _, name = uri.strip().rpartition("/")
    try:
        folder = resolve_uri(above or ".", asking_file, index, roots)
        names = _names(folder, suffixes)
    except (PackageError, OSError):
        return ""
    if name in names:
        return ""  # it is there: what is wrong with it is something else
    known = {one.rpartition("/")[2] for one in taken if one.rpartition("/")[0] == above}
    for is_meant in (_is_other_case, _is_other_kind):
        if found := _only(name, names, is_meant):
            return found
    return _only(name, [one for one in names if one not in known], _is_typing_error)


def _names(folder: Path, suffixes: Collection[str]) -> list[str]:
    with os.scandir(folder) as entries:
        names = [one.name for one in islice(entries, _FILES_MAX)]
    return [one for one in names if PurePath(one).suffix.lower() in suffixes]


def _only(name: str, names: Sequence[str], is_meant: Callable[[str, str], bool]) -> str:
    found = [one for one in names if is_meant(name, one)]
    return found[0] if len(found) == 1 else ""


def _is_other_case(name: str, other: str) -> bool:
    return name.casefold() == other.casefold()


def _is_other_kind(name: str, other: str) -> bool:
    return PurePath(name).stem.casefold() == PurePath(other).stem.casefold()


def _is_typing_error(name: str, other: str) -> bool:
    return is_misspelt(PurePath(name).stem, PurePath(other).stem)


def is_misspelt(name: str, other: str) -> bool:
    """Whether one name is the other with a typing error: part by part, never in its numbers."""
    one, two = name.casefold(), other.casefold()
    if _NUMBERS.findall(one) != _NUMBERS.findall(two):
        return False
    words, others = _WORDS.split(one), _WORDS.split(two)
    if "".join(words) == "".join(others):
        return True
    if len(words) != len(others):
        return False
    pairs = zip(words, others, strict=True)
    return all(a == b or _is_like(a, b) for a, b in pairs)


def _is_like(word: str, other: str) -> bool:
    if min(len(word), len(other)) < _LEAST_WORD:
        return False
    return SequenceMatcher(None, word, other).ratio() >= _LIKENESS
