"""A run that is watched: every call, every include, every text's value and the names it could read.

Made when somebody asks about a text, never while a value is dragged: an edit pays nothing for it.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final, NamedTuple, TypeAlias

from studio.description.evaluator.evaluation import Evaluation
from studio.description.evaluator.texts import Texts
from studio.description.faults import Fault, Unsupported
from studio.description.syntax.source_tree import SourceElement
from studio.description.syntax.templates import Cut

if TYPE_CHECKING:
    from collections.abc import Mapping

    from studio.description.evaluator.graph import Argument, Binding, Scope, YamlReads
    from studio.description.evaluator.macros import MacroTable
    from studio.description.evaluator.output_tree import Node, OutputElement
    from studio.description.evaluator.source_store import SourceStore
    from studio.description.expressions.bounds import Budget
    from studio.description.syntax.source_tree import SourceTree
    from studio.description.values import ReadPolicy

VALUES_KEPT: Final = 16
"""Values kept of one text at one element; further calls of a macro are not watched."""
CALLS_KEPT: Final = 200
INCLUDES_KEPT: Final = 2_000


class Evaluated(NamedTuple):
    """One evaluation of a `${...}` or `$(...)`: its value, and the names in scope."""

    value: Any
    scope: Scope


class Called(NamedTuple):
    """One call of a macro: its place, and the scope of its parameters."""

    element: SourceElement
    scope: Scope


class Included(NamedTuple):
    """A file that came in: by which element, and inside which other include, -1 for none."""

    element: SourceElement
    file: str
    scope: Scope
    inside: int


Segment: TypeAlias = tuple[SourceElement, Cut, str]


@dataclass(slots=True)
class Seen:
    """What was watched of a run."""

    evaluated: dict[Segment, list[Evaluated]] = field(
        default_factory=dict["Segment", "list[Evaluated]"]
    )
    calls: dict[SourceElement, list[Called]] = field(
        default_factory=dict["SourceElement", "list[Called]"]
    )
    """By the element of the macro, the first few."""
    call_counts: dict[SourceElement, int] = field(default_factory=dict["SourceElement", int])
    includes: list[Included] = field(default_factory=list[Included])


@dataclass(slots=True)
class Trace:
    """A finished run as it was watched; `trees` and `yaml` by resolved path, the entry first."""

    entry: str
    trees: Mapping[str, SourceTree]
    yaml: Mapping[str, YamlReads]
    root: OutputElement
    macros: MacroTable
    scope: Scope
    """The names of the entry file, as they were in the end."""
    arguments: Mapping[str, Argument]
    bindings: Mapping[tuple[SourceElement, str, str], Binding]
    seen: Seen


class WatchedTexts(Texts):
    """Texts that note the value of every segment."""

    def __init__(self, store: SourceStore, policy: ReadPolicy, budget: Budget, seen: Seen) -> None:
        super().__init__(store, policy, budget)
        self._seen = seen.evaluated

    def _segment(self, cut: Cut, text: str, scope: Scope) -> Any:  # noqa: ANN401
        value = super()._segment(cut, text, scope)
        if cut is not Cut.TEXT and self.at is not None:
            kept = self._seen.setdefault((self.at, cut, text), [])
            if len(kept) < VALUES_KEPT:
                kept.append(Evaluated(value, scope))
        return value


class WatchedRun(Evaluation):
    """One run; `trace` runs it."""

    def __init__(
        self, store: SourceStore, policy: ReadPolicy, arguments: Mapping[str, str]
    ) -> None:
        super().__init__(store, policy, arguments)
        self._seen = Seen()
        given = self.texts.arguments
        self._watched = WatchedTexts(store, policy, self.budget, self._seen)
        self._watched.arguments = given
        self.texts = self._watched
        self._around: list[SourceElement] = []
        """Include elements being evaluated."""
        self._include_numbers: list[int] = [-1]
        self._top: tuple[MacroTable, Scope] | None = None

    def trace(self, entry: str) -> Trace:
        """Run a file.

        Raises:
            Fault: It cannot be expanded, or not by us.
        """
        self.store.begin_run()
        try:
            root = self.run(entry)
        except Unsupported as unknown:
            raise Fault("not-watched", str(unknown)) from None
        assert self._top is not None
        macros, scope = self._top
        asked = tuple(self.store.asked)
        return Trace(
            entry=self.store.resolve(entry),
            trees=self.store.trees(asked),
            yaml=self.texts.yaml,
            root=root,
            macros=macros,
            scope=scope,
            arguments=self.texts.arguments,
            bindings=self.bindings,
            seen=self._seen,
        )

    def children(self, node: Node, out: OutputElement, macros: MacroTable, scope: Scope) -> None:
        """Evaluate all children of a node; the first time they are those of the entry file."""
        if self._top is None:
            self._top = macros, scope
        super().children(node, out, macros, scope)

    def element(self, node: Node, out: OutputElement, macros: MacroTable, scope: Scope) -> None:
        """Evaluate one element; of an include, note what comes in by it."""
        if node.tag != "xacro:include":
            super().element(node, out, macros, scope)
            return
        self._around.append(node.origin)
        around, depth = len(self._around), len(self._include_numbers)
        try:
            super().element(node, out, macros, scope)
        finally:  # an optional include may swallow the fault
            del self._include_numbers[depth:], self._around[around - 1 :]

    def echo_attributes(self, node: Node, scope: Scope) -> dict[str, str]:
        """Evaluate the attributes of a file's root or a macro: it begins to be evaluated now."""
        if isinstance(node, SourceElement):
            if node.parent is None and self._around:
                self._note_include(node, scope)
            elif node.tag == "xacro:macro" and self.frame is not None:
                self._note_call(node, self.frame.call, scope)
        return super().echo_attributes(node, scope)

    def _note_include(self, root: SourceElement, scope: Scope) -> None:
        # One element may bring several files, one after the other.
        del self._include_numbers[len(self._around) :]
        includes = self._seen.includes
        if len(includes) < INCLUDES_KEPT:
            includes.append(
                Included(self._around[-1], root.tree.path, scope, self._include_numbers[-1])
            )
            self._include_numbers.append(len(includes) - 1)
        else:
            self._include_numbers.append(-1)

    def _note_call(self, macro: SourceElement, call: SourceElement, scope: Scope) -> None:
        counts = self._seen.call_counts
        counts[macro] = counts.get(macro, 0) + 1
        kept = self._seen.calls.setdefault(macro, [])
        if len(kept) < CALLS_KEPT:
            kept.append(Called(call, scope))
