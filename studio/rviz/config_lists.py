"""Tools and saved views in `.rviz` files: which entry of the file each of them was."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, TypeVar

from studio.rviz.config_values import kind_in
from studio.rviz.tools import ToolSpec
from studio.rviz.views import ViewSpec

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from studio.rviz.config_text import Tree
    from studio.rviz.config_values import Entry

Spec = TypeVar("Spec", ToolSpec, ViewSpec)


def entries_between(
    before: Iterable[Tree], written: Sequence[tuple[Entry, Entry]], kinds: Mapping[str, object]
) -> list[Tree]:
    """Return the list as it is written: what is not known here stays behind what it stood behind.

    Args:
        before: The list as it was read.
        written: What each one was in the file (empty: nothing), and what it is now.
        kinds: Those that are known here, by RViz's class without its package.
    """
    behind: list[list[Tree]] = [[] for _ in range(len(written) + 1)]
    at, left = 0, list(range(len(written)))
    for entry in before:
        if not isinstance(entry, dict) or kind_in(entry, kinds) is None:
            behind[at].append(entry)
        elif (found := next((n for n in left if written[n][0] == entry), None)) is not None:
            left.remove(found)
            at = found + 1
    made = list(behind[0])
    for (_, now), others in zip(written, behind[1:], strict=True):
        made += [now, *others]
    return made


def with_entries(specs: Iterable[Spec], saved: Iterable[Spec]) -> list[Spec]:
    """Return tools or views with the entries of the file that they were saved to, in its order."""
    left = list(saved)
    noted: list[Spec] = []
    for one in specs:
        is_next = bool(left) and (left[0].kind, left[0].name) == (one.kind, one.name)
        noted.append(replace(one, entry=left.pop(0).entry) if is_next else one)
    return noted
