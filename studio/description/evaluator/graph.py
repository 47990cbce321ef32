"""The graph of a run: names and what they are bound to, texts and what was read to evaluate them.

A `Scope` holds the names of a file, a macro call or a `ns=` include: `Cell`s, found as dynamically
as xacro finds them. A `Binding` is one written text that got a name: an arg, a property, the
default of a macro parameter, an argument of a macro call. Many calls may bind it, so it collects
what it was bound to over the whole run.

A `Record` is one evaluation of one text. `reads` are the things that it read, in order: cells
(bindings of a name in a scope), arguments, YAML values and YAML files; each of these keeps its
`readers`. So the graph can be walked in both directions:

- From an attribute that came out back to the source: `element.makers[name]` is the record whose
  text made it; no entry means that it is in the source as it came out. Each `Cell` among its
  `reads` has a `binding` (where it is written: element, attribute, text), and a `record` when its
  text was evaluated, whose `reads` lead on. `behind` walks in this direction.
- From a text of the source to what it shapes: `Binding.holders` are the cells (or the argument)
  that it was bound to, once per macro call; their `readers` lead to records, a record with a cell
  or an argument for `sink` to the readers of that; the records whose `sink` is a list of elements
  are attributes that came out (`consumer[1]` is the name).

A block that is evaluated again shares the records of its first evaluation, so one record may have
made the same attribute of several elements; some of them may not have come out.
"""

from __future__ import annotations

from enum import Enum
from typing import TYPE_CHECKING, Any, Final, Protocol, TypeAlias

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from studio.description.faults import Fault
    from studio.description.syntax.source_tree import SourceElement, SourceText
    from studio.description.syntax.yaml_spans import KeyPath
    from studio.description.values import SiteKind


VALUES_KEPT: Final = 16
"""Limit for one binding."""

Consumer: TypeAlias = tuple[str, str]
"""An attribute that came out: (`link/visual/geometry/cylinder`, `radius`). A condition of
`xacro:if` is (`xacro:if`, `value`), the text of an element has the attribute ``."""


class Role(Enum):
    """Purpose of a text that makes neither output nor a binding."""

    CONDITION = "condition"
    """Whether something comes out at all."""
    STRUCTURE = "structure"
    """A name, a file, a flag: what it comes to decides what is evaluated next."""
    NOTHING = "nothing"
    """xacro evaluates it and leaves the value lying; it can still fail."""


class Readable:
    """Anything that an evaluated text can ask for."""

    __slots__ = ("readers",)

    def __init__(self) -> None:
        self.readers: list[Record] = []
        """Records that read it, once per read, in the order in which their evaluations ended."""


class Record:
    """One evaluation of one text in one scope, as it was in the run.

    `order` counts evaluations as they end, so whatever a record read has a lower one.
    """

    __slots__ = (
        "consumer",
        "file",
        "forwards",
        "is_noisy",
        "order",
        "reads",
        "scope",
        "sink",
        "text",
        "trigger",
        "value",
    )

    def __init__(
        self, text: str, scope: Scope, file: str, sink: Sink, consumer: Consumer | None
    ) -> None:
        self.text, self.scope, self.file = text, scope, file
        self.sink, self.consumer = sink, consumer
        self.reads: list[Readable] = []
        self.order: float = 0
        self.value: Any = None
        """Its value: of an attribute or a text as it is printed, else as evaluated."""
        self.trigger: Record | None = None
        """Of a property: the first reader, within whose evaluation this one took place."""
        self.forwards = False
        """`text` is a name that is passed on as it is (`:=^`)."""
        self.is_noisy = False
        """Whether it had an effect besides its value, such as a warning."""

    @property
    def counts(self) -> bool:
        """Whether it uses what it reads."""
        return self.sink is not Role.NOTHING

    @property
    def made(self) -> Cell | Argument | None:
        """The cell bound to it, when it is the text of a property, parameter or arg."""
        sink = self.sink
        if isinstance(sink, Readable):
            return sink  # pyright: ignore[reportReturnType] - the only readable sinks
        return None

    def __repr__(self) -> str:
        return f"{self.order}: {self.text!r} = {self.value!r}"


