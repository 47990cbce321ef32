"""What a finished run knows about the texts that went into it; `sites` builds Sites from it.

A `Binding` is one written text that got a name: an arg, a property, the default of a macro
parameter, an argument of a macro call. Many calls may bind it, so it collects values and readers
over the whole run; `graph` says how these are linked.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from studio.description.evaluator.graph import Readable

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from studio.description.evaluator.graph import Record
    from studio.description.evaluator.scopes import Cell
    from studio.description.evaluator.texts import Argument
    from studio.description.syntax.source_tree import SourceElement, SourceTree
    from studio.description.syntax.yaml_spans import KeyPath
    from studio.description.values import SiteKind
    from studio.problems import Problem

VALUES_KEPT = 16


class Input:
    """Anything named in a source that texts read: a binding, or a value of a YAML file."""

    __slots__ = ()

    compared: dict[str, None] = {}  # noqa: RUF012 - shared by those that nothing is noted at
    """Texts that it is compared with directly, as in `${x == 'a'}`."""

    @property
    def readings(self) -> Sequence[Record]:
        """The evaluations that read and use it, in order, once per read."""
        return ()


class Binding(Input):
    """One named text at one place in a source file, with all that it was bound to in the run.

    `kind` is None for an argument of a macro call, which is no site, only a link of the graph.
    `attribute` is `value` or `default`; for a macro's default `params`, with `name` the parameter.
    """

    __slots__ = (
        "attribute",
        "compared",
        "element",
        "holders",
        "kind",
        "name",
        "overridden",
        "text",
    )

    def __init__(
        self, kind: SiteKind | None, name: str, element: SourceElement, attribute: str, text: str
    ) -> None:
        self.kind, self.name, self.element = kind, name, element
        self.attribute, self.text = attribute, text
        self.holders: list[Cell | Argument] = []
        """What it was bound to, in order: a cell per macro call, or the argument."""
        self.compared: dict[str, None] = {}
        self.overridden = False
        """An arg whose value was given from outside, or by an earlier declaration."""

    @property
    def readings(self) -> Sequence[Record]:
        """As `Input.readings`; those of an arg are those of its first declaration."""
        holders = self.holders
        if len(holders) == 1 and holders[0].binding is self:
            return [one for one in holders[0].readers if one.counts]
        found = (one for it in holders if it.binding is self for one in it.readers if one.counts)
        return sorted(found, key=_order)

    @property
    def values(self) -> tuple[str, ...]:
        """Distinct values as xacro prints them, in order seen, the first few."""
        holders = [one for one in self.holders if getattr(one, "pending", None) is None]
        if len(holders) > 1:
            holders.sort(key=_when_seen)
        found: dict[str, None] = {}
        for one in holders:
            found[_shown(one.value)] = None
            if len(found) == VALUES_KEPT:
                break
        return tuple(found)

    def __repr__(self) -> str:
        return f"{self.name}={self.text!r} at {self.element.place}"


def _order(record: Record) -> float:
    return record.order


def _when_seen(holder: Cell | Argument) -> float:
    return holder.record.order if holder.record is not None else 0


def _shown(value: object) -> str:
    """A value as text; a container only as such, it may be a whole file, others by their kind."""
    if isinstance(value, dict):
        return "{...}"
    if isinstance(value, list | tuple | set):
        return "[...]"
    if value is None or isinstance(value, str | int | float | complex):
        return str(value)
    return f"<{type(value).__name__}>"


class YamlScalar(Readable, Input):
    """One value of a YAML document that the run read, by its key path; it may be a container."""

    __slots__ = ("document", "path")

    def __init__(self, document: str, path: KeyPath) -> None:
        super().__init__()
        self.document, self.path = document, path

    @property
    def readings(self) -> Sequence[Record]:
        """As `Input.readings`."""
        return [one for one in self.readers if one.counts]


class YamlReads(Readable):
    """A YAML file that was read and what of it: containers count too when they are passed through.

    `whole`: key paths below which everything was read at once (printed, iterated in bulk). Its
    `readers` are those who opened the file.
    """

    __slots__ = ("data", "loaded_by", "path", "values", "whole")

    def __init__(self, path: str, data: bytes) -> None:
        super().__init__()
        self.path, self.data = path, data
        self.values: dict[KeyPath, YamlScalar] = {}
        self.whole: set[KeyPath] = set()
        self.loaded_by: list[SourceElement] = []


@dataclass(slots=True)
class RunRecord:
    """One finished run. `trees` and `yaml` are keyed by absolute path, symlinks resolved."""

    entry: str
    trees: Mapping[str, SourceTree]
    files: tuple[str, ...]
    """Every file read, in order, the entry first, YAML included."""
    includes: tuple[tuple[str, str], ...]
    """(includer, included) pairs, in order, once each."""
    bindings: tuple[Binding, ...]
    """In the order in which the run met them."""
    yaml: Mapping[str, YamlReads]
    part_keys: Mapping[SourceElement, tuple[str, ...]]
    """Which parts each source element came out in; an element that is in no part is missing."""
    arguments: Mapping[str, str]
    """Values of all args as strings: given ones and defaults."""
    warnings: tuple[Problem, ...]
