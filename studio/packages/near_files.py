"""The file that was meant by a name that is not there: spelt another way, in the same folder."""

from __future__ import annotations

import os
import re
from difflib import SequenceMatcher
from itertools import islice
from pathlib import PurePath
from typing import TYPE_CHECKING, Final

from studio.errors import PackageError
from studio.packages.uris import resolve_uri

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Sequence
    from pathlib import Path

    from studio.packages.index import PackageIndex
    from studio.packages.roots import ServedRoots

_FILES_LOOKED_AT: Final = 4_000
_LIKENESS: Final = 0.75
_LEAST_WORD: Final = 4
"""Shorter words that differ are no typing errors: `fl` and `fr` are two wheels."""
_WORDS: Final = re.compile(r"[\W_]+")
_NUMBERS: Final = re.compile(r"\d+")


def near_file(
    uri: str,
    asking_file: Path,
    index: PackageIndex,
    roots: ServedRoots,
    suffixes: Collection[str],
    taken: Collection[str] = (),
) -> str:
    """The name in the folder of a missing file that was likely meant; empty unless it is one only.

    Other letter case goes first, then another of the `suffixes` (lower case, with their dot), then
    a typing error, which is none where numbers differ, or where the robot names that file, too.

    Args:
        uri: As for `resolve_uri`, which finds nothing there.
        asking_file: The file that it stands in.
        index: Of the packages.
        roots: What may be read: names of files elsewhere are not told.
        suffixes: Of the files that may be meant.
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
        names = [one.name for one in islice(entries, _FILES_LOOKED_AT)]
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
    """Whether one name is the other with a typing error: word by word, never in its numbers."""
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
