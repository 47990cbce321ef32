"""Arguments of xacro files, `name:=value`, which may stand anywhere on a command line."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.errors import SettingsError

if TYPE_CHECKING:
    from collections.abc import Sequence

_MAPPING = ":="


def part_mappings(words: Sequence[str]) -> tuple[list[str], list[str]]:
    """Part the words of a command line: those without `:=`, and those with."""
    return (
        [word for word in words if _MAPPING not in word],
        [word for word in words if _MAPPING in word],
    )


def read_mappings(words: Sequence[str]) -> dict[str, str]:
    """`name:=value` by name, as xacro reads it: outer blanks dropped, `_name` is not for it.

    Raises:
        SettingsError: A word has more than one `:=`.
    """
    found: dict[str, str] = {}
    for word in words:
        name, *values = (part.strip() for part in word.split(_MAPPING))
        if len(values) != 1:
            raise SettingsError(f"{word} is no argument: write it as name:=value.")
        is_hidden = len(name) > 1 and name[0] == "_" and name[1] != "_"
        if name and values[0] and not is_hidden:
            found[name] = values[0]
    return found
