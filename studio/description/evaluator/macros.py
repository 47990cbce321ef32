"""Macros: their parameters, and the tables in which they are found by name."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

from studio.description.faults import Refusal

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.description.evaluator.output_tree import Node
    from studio.description.evaluator.run_record import Binding

DEFAULT: Final = r"""\$\{.*?\}|\$\(.*?\)|(?:(?>'.*?')|(?>".*?")|[^\s'"]++)+|"""
"""As xacro's, but what was found is not given back: looking for it again takes forever."""
_PARAMETER: Final = re.compile(r"^\s*([^\s:=]+?)\s*:?=\s*(\^\|?)?(" + DEFAULT + r")(?:\s+|$)(.*)")
_AS_XACRO: Final = re.compile(re.sub(r"\(\?>([^)]*)\)", r"\1", _PARAMETER.pattern))
"""Xacro's own, where few quotes leave few ways to pair them; with many all must have their pair."""
_QUOTES_LIMIT: Final = 12
PARAMS_LIMIT: Final = 20_000
"""Characters of `params`."""


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
    """Read `params="a b:=1 c:='x y' d:=^|3 *block **blocks"`.

    Raises:
        Refusal: It is longer than PARAMS_LIMIT.
    """
    if len(text) > PARAMS_LIMIT:
        raise Refusal("params-too-long", "The params of a macro are too long to be read.")
    names: list[str] = []
    defaults: dict[str, Default] = {}
    while text.strip():
        name, default, text = parameter(text)
        names.append(name)
        if default is not None:
            defaults[name] = default
    return names, defaults


def parameter(text: str) -> tuple[str, Default | None, str]:
    """The first parameter of a `params`, its default, and the text behind it."""
    quotes = sum(map(text.count, "'\""))
    match = (_AS_XACRO if quotes <= _QUOTES_LIMIT else _PARAMETER).match(text)
    if match is None:
        name, *rest = text.lstrip().split(None, 1)
        return name, None, rest[0] if rest else ""
    name, forward, default, rest = match.groups()
    return name, Default(forward is not None, default or None), rest


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
