"""Which parameters a request for a list means: prefixes, and how deep names may go below them."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

DEPTH_RECURSIVE = 0
SEPARATOR = "."


def listed(names: Iterable[str], prefixes: Iterable[str] = (), depth: int = 0) -> list[str]:
    """Choose names, in the order of the alphabet; no prefix is all, depth 0 any depth."""
    wanted = list(prefixes)
    return sorted(name for name in names if _is_meant(name, wanted, depth))


def prefixes_of(names: Iterable[str]) -> list[str]:
    """Name the groups that lie directly above names: `a.b` of `a.b.c`."""
    return sorted({name.rpartition(SEPARATOR)[0] for name in names if SEPARATOR in name})


def _is_meant(name: str, prefixes: list[str], depth: int) -> bool:
    if not prefixes:
        return _within(name, depth)
    for prefix in prefixes:
        rest = name.removeprefix(prefix + SEPARATOR)
        if name == prefix or (rest != name and _within(rest, depth)):
            return True
    return False


def _within(name: str, depth: int) -> bool:
    return depth == DEPTH_RECURSIVE or name.count(SEPARATOR) < depth
