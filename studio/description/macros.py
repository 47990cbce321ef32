"""Macros: their parameters, and the tables in which they are found by name."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.description.output_tree import Node
    from studio.description.run_record import Binding

_DEFAULT: Final = r"""\$\{.*?\}|\$\(.*?\)|(?:'.*?'|\".*?\"|[^\s'\"]+)+|"""
_PARAMETER: Final = re.compile(r"^\s*([^\s:=]+?)\s*:?=\s*(\^\|?)?(" + _DEFAULT + r")(?:\s+|$)(.*)")


@dataclass(frozen=True, slots=True)
class Default:
    """What a parameter is when a call does not give it.

    `forward`: the value of the same name where the macro is called (`:=^`); `text`: evaluated
    there, after `^|` only if that name is not defined.
    """

    forward: bool
    text: str | None


@dataclass(slots=True)
class Macro:
    """One macro. A later definition of the same name in the same table changes it in place.

    `parameters` keep their stars: `*block` takes one element of the call, `**block` its content.
    """

    name: str
    body: Node
    parameters: list[str] = field(default_factory=list[str])
    defaults: dict[str, Default] = field(default_factory=dict[str, Default])
    bindings: dict[str, Binding] = field(default_factory=dict[str, "Binding"])


def read_parameters(text: str) -> tuple[list[str], dict[str, Default]]:
    """Read `params="a b:=1 c:='x y' d:=^|3 *block **blocks"`."""
    names: list[str] = []
    defaults: dict[str, Default] = {}
    while text:
        match = _PARAMETER.match(text)
        if match:
            name, forward, default, text = match.groups()
            defaults[name] = Default(forward is not None, default or None)
        else:
            words = text.lstrip().split(None, 1)
            if not words:
                break
            name, text = words[0], words[1] if len(words) > 1 else ""
        names.append(name)
    return names, defaults


class MacroTable:
    """Macros of a file, a macro call or a `ns=` include; what it lacks its parent may have."""

    __slots__ = ("_entries", "parent")

    def __init__(self, parent: MacroTable | None = None) -> None:
        self._entries: dict[str, Macro | MacroTable] = {}
        self.parent = parent

    def own(self, name: str) -> Macro | None:
        """The macro defined in this very table."""
        found = self._entries.get(name)
        return found if isinstance(found, Macro) else None

    def find(self, name: str) -> Macro | MacroTable | None:
        """What a name means here."""
        table: MacroTable | None = self
        while table is not None:
            if name in table._entries:
                return table._entries[name]
            table = table.parent
        return None

    def put(self, name: str, entry: Macro | MacroTable) -> None:
        """Bind a name here."""
        self._entries[name] = entry

    def all_names(self, prefix: str = "") -> Iterator[str]:
        """Every macro that can be called from here, for hints."""
        table: MacroTable | None = self
        while table is not None:
            for name, entry in table._entries.items():
                if isinstance(entry, MacroTable):
                    yield from entry.all_names(f"{prefix}{name}.")
                else:
                    yield prefix + name
            table = table.parent
