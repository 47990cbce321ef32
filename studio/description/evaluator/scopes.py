"""Names and what they are bound to: chains of scopes, as dynamic as xacro's."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

from studio.description.evaluator.graph import Readable
from studio.description.faults import Fault

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.description.evaluator.graph import Record
    from studio.description.evaluator.run_record import Binding
    from studio.description.syntax.source_tree import SourceElement


class Cell(Readable):
    """One binding of one name in one scope; `pending` is a text that nobody has read yet."""

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


class Replay(Protocol):
    """Answers for the scopes while a text is evaluated once more."""

    def value_of(self, name: str, scope: Scope) -> Any:  # noqa: ANN401
        """The value now of what the name meant in the run."""
        ...

    def refuse(self, reason: str) -> None:
        """Give up: only a full run can tell."""
        ...


class Resolver(Protocol):
    """Who evaluates: the run that a scope belongs to."""

    symbols: dict[str, Any]
    helpers: dict[str, Any]
    is_pure: bool
    replay: Replay | None
    """Set while a text is evaluated once more: names mean what they meant the first time."""

    def read(self, name: str, cell: Cell, scope: Scope) -> Any:  # noqa: ANN401
        """The value of a cell, evaluated now if nobody did; noted as read."""
        ...

    def undefined(self, name: str, scope: Scope) -> Fault:
        """What to raise for a name that no scope has."""
        ...


class Scope:
    """Names of a file, a macro call or a `ns=` include; what it lacks its parent may have.

    A text is evaluated in the scope that holds it, at its first read; then the value stays.
    """

    __slots__ = ("_names", "cells", "is_namespace", "parent", "run")

    def __init__(self, run: Resolver, parent: Scope | None, *, is_namespace: bool = False) -> None:
        self.run, self.parent, self.is_namespace = run, parent, is_namespace
        self.cells: dict[str, Cell] = {}
        self._names: _Names | None = None

    @property
    def names(self) -> dict[str, Any]:
        """This scope as the globals of `eval`."""
        if self._names is None:
            self._names = _Names(self)
        return self._names

    def find(self, name: str) -> tuple[Cell, Scope] | None:
        """The cell that a name means here, and its scope; None for globals and unknown names."""
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
        """The value of a name.

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
        """The outermost scope: that of the opened file."""
        scope = self
        while scope.parent is not None:
            scope = scope.parent
        return scope

    def all_names(self) -> Iterator[str]:
        """Every name that can be read here, for hints."""
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


class Namespace(dict[str, Any]):
    """A fixed set of names inside expressions: `math.pi`."""

    __slots__ = ()

    def __getattr__(self, name: str) -> Any:  # noqa: ANN401
        try:
            return self[name]
        except KeyError:
            raise NameError(f"name '{name}' is not defined") from None


def literal_value(value: Any) -> Any:  # noqa: ANN401
    """Type a text as xacro does when it binds one: int, float, bool, quoted text, else as it is."""
    if not isinstance(value, str):
        return value
    if len(value) >= 2 and value[0] == value[-1] == "'":
        return value[1:-1]
    if "_" in value:  # Python would read 1_000 as a number
        return value
    for read in (int, float):
        try:
            return read(value)
        except ValueError:
            continue
    return {"true": True, "True": True, "false": False, "False": False}.get(value, value)


def truth_of(value: Any, condition: str | None) -> bool:  # noqa: ANN401
    """What a condition came to, by xacro's rules.

    Raises:
        Fault: A text that is neither true, false nor a whole number.
    """
    if not isinstance(value, str):
        return bool(value)
    if value in {"true", "True"}:
        return True
    if value in {"false", "False"}:
        return False
    try:
        return bool(int(value))
    except ValueError:
        sentence = f'"{condition}" came to "{value}", which is neither true nor false.'
        raise Fault("not-a-condition", sentence) from None
