"""A thing that a text can name, and how a name is followed to it through the scopes of a run."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Final, cast

from studio.description.evaluator.graph import ScopeView
from studio.description.evaluator.yaml_values import origin_of
from studio.description.expressions.guards import text_of
from studio.description.expressions.symbols import Namespace
from studio.description.faults import Fault, shorten
from studio.description.language.questions import SubjectKind, TextPlace
from studio.description.values import SiteKind

if TYPE_CHECKING:
    from collections.abc import Iterable

    from studio.description.evaluator.graph import Cell, Scope
    from studio.description.language.uses import Chain, Key
    from studio.description.syntax.source_tree import SourceElement
    from studio.description.syntax.yaml_spans import KeyPath

MISSING: Final = object()
"""The value of what has none yet."""
_VALUE_LENGTH: Final = 120
_KINDS: Final = {
    SiteKind.PROPERTY: SubjectKind.PROPERTY,
    SiteKind.ARG: SubjectKind.ARG,
    SiteKind.PARAM_DEFAULT: SubjectKind.PARAMETER,
}


@dataclass(frozen=True, slots=True)
class Subject:
    """A thing named at a place; [start, end) is its name there, in characters of the text."""

    kind: SubjectKind
    name: str
    start: int = 0
    end: int = 0
    elements: tuple[SourceElement, ...] = ()
    """Elements of the run that define it; of a parameter its macro's, or calls of that."""
    values: tuple[str, ...] = ()
    places: tuple[TextPlace, ...] = ()
    """Where it is defined, unless it has `elements`."""
    yaml: tuple[str, KeyPath] | None = None
    """File and key path of a YAML value."""
    target: str = ""
    """The file or folder that it is."""

    @property
    def key(self) -> Key:
        """The last name or key by which expressions read it."""
        if self.yaml and self.yaml[1]:
            return self.yaml[1][-1]
        return self.name


def printed(value: Any) -> str:  # noqa: ANN401
    """Return a value as xacro prints it, for one line."""
    if isinstance(value, dict):
        return "{...}"
    try:
        return shorten(text_of(value), _VALUE_LENGTH)
    except Fault:
        return "[...]"


def distinct(values: Iterable[Any]) -> tuple[str, ...]:
    """Values as printed, each once."""
    return tuple(dict.fromkeys(printed(value) for value in values))


@dataclass(frozen=True, slots=True)
class Found:
    """The meaning of one chain of names in one scope."""

    kind: SubjectKind
    name: str
    value: Any = MISSING
    elements: tuple[SourceElement, ...] = ()
    yaml: tuple[str, KeyPath] | None = None


def found_in(scope: Scope, chain: Chain) -> Found | None:
    """Follow a chain of names from a scope; None when it leads nowhere."""
    pair = scope.find(chain.base)
    found = found_of(chain.base, pair[0]) if pair else _symbol(chain.base, scope)
    for key in chain.keys:
        if found is None:
            return None
        found = _below(found, key)
    return found


def found_of(name: str, cell: Cell) -> Found:
    """Return what a cell is."""
    value = cell.value if cell.pending is None else MISSING
    if isinstance(value, ScopeView):
        return Found(SubjectKind.NAMESPACE, name, value, _bringing(value))
    binding = cell.binding
    if binding is None:
        return Found(SubjectKind.PROPERTY, name, value, (cell.at,) if cell.at else ())
    kind = SubjectKind.PARAMETER if binding.kind is None else _KINDS[binding.kind]
    return Found(kind, name, value, (binding.element,), origin_of(value))


def _bringing(view: ScopeView) -> tuple[SourceElement, ...]:
    """Return the include that a namespace comes from."""
    element = view.scope.included_by
    return (element,) if element is not None else ()


def _symbol(name: str, scope: Scope) -> Found | None:
    symbols = scope.run.symbols
    return _exposed(name, symbols[name]) if name in symbols else None


def _exposed(name: str, value: Any) -> Found:  # noqa: ANN401
    """Return one of the names that every expression has."""
    kind = SubjectKind.FUNCTION if callable(value) else SubjectKind.CONSTANT
    return Found(kind, name, value)


def _below(found: Found, key: Key) -> Found | None:
    """Return what `.key` or `[key]` means behind what was found."""
    value = found.value
    if isinstance(value, ScopeView):
        pair = value.scope.find(str(key))
        return found_of(str(key), pair[0]) if pair else None
    if isinstance(value, Namespace):
        name = str(key)
        return _exposed(name, value[name]) if name in value else None
    inside = _item(value, key)
    if inside is MISSING:
        return None
    if found.yaml is None:
        return Found(SubjectKind.VALUE, str(key), inside)
    file, path = found.yaml
    return Found(SubjectKind.YAML, str(key), inside, (), (file, (*path, key)))


def _item(value: Any, key: Key) -> Any:  # noqa: ANN401
    """Return an item of a container, without noting it as a read."""
    if isinstance(value, dict):
        return _raw_items(cast("dict[Any, Any]", value)).get(key, MISSING)
    if isinstance(value, list) and isinstance(key, int):
        items: list[Any] = list(cast("Any", list).__iter__(value))
        return items[key] if -len(items) <= key < len(items) else MISSING
    return MISSING


def _raw_items(value: dict[Any, Any]) -> dict[Any, Any]:
    return dict(cast("Any", dict).items(value))


def subject_of(founds: Iterable[Found | None]) -> Subject | None:
    """Return what was found in several scopes as one subject, of the kind of the first."""
    there = [found for found in founds if found is not None]
    if not there:
        return None
    first = there[0]
    alike = [found for found in there if found.kind == first.kind]
    shown = [found.value for found in alike if found.value is not MISSING]
    if first.kind in {SubjectKind.NAMESPACE, SubjectKind.FUNCTION}:
        shown = []
    elements = dict.fromkeys(element for found in alike for element in found.elements)
    values = () if isinstance(first.value, Namespace) else distinct(shown)
    subject = Subject(first.kind, first.name, elements=tuple(elements), values=values)
    return replace(subject, yaml=first.yaml if first.kind is SubjectKind.YAML else None)


def keys_below(found: Found) -> list[tuple[str, Any]]:
    """Return names that can be read behind what was found, with their values."""
    value = found.value
    if isinstance(value, ScopeView):
        cells = value.scope.cells.items()
        return [(name, cell.value) for name, cell in cells if not name.startswith("*")]
    if isinstance(value, dict):
        items = _raw_items(cast("dict[Any, Any]", value))
        return [(key, inside) for key, inside in items.items() if isinstance(key, str)]
    return []
