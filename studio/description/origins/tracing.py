"""A run that notes for each thing that comes out which texts it was made of.

The graph of the run that feeds the view belongs to the edits, which change it, and elements of a
block that comes out twice share a record there. This run is made for questions, and stays as it
is: of each output attribute it keeps what it read when it was made, and which conditions, calls
and blocks it came out by. It sees only texts that made a good run before.
"""

from __future__ import annotations

from contextlib import contextmanager
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any, Final, NamedTuple, TypeAlias

from studio.description.evaluator.evaluation import Evaluation
from studio.description.evaluator.graph import Argument, Binding, Cell, Input, YamlValue
from studio.description.evaluator.output_tree import OutputElement
from studio.description.evaluator.texts import Texts
from studio.description.evaluator.yaml_values import Reader, wrap
from studio.description.expressions.bounds import Limits
from studio.description.sites.file_sites import yaml_sites
from studio.description.sites.sites import path_as_written
from studio.description.syntax.source_tree import SourceText
from studio.description.values import SiteKind

if TYPE_CHECKING:
    from collections.abc import Generator, Iterator, Mapping

    from studio.description.evaluator.graph import Record, Scope, YamlReads
    from studio.description.evaluator.macros import MacroTable
    from studio.description.evaluator.output_tree import CallFrame, Node
    from studio.description.evaluator.source_store import SourceStore
    from studio.description.expressions.bounds import Budget
    from studio.description.sites.file_sites import FileSite
    from studio.description.syntax.source_tree import SourceElement
    from studio.description.syntax.yaml_spans import KeyPath
    from studio.description.values import ReadPolicy
    from studio.problems import Place

Inputs: TypeAlias = "tuple[Input, ...]"
_GOVERNING: Final = frozenset(
    {"xacro:if", "xacro:unless", "xacro:include", "xacro:call", "xacro:element", "xacro:property"}
)
"""What these read decides whether their content exists, or what it is."""
_LIMITS: Final = Limits(seconds=6.0)
"""Noting takes time, too: what ran within its time must not end here for that."""


class TracedBinding(Binding):
    """One name bound once, for example by one macro call. `inputs` are those its text read."""

    __slots__ = ("inputs",)

    def __init__(
        self, kind: SiteKind | None, name: str, element: SourceElement, attribute: str, text: str
    ) -> None:
        super().__init__(kind, name, element, attribute, text)
        self.inputs: Inputs = ()


class Given(Input):
    """An arg that is passed from outside and declared nowhere, or not yet."""

    __slots__ = ("name", "value")

    def __init__(self, name: str, value: str) -> None:
        super().__init__()
        self.name, self.value = name, value


class Governor(Input):
    """A condition, include or the like, by whose texts everything inside it came to be there."""

    __slots__ = ("element", "inputs", "outer")

    def __init__(self, element: SourceElement, outer: Governor | None) -> None:
        super().__init__()
        self.element, self.outer = element, outer
        self.inputs: Inputs = ()

    def is_decided_by(self, path: str, name: str) -> bool:
        """Whether a text that was consumed is its own: `path` and `name` as of a `Consumer`."""
        return path == self.element.tag or name == "xacro:name"

    @property
    def own_inputs(self) -> Inputs:
        """Its own inputs, without those of the elements around it."""
        return tuple(one for one in self.inputs if not isinstance(one, Governor))


class Written(NamedTuple):
    """The text that an output attribute is made of: where it stands and what it read."""

    element: SourceElement
    attribute: str
    inputs: Inputs


class Called(NamedTuple):
    """One call of a macro: where the macro is written, and what each parameter was bound to."""

    macro: SourceElement
    parameters: Mapping[str, Binding]


class TracedAttributes(dict[str, str]):
    """Attributes that came out, and how those that have a `$` in their text were made."""

    __slots__ = ("written",)

    def __init__(self, values: Mapping[str, str], written: Mapping[str, Written]) -> None:
        super().__init__(values)
        self.written = {name: one for name, one in written.items() if name in values}


class _Reader(Reader):
    """A container that is read whole counts as an input itself."""

    __slots__ = ()

    def touch_all(self, path: KeyPath) -> None:
        super().touch_all(path)
        self.touch(path)


class _TracedTexts(Texts):
    """Keeps what each text read. `governor` is the innermost around the element worked on."""

    def __init__(self, store: SourceStore, policy: ReadPolicy, budget: Budget) -> None:
        super().__init__(store, policy, budget)
        self.governor: Governor | None = None
        self.given: dict[Argument, Given] = {}
        self.was_read: dict[str, Inputs] = {}
        """Inputs of the attributes evaluated last, by name."""

    def ended(self, record: Record) -> None:
        """As in any run; the inputs are kept for the element made of them."""
        super().ended(record)
        inputs = tuple(dict.fromkeys(self._inputs(record)))
        made = record.made
        if made is not None and isinstance(made.binding, TracedBinding):
            made.binding.inputs += inputs
        if record.consumer is None:
            return
        path, name = record.consumer
        if self.governor is not None and self.governor.is_decided_by(path, name):
            self.governor.inputs += inputs
        self.was_read[name] = inputs

    def _inputs(self, record: Record) -> Iterator[Input]:
        """Yield what a text read, as inputs; a file that it opened is none."""
        for one in record.reads:
            if isinstance(one, YamlValue):
                yield one
            elif isinstance(one, Argument) and one.binding is None:
                yield self.given.setdefault(one, Given(one.name, one.value))
            elif isinstance(one, Cell | Argument) and one.binding is not None:
                yield one.binding

    def load_yaml(self, path: str) -> Any:  # noqa: ANN401
        """As in any run, but a value that is read whole is noted as read."""
        super().load_yaml(path)
        real, _, values = self.store.yaml(self.absolute(path), str)  # is known by now
        return wrap(values, _Reader(self.yaml[real], self.note), ())


