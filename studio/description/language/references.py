"""All places in the files of a run that name a thing: its definitions, its readers, its calls."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from studio.description.language.meaning import places_of
from studio.description.language.named_files import existing
from studio.description.language.questions import Reference, References, TextPlace
from studio.description.language.questions import SubjectKind as Kind
from studio.description.language.subject import found_in
from studio.description.language.uses import Chain, Use, uses_in
from studio.description.language.words import FILE_ATTRIBUTES, PART_REFERENCES
from studio.description.syntax.attribute_spans import attribute_spans
from studio.description.syntax.params import read_parameters
from studio.description.syntax.templates import Cut
from studio.errors import EditError

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from studio.description.language.definitions import Definitions
    from studio.description.language.reading import Reading
    from studio.description.language.subject import Found, Subject
    from studio.description.syntax.source_tree import SourceElement, SourceTree

REFERENCES_SHOWN: Final = 1_000
_SCOPED: Final = frozenset({Kind.PROPERTY, Kind.PARAMETER, Kind.NAMESPACE, Kind.YAML, Kind.BLOCK})


@dataclass(frozen=True, slots=True)
class Spot:
    """Bytes of a file of the run that name the thing."""

    file: str
    start: int
    end: int
    in_run: bool = True


class UsesBook:
    """The uses of each file, searched once per text."""

    def __init__(self) -> None:
        self._known: dict[str, tuple[SourceTree, tuple[Use, ...]]] = {}

    def of(self, tree: SourceTree) -> tuple[Use, ...]:
        """Return the uses of one file."""
        known = self._known.get(tree.path)
        if known is None or known[0] is not tree:
            known = self._known[tree.path] = tree, uses_in(tree)
        return known[1]


def references_to(subject: Subject, reading: Reading, book: UsesBook) -> References:
    """Return where a subject is named; definitions count too."""
    definitions = reading.definitions
    spots = list(spots_of(subject, definitions, reading, book)) if definitions else []
    defined = places_of(subject, reading)
    found = {place: _reference(place, reading, is_definition=True) for place in defined}
    for spot in spots:
        place = reading.place(spot.file, spot.start, spot.end)
        if place not in found:
            found[place] = _reference(place, reading, in_run=spot.in_run)
    ordered = sorted(found.values(), key=lambda one: _order(one.place))
    return References(subject.kind, subject.name, tuple(ordered[:REFERENCES_SHOWN]), len(ordered))


def _order(place: TextPlace) -> tuple[str, int, int]:
    return place.file, place.line, place.column


def _reference(
    place: TextPlace, reading: Reading, *, is_definition: bool = False, in_run: bool = True
) -> Reference:
    return Reference(place, reading.places(place.file).line(place.line), is_definition, in_run)


def spots_of(
    subject: Subject, definitions: Definitions, reading: Reading, book: UsesBook
) -> Iterator[Spot]:
    """Yield the places that name a subject beside those that define it; one may come twice."""
    trees = definitions.trace.trees.values()
    if subject.kind in _SCOPED:
        yield from _reads(subject, definitions, book)
    if subject.kind in {Kind.PARAMETER, Kind.BLOCK}:
        yield from _given(subject, definitions)
    if subject.kind is Kind.ARG:
        yield from _commands(trees, book, subject.name, ("arg", "eval"))
    if subject.kind is Kind.PACKAGE:
        yield from _commands(trees, book, subject.name, ("find",))
    if subject.kind is Kind.ENVIRONMENT:
        yield from _commands(trees, book, subject.name, ("env", "optenv"))
    if subject.kind is Kind.MACRO:
        yield from _calls(subject, definitions)
    if subject.kind in {Kind.LINK, Kind.JOINT}:
        yield from _parts(subject, definitions)
    if subject.kind is Kind.FILE:
        yield from _files(subject, definitions, reading)


def _commands(
    trees: Iterable[SourceTree], book: UsesBook, name: str, commands: tuple[str, ...]
) -> Iterator[Spot]:
    for tree in trees:
        for use in book.of(tree):
            if use.name == name and use.command in commands:
                yield Spot(tree.path, use.starts[0], use.ends[0])


def _reads(subject: Subject, definitions: Definitions, book: UsesBook) -> Iterator[Spot]:
    """Expressions that read a property, parameter, namespace or YAML key."""
    for tree in definitions.trace.trees.values():
        for use in book.of(tree):
            if use.command or use.chain is None or use.chain.is_local:
                continue
            for step, one in enumerate(use.chain.steps, 1):
                if one.key != subject.key:
                    continue
                read = Chain(use.chain.steps[:step])
                in_run = _is_read(subject, use, read, definitions)
                if in_run is not None:
                    yield Spot(tree.path, use.starts[step - 1], use.ends[step - 1], in_run)


def _is_read(subject: Subject, use: Use, chain: Chain, definitions: Definitions) -> bool | None:
    """Whether a chain means it; None: it does not; False: it may, but the run never came by."""
    found = meant_by(use, chain, definitions)
    if found:
        return True if any(_means(one, subject, definitions) for one in found) else None
    if len(chain.steps) > 1 or subject.kind is Kind.YAML:
        return None
    macro = macro_around(use.element)
    names = read_parameters(macro.attributes.get("params", ""))[0] if macro else ()
    if subject.kind in {Kind.PARAMETER, Kind.BLOCK}:
        return False if macro in subject.elements else None
    return None if chain.base in names else False


def meant_by(use: Use, chain: Chain, definitions: Definitions) -> list[Found]:
    """Return what the chain meant, each time that its text was evaluated."""
    seen = definitions.trace.seen
    places = [use.element]
    if use.element.tag == "xacro:macro":  # defaults are evaluated where the macro is called
        places = [call.element for call in seen.calls.get(use.element, ())]
    evaluated = (
        one
        for place in places
        for one in seen.evaluated.get((place, Cut.EXPRESSION, use.segment), ())
    )
    found = (found_in(one.scope, chain) for one in evaluated)
    return [one for one in found if one is not None]


def _means(found: Found, subject: Subject, definitions: Definitions) -> bool:
    if subject.kind is Kind.YAML:
        return found.yaml == subject.yaml
    defined: set[SourceElement] = set()
    for element in found.elements:
        macros = definitions.called.get(element, ()) if found.kind is Kind.PARAMETER else ()
        defined.update(macros or (element,))
    return not defined.isdisjoint(subject.elements)


def macro_around(element: SourceElement) -> SourceElement | None:
    """Return the macro that an element stands in or is."""
    above: SourceElement | None = element
    while above is not None and above.tag != "xacro:macro":
        above = above.parent
    return above


def _given(subject: Subject, definitions: Definitions) -> Iterator[Spot]:
    """Calls that give a parameter, and `insert_block` of a block."""
    for element in callers_of(subject, definitions):
        if subject.name in element.attributes:
            in_run = element in definitions.called
            yield from attribute_name(element, subject.name, in_run=in_run)
    for tree in definitions.trace.trees.values():
        for element in tree.elements:
            is_insert = element.tag == "xacro:insert_block"
            if is_insert and element.attributes.get("name") == subject.name:
                macro = macro_around(element)
                if macro in subject.elements or _is_block_property(subject):
                    yield from attribute_value(element, "name")


def callers_of(subject: Subject, definitions: Definitions) -> Iterator[SourceElement]:
    """Elements that call a macro of the subject, or would if the run came by."""
    names = {macro.attributes.get("name", "") for macro in subject.elements}
    for tree in definitions.trace.trees.values():
        for element in tree.elements:
            called = definitions.called.get(element)
            if called is None:
                own = element.tag.removeprefix("xacro:")
                is_call = own != element.tag and own.rpartition(".")[2] in names
            else:
                is_call = not set(called).isdisjoint(subject.elements)
            if is_call:
                yield element


def _is_block_property(subject: Subject) -> bool:
    return any(one.tag == "xacro:property" for one in subject.elements)


def _calls(subject: Subject, definitions: Definitions) -> Iterator[Spot]:
    """Yield calls of a macro: the names of their tags, or the values of `xacro:call`."""
    for element in callers_of(subject, definitions):
        if element.tag == "xacro:call":
            yield from attribute_value(element, "macro")
            continue
        start = element.offset + 1
        end = start + len(element.tag.encode())
        yield Spot(element.tree.path, start, end, element in definitions.called)


def _parts(subject: Subject, definitions: Definitions) -> Iterator[Spot]:
    """Attributes that come out as the name of a link or joint."""
    for element in definitions.outputs:
        for (tag, attribute), kind in PART_REFERENCES.items():
            if element.tag != tag or kind != subject.kind.value:
                continue
            if subject.name in definitions.written_out(element, attribute):
                yield from attribute_value(element, attribute)


def _files(subject: Subject, definitions: Definitions, reading: Reading) -> Iterator[Spot]:
    """Includes that brought a file in, and meshes and textures that it is."""
    for one in definitions.trace.seen.includes:
        if one.file == subject.target:
            yield from attribute_value(one.element, "filename")
    for element in definitions.outputs:
        for tag, attribute in FILE_ATTRIBUTES:
            if element.tag != tag:
                continue
            texts = definitions.written_out(element, attribute)
            if any(existing(reading, text, element.tree.path) == subject.target for text in texts):
                yield from attribute_value(element, attribute)


def attribute_value(element: SourceElement, attribute: str) -> Iterator[Spot]:
    """Yield the value of an attribute."""
    try:
        span = attribute_spans(element.tree.data, element.offset)[attribute]
    except (EditError, KeyError):
        return
    yield Spot(element.tree.path, span.start, span.end)


def attribute_name(
    element: SourceElement, attribute: str, *, in_run: bool = True
) -> Iterator[Spot]:
    """Yield the name of an attribute: it stands before its value, its `=` and its quote."""
    tree = element.tree
    for spot in attribute_value(element, attribute):
        start = tree.data.rfind(attribute.encode(tree.encoding), element.offset, spot.start)
        if start >= 0:
            yield Spot(tree.path, start, start + len(attribute.encode(tree.encoding)), in_run)
