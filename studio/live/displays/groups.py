"""Groups of displays: paths such as `Navigation/Local`, for a group may stand in another."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from studio.errors import CommandError

if TYPE_CHECKING:
    from collections.abc import Iterable

DEPTH_MAX: Final = 8
"""RViz has no limit; a path of more groups is somebody's mistake."""


def group_path(text: str) -> str:
    """Return the path of a group as it is kept: without empty names and spaces around them.

    Raises:
        CommandError: It stands in too many others.
    """
    names = [name for part in text.split("/") if (name := part.strip())]
    if len(names) > DEPTH_MAX:
        raise CommandError(
            f"A group can stand in {DEPTH_MAX - 1} others at most: choose one further out."
        )
    return "/".join(names)


def groups_to(group: str) -> tuple[str, ...]:
    """Return a group and those around it, the outermost first; none for an empty path."""
    names = group.split("/") if group else []
    return tuple("/".join(names[: at + 1]) for at in range(len(names)))


def all_groups(groups: Iterable[str]) -> frozenset[str]:
    """Return the groups with those around them."""
    return frozenset(outer for group in groups for outer in groups_to(group))


def is_within(group: str, outer: str) -> bool:
    """Whether a group is another, or stands in it at any depth."""
    return group == outer or group.startswith(f"{outer}/")


def regrouped(group: str, before: str, to: str) -> str:
    """Return the path of a group once another, which it is or stands in, has a new path."""
    rest = group.removeprefix(before).removeprefix("/")
    return group_path(f"{to}/{rest}")