class TracedEvaluation(Evaluation):
    """A run whose output elements can be asked what they were made of."""

    def __init__(
        self, store: SourceStore, policy: ReadPolicy, arguments: Mapping[str, str]
    ) -> None:
        super().__init__(store, policy, arguments, _LIMITS)
        self.traced = _TracedTexts(store, policy, self.budget)
        self.texts = self.traced
        self.texts.arguments = {
            name: Argument(name, text, is_given=True) for name, text in arguments.items()
        }
        self.made: list[TracedBinding] = []
        self.calls: dict[CallFrame, Called] = {}
        self.governors: dict[OutputElement, Governor] = {}
        """What decides whether an element exists, for those that depend on anything."""
        self.text_inputs: dict[SourceText, Inputs] = {}
        self.decisions: list[Governor] = []
        self._defined_under: dict[SourceElement, Governor] = {}

    def binding(
        self, kind: SiteKind | None, name: str, element: SourceElement, attribute: str, text: str
    ) -> Binding:
        """Return a binding of its own for each time that a name is bound."""
        made = TracedBinding(kind, name, element, attribute, text)
        if governor := self._governor():
            made.inputs = (governor,)
        self.made.append(made)
        return made

    def attributes(self, node: Node, made: OutputElement, scope: Scope) -> None:
        """Evaluate a node's attributes and note what each read."""
        self.traced.was_read = {}
        super().attributes(node, made, scope)
        before = node.attributes.written if isinstance(node.attributes, TracedAttributes) else {}
        if not (self.traced.was_read or before):
            return
        read = self.traced.was_read.items()
        written = {name: Written(node.origin, name, inputs) for name, inputs in read}
        made.attributes = TracedAttributes(made.attributes, {**before, **written})

    def children(self, node: Node, out: OutputElement, macros: MacroTable, scope: Scope) -> None:
        """Evaluate all children; those of a macro's body owe it also to what defined the macro."""
        if self.frame is None or self.frame in self.calls:
            super().children(node, out, macros, scope)
            return
        cells = scope.cells.items()
        bound = {name: one.binding for name, one in cells if one.binding}
        self.calls[self.frame] = Called(node.origin, bound)
        governor = self._defined_under.get(node.origin)
        with self._governed(node.origin, (governor,) if governor else ()):
            super().children(node, out, macros, scope)

    def element(self, node: Node, out: OutputElement, macros: MacroTable, scope: Scope) -> None:
        """Evaluate one element; what decides about others governs them."""
        if node.tag == "xacro:attribute":
            self._set_attribute(node, out, macros, scope)
        elif node.tag in _GOVERNING:
            with self._governed(node.origin, ()):
                super().element(node, out, macros, scope)
        else:
            if node.tag == "xacro:macro" and (governor := self._governor()):
                self._defined_under[node.origin] = governor
            super().element(node, out, macros, scope)

    def ordinary(self, node: Node, out: OutputElement, macros: MacroTable, scope: Scope) -> None:
        """An element of the robot itself, and what it owes its being there to."""
        super().ordinary(node, out, macros, scope)
        made = out.children[-1]
        assert isinstance(made, OutputElement)
        owed = self.governors.get(node) if isinstance(node, OutputElement) else None
        governor = self._governor()
        if owed is not None and owed is not governor:
            both = Governor(node.origin, governor)  # a block: what put it in, and what it came by
            both.inputs, governor = (owed,), both
        if governor is not None:
            self.governors[made] = governor

    def _set_attribute(
        self, node: Node, out: OutputElement, macros: MacroTable, scope: Scope
    ) -> None:
        before = out.attributes
        self.traced.was_read = {}
        super().element(node, out, macros, scope)
        read = self.traced.was_read
        name = node.attributes["name"]
        if "$" in name:
            name = next((n for n, v in out.attributes.items() if before.get(n) != v), "")
        written = dict(before.written) if isinstance(before, TracedAttributes) else {}
        inputs = tuple(dict.fromkeys(one for inputs in read.values() for one in inputs))
        written[name] = Written(node.origin, "value", inputs)
        out.attributes = TracedAttributes(out.attributes, written)

    def _text(self, node: SourceText, out: OutputElement, scope: Scope) -> bool:
        self.traced.was_read = {}
        solid = super()._text(node, out, scope)
        made = out.children[-1]
        if "" in self.traced.was_read and isinstance(made, SourceText):
            self.text_inputs[made] = self.traced.was_read[""]
        return solid

    def _governor(self) -> Governor | None:
        """Return the governor of the current element; one that read nothing decides nothing."""
        governor = self.traced.governor
        while governor is not None and not governor.inputs:
            governor = governor.outer
        return governor

    @contextmanager
    def _governed(self, element: SourceElement, also: Inputs) -> Generator[None]:
        before = self.traced.governor
        outer = self._governor()
        self.traced.governor = Governor(element, outer)
        self.traced.governor.inputs += also
        try:
            yield
        finally:
            if self.traced.governor.inputs:
                self.decisions.append(self.traced.governor)
            self.traced.governor = before


