"""What a finished run knows about the texts that went into it; `sites` builds Sites from it.

A `Binding` is one written text that got a name: an arg, a property, the default of a macro
parameter, an argument of a macro call. Many calls may bind it, so it collects values and readers
over the whole run. `dependents` link them to a graph from the source to what came out.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, TypeAlias

if TYPE_CHECKING:
    from collections.abc import Mapping

    from studio.description.source_tree import SourceElement, SourceTree
    from studio.description.values import SiteKind
    from studio.problems import Problem

VALUES_KEPT = 16
CONSUMERS_KEPT = 8

KeyPath: TypeAlias = tuple[str | int, ...]
"""Where a YAML value stands: mapping keys as text and list indices, outermost first."""
Consumer: TypeAlias = tuple[str, str]
"""An attribute that came out: (`link/visual/geometry/cylinder`, `radius`). A condition of
`xacro:if` is (`xacro:if`, `value`), the text of an element has the attribute ``."""


class Input:
    """Anything named that a text can read."""

    __slots__ = ("compared", "consumers", "dependents", "reads")

    def __init__(self) -> None:
        self.reads = 0
        """How many evaluated texts read it."""
        self.dependents: dict[Input, None] = {}
        """Named values that were made from it."""
        self.compared: dict[str, None] = {}
        """Texts that it is compared with directly, as in `${x == 'a'}`."""
        self.consumers: dict[Consumer, None] = {}
        """Attributes that read it directly, the first few; see `consumers_of`."""


class Binding(Input):
    """One named text at one place in a source file, with all that it came to in the run.

    `kind` is None for an argument of a macro call, which is no site, only a link of the graph.
    `attribute` is `value` or `default`; for a macro's default `params`, with `name` the parameter.
    """

    __slots__ = ("attribute", "element", "kind", "name", "overridden", "text", "values")

    def __init__(
        self, kind: SiteKind | None, name: str, element: SourceElement, attribute: str, text: str
    ) -> None:
        super().__init__()
        self.kind, self.name, self.element = kind, name, element
        self.attribute, self.text = attribute, text
        self.values: dict[str, None] = {}
        """Distinct values as xacro prints them, in order seen, the first few."""
        self.overridden = False
        """An arg whose value was given from outside, or by an earlier declaration."""

    def saw(self, value: object) -> None:
        """Note a value that it came to; a container only as such, it may be a whole file."""
        if len(self.values) >= VALUES_KEPT:
            return
        if isinstance(value, dict):
            value = "{...}"
        elif isinstance(value, list | tuple | set):
            value = "[...]"
        self.values[value if isinstance(value, str) else str(value)] = None

    def __repr__(self) -> str:
        return f"{self.name}={self.text!r} at {self.element.place}"


class YamlScalar(Input):
    """One value of a YAML document that the run read, by its key path; it may be a container."""

    __slots__ = ("document", "path")

    def __init__(self, document: str, path: KeyPath) -> None:
        super().__init__()
        self.document, self.path = document, path


@dataclass(slots=True)
class YamlReads:
    """A YAML file that was read and what of it: containers count too when they are passed through.

    `whole`: key paths below which everything was read at once (printed, iterated in bulk).
    """

    path: str
    data: bytes
    values: dict[KeyPath, YamlScalar] = field(default_factory=dict[KeyPath, YamlScalar])
    whole: set[KeyPath] = field(default_factory=set[KeyPath])
    loaded_by: list[SourceElement] = field(default_factory=list["SourceElement"])


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


def consumers_of(start: Input, limit: int = CONSUMERS_KEPT) -> tuple[Consumer, ...]:
    """The attributes that an input shapes, through any number of properties, the nearest first."""
    found: dict[Consumer, None] = {}
    seen, front = {start}, [start]
    while front and len(found) < limit:
        for one in front:
            found.update(one.consumers)
        reached = {dependent: None for one in front for dependent in one.dependents}
        front = [one for one in reached if one not in seen]
        seen.update(front)
    return tuple(found)[:limit]
