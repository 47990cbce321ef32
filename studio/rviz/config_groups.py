"""Names of groups of displays in `.rviz` files, and as the steps of paths."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from studio.rviz.config_text import scalar_of
from studio.rviz.config_values import one_line, put

if TYPE_CHECKING:
    from studio.rviz.config_values import Entry

_NAME_MAX: Final = 48
"""Letters of a group's name in a path; in the file it keeps all."""
_SLASH: Final = "\u2215"
"""Stands for a slash in the name of a group, since slashes lead from one group to the next."""


def group_name(name: str) -> str:
    """Return the name of a group as one step of a path."""
    return one_line(name).replace("/", _SLASH)[:_NAME_MAX].strip() or "Group"


def name_in_path(path: str) -> str:
    """Return the name in the file of the group that a path leads to."""
    return path.rpartition("/")[2].replace(_SLASH, "/")


def renamed_group(entry: Entry, step: str) -> Entry:
    """Return the entry of a group whose path ends with another step now."""
    return put(entry, ("Name",), scalar_of(name_in_path(step)))