@dataclass(frozen=True, slots=True)
class Trace:
    """A run that can be asked."""

    root: OutputElement
    bindings: tuple[TracedBinding, ...]
    calls: Mapping[CallFrame, Called]
    governors: Mapping[OutputElement, Governor]
    """What decides whether an element exists, for those that depend on anything."""
    decisions: tuple[Governor, ...]
    """All governors that read anything, also those without output."""
    text_inputs: Mapping[SourceText, Inputs]
    yaml: Mapping[str, YamlReads]
    included_at: Mapping[str, Place]
    """Where each file was included first."""


def trace(
    store: SourceStore, policy: ReadPolicy, entry: str, arguments: Mapping[str, str]
) -> Trace:
    """Run the texts of a store, which ran well before.

    Raises:
        Fault: They cannot be expanded after all: a file beside them changed.
    """
    run = TracedEvaluation(store, policy, arguments)
    root = run.run(entry)
    return Trace(
        root,
        tuple(run.made),
        run.calls,
        run.governors,
        tuple(run.decisions),
        run.text_inputs,
        run.texts.yaml,
        run.included_at,
    )


def inputs_of(one: Input) -> Inputs:
    """Return the inputs of something named; a value of a YAML file has none."""
    if isinstance(one, Governor):
        return (*one.inputs, one.outer) if one.outer else one.inputs
    return one.inputs if isinstance(one, TracedBinding) else ()


def written_at(element: OutputElement, attribute: str) -> Written | None:
    """Return the text that an attribute was made of; None when it is in no source."""
    attributes = element.attributes
    if isinstance(attributes, TracedAttributes) and attribute in attributes.written:
        return attributes.written[attribute]
    if attribute in element.origin.attributes:
        return Written(element.origin, attribute, ())
    return None


def site_of_binding(binding: TracedBinding) -> str:
    """Id of the text of a binding, were it one that can be edited; empty for what never is."""
    start = f"{binding.element.tree.path}#{binding.element.ordinal}@"
    match binding.kind:
        case None:
            return ""
        case SiteKind.PARAM_DEFAULT:
            return f"{start}params:{binding.name}"
        case _:
            return start + binding.attribute


class YamlSites:
    """The scalars of the YAML files that a traced run read."""

    def __init__(self, yaml: Mapping[str, YamlReads]) -> None:
        self._yaml = yaml
        self._files: dict[str, _YamlFile] = {}

    def site_of(self, scalar: YamlValue) -> FileSite | None:
        """Return where a value that was read is written; None for a mapping or a list."""
        file = self._file(scalar.document)
        return file.sites.get(path_as_written(scalar.path, file.written, file.aliases))

    def inputs_by_site(self) -> Iterator[tuple[str, Input]]:
        """Yield every scalar that was read, itself or with all that stands around it."""
        for path, reads in self._yaml.items():
            file = self._file(path)
            whole = {path_as_written(one, file.written, file.aliases) for one in reads.whole}
            for scalar in reads.values.values():
                at = path_as_written(scalar.path, file.written, file.aliases)
                if at in file.sites:
                    yield file.sites[at].id, scalar
                elif at in whole:
                    yield from ((one.id, scalar) for one in file.below(at))

    def _file(self, path: str) -> _YamlFile:
        if path not in self._files:
            self._files[path] = _yaml_file(path, self._yaml[path].data)
        return self._files[path]


class _YamlFile:
    """The sites of one file by key path."""

    def __init__(self, path: str, data: bytes) -> None:
        found = yaml_sites(path, data)
        self.sites = {site.path: site for site in found.sites}
        self.written = set(self.sites)
        self.aliases = dict(found.aliases)

    def below(self, path: KeyPath) -> Iterator[FileSite]:
        return (one for at, one in self.sites.items() if at[: len(path)] == path)


@lru_cache(maxsize=64)
def _yaml_file(path: str, data: bytes) -> _YamlFile:
    """Drafting takes longer than the run: unchanged bytes are not found again."""
    return _YamlFile(path, data)


def inputs_by_site(trace: Trace) -> dict[str, list[Input]]:
    """Return what was read of each text that has a name or a key path, by the text's site id."""
    found: dict[str, list[Input]] = {}
    for binding in trace.bindings:
        if site := site_of_binding(binding):
            found.setdefault(site, []).append(binding)
    for site, scalar in YamlSites(trace.yaml).inputs_by_site():
        found.setdefault(site, []).append(scalar)
    return found