class MadeElement(Protocol):
    """An element that came out, as records know it: they made some of its attributes."""

    attributes: dict[str, str]
    makers: Mapping[str, Record]


Sink: TypeAlias = "Cell | Argument | SourceText | list[MadeElement] | Role"
"""The result of an evaluated text: a binding, the text of an element, attributes of elements."""


def behind(start: Record) -> Iterator[Readable]:
    """Yield all that a record was made from, the nearest first, each once."""
    seen: set[Readable] = set()
    front = list(start.reads)
    while front:
        found = [one for one in dict.fromkeys(front) if one not in seen]
        seen.update(found)
        yield from found
        front = [read for one in found for read in _reads_behind(one)]


def _reads_behind(one: Readable) -> list[Readable]:
    record: Record | None = getattr(one, "record", None)
    return record.reads if record is not None else []


class Cell(Readable):
    """One binding of one name in one scope; `pending` is a text that was not evaluated yet."""

    __slots__ = ("at", "binding", "name", "pending", "record", "resolving", "scope", "value")

    def __init__(
        self,
        name: str,
        scope: Scope,
        value: Any,  # noqa: ANN401
        binding: Binding | None = None,
        at: SourceElement | None = None,
    ) -> None:
        self.readers = []
        self.name, self.scope = name, scope
        self.value, self.binding, self.at = value, binding, at
        self.pending: str | None = None
        self.record: Record | None = None
        """The evaluation that its value comes from; None when it stands as it is written."""
        self.resolving = False
        if binding is not None:
            binding.holders.append(self)

    @property
    def is_lazy(self) -> bool:
        """Whether its text waits for the first reader."""
        return self.at is not None


class Argument(Readable):
    """One arg: its value, and the first declaration, once the run has reached it."""

    __slots__ = ("binding", "compared", "declarations", "is_given", "name", "record", "value")

    def __init__(self, name: str, value: str, *, is_given: bool) -> None:
        super().__init__()
        self.name, self.value, self.is_given = name, value, is_given
        self.binding: Binding | None = None
        self.record: Record | None = None
        """The evaluation of its default; None when it is given or stands as it is written."""
        self.compared: dict[str, None] = {}
        """As `Binding.compared`, from before its declaration."""
        self.declarations: list[Binding] = []
        """All declarations, those without effect too."""

    def declared_by(self, binding: Binding) -> None:
        """Note a declaration; the first one takes over what was noted so far."""
        if binding not in self.declarations:
            self.declarations.append(binding)
            binding.holders.append(self)
        if self.binding is None:
            binding.compared.update(self.compared)
            self.binding = binding


class NameReplay(Protocol):
    """Answers for the scopes while a text is evaluated once more."""

    def value_of(self, name: str, scope: Scope) -> Any:  # noqa: ANN401
        """Return the value now of what the name meant in the run."""
        ...

    def refuse(self, reason: str) -> None:
        """Raise: only a full run can evaluate it."""
        ...


class Resolver(Protocol):
    """Evaluates texts: the run that a scope belongs to."""

    symbols: dict[str, Any]
    helpers: dict[str, Any]
    is_pure: bool
    replay: NameReplay | None
    """Set while a text is evaluated once more: names mean what they meant the first time."""

    def read(self, name: str, cell: Cell, scope: Scope) -> Any:  # noqa: ANN401
        """Return the value of a cell, evaluated now if it was not, and note the read."""
        ...

    def undefined(self, name: str, scope: Scope) -> Fault:
        """Return the exception for a name that no scope has."""
        ...


