"""Macros, and the tables in which they are found by name."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.description.evaluator.output_tree import Node
    from studio.description.syntax.params import Default


@dataclass(slots=True)
class Macro:
    """One macro. A later definition of the same name in the same table changes it in place.

    `parameters` keep their stars: `*block` takes one element of the call, `**block` its content.
    """

    name: str
    body: Node
    parameters: list[str] = field(default_factory=list[str])
    defaults: dict[str, Default] = field(default_factory=dict[str, "Default"])


class MacroTable:
    """Macros of a file, a macro call or a `ns=` include; what it lacks its parent may have."""

    __slots__ = ("_entries", "parent")

    def __init__(self, parent: MacroTable | None = None) -> None:
        self._entries: dict[str, Macro | MacroTable] = {}
        self.parent = parent

    def own(self, name: str) -> Macro | None:
        """Return the macro defined in this very table."""
        found = self._entries.get(name)
        return found if isinstance(found, Macro) else None

    def find(self, name: str) -> Macro | MacroTable | None:
        """Return what a name means here."""
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
        """Yield every macro that can be called from here, for hints."""
        table: MacroTable | None = self
        while table is not None:
            for name, entry in table._entries.items():
                if isinstance(entry, MacroTable):
                    yield from entry.all_names(f"{prefix}{name}.")
                else:
                    yield prefix + name
            table = table.parent