class Scope:
    """Names of a file, a macro call or a `ns=` include; what it lacks its parent may have.

    A text is evaluated in the scope that holds it, at its first read; then the value stays.
    """

    __slots__ = ("_names", "cells", "included_by", "parent", "run")

    def __init__(
        self, run: Resolver, parent: Scope | None, included_by: SourceElement | None = None
    ) -> None:
        self.run, self.parent = run, parent
        self.included_by = included_by
        """The include whose `ns=` made it a namespace."""
        self.cells: dict[str, Cell] = {}
        self._names: _Names | None = None

    @property
    def is_namespace(self) -> bool:
        """Whether its names are read behind a `ns=`."""
        return self.included_by is not None

    @property
    def names(self) -> dict[str, Any]:
        """This scope as the globals of `eval`."""
        if self._names is None:
            self._names = _Names(self)
        return self._names

    def find(self, name: str) -> tuple[Cell, Scope] | None:
        """Return the cell of a name, and its scope; None for globals and unknown names."""
        scope: Scope | None = self
        while scope is not None:
            cell = scope.cells.get(name)
            if cell is not None:
                return cell, scope
            scope = scope.parent
        return None

    def has(self, name: str) -> bool:
        """Whether the name is bound here, above, or globally."""
        return self.find(name) is not None or name in self.run.symbols

    def value_of(self, name: str) -> Any:  # noqa: ANN401
        """Return the value of a name.

        Raises:
            Fault: It is not defined, or its text cannot be evaluated.
        """
        if self.run.replay is not None:
            return self.run.replay.value_of(name, self)
        scope: Scope | None = self
        while scope is not None:
            cell = scope.cells.get(name)
            if cell is not None:
                return scope.run.read(name, cell, scope)
            scope = scope.parent
        try:
            return self.run.symbols[name]
        except KeyError:
            raise self.run.undefined(name, self) from None

    def remove(self, name: str) -> None:
        """Forget a name here and in all scopes above."""
        scope: Scope | None = self
        while scope is not None:
            scope.cells.pop(name, None)
            scope = scope.parent

    def is_inside(self, other: Scope) -> bool:
        """Whether it is that scope, or has it above."""
        scope: Scope | None = self
        while scope is not None:
            if scope is other:
                return True
            scope = scope.parent
        return False

    def top(self) -> Scope:
        """Return the outermost scope: that of the opened file."""
        scope = self
        while scope.parent is not None:
            scope = scope.parent
        return scope

    def all_names(self) -> Iterator[str]:
        """Yield every name that can be read here, for hints."""
        scope: Scope | None = self
        while scope is not None:
            yield from scope.cells
            scope = scope.parent
        yield from self.run.symbols


class _Names(dict[str, Any]):
    """A scope for `eval`: Python asks it for every name that is none of the guarded helpers."""

    __slots__ = ("_scope",)

    def __init__(self, scope: Scope) -> None:
        super().__init__(scope.run.helpers)
        self._scope = scope

    def __missing__(self, name: str) -> Any:  # noqa: ANN401
        return self._scope.value_of(name)


class ScopeView(dict[str, Any]):
    """A `ns=` include inside expressions: `ns.name`."""

    __slots__ = ("scope",)

    def __init__(self, scope: Scope) -> None:
        super().__init__()
        self.scope = scope

    def __getattr__(self, name: str) -> Any:  # noqa: ANN401
        return self.scope.value_of(name)

    def __missing__(self, name: str) -> Any:  # noqa: ANN401
        return self.scope.value_of(name)

    def __contains__(self, name: object) -> bool:
        self.scope.run.is_pure = False  # it depends on the moment
        return isinstance(name, str) and self.scope.has(name)


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
        """Bound to it, in order: a cell per macro call, or the argument."""
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
    """Return a value as text; a container, perhaps a whole file, and others by their kind."""
    if isinstance(value, dict):
        return "{...}"
    if isinstance(value, list | tuple | set):
        return "[...]"
    if value is None or isinstance(value, str | int | float | complex):
        return str(value)
    return f"<{type(value).__name__}>"


class YamlValue(Readable, Input):
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
        self.values: dict[KeyPath, YamlValue] = {}
        self.whole: set[KeyPath] = set()
        self.loaded_by: list[SourceElement] = []
