"""Renames a property, arg, macro, parameter or block.

Every renaming is tried first: the robot is run with the new name, and has to come out the same.
"""

from __future__ import annotations

import keyword
import re
from typing import TYPE_CHECKING, Final

from studio.description.evaluator.output_tree import write_xml
from studio.description.language.definitions import parameter_bytes
from studio.description.language.name_group import (
    NameGroup,
    called_name,
    has_parameter,
    is_name_group,
)
from studio.description.language.questions import RenamedPlace, Renaming
from studio.description.language.questions import SubjectKind as Kind
from studio.description.language.references import (
    Spot,
    attribute_name,
    attribute_value,
    macro_around,
)
from studio.description.language.words import XACRO_TAGS
from studio.description.syntax.params import read_parameters
from studio.errors import EditError

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from studio.description.language.definitions import Definitions
    from studio.description.language.reading import Reading
    from studio.description.language.references import UsesBook
    from studio.description.language.subject import Subject
    from studio.description.language.uses import Use
    from studio.description.syntax.source_tree import SourceElement, SourceTree

_CALLED = re.compile(rb"\s*\(")
_GIVEN = re.compile(rb"\s*\(\s*(?:'([^']*)'|\"([^\"]*)\"|&quot;(.*?)&quot;|&apos;(.*?)&apos;)\s*\)")
NAME_LIMIT: Final = 200
_IDENTIFIER: Final = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
_TAG: Final = re.compile(r"[A-Za-z_][A-Za-z0-9_-]*")
_PIECES: Final = re.compile(r"\$\{[^}]*\}|\$\([^)]*\)")
PLACES_LIMIT: Final = 20_000
_RENAMED: Final = frozenset(
    {Kind.PROPERTY, Kind.ARG, Kind.MACRO, Kind.PARAMETER, Kind.BLOCK},
)


def renaming_of(subject: Subject | None, new: str, reading: Reading, book: UsesBook) -> Renaming:
    """Return the places that a renaming changes.

    Raises:
        EditError: It cannot be renamed, or not to this name; the sentence says why.
    """
    if subject is None or subject.kind not in _RENAMED:
        raise EditError(
            "Only properties, args, macros and their parameters and blocks can be renamed: put the "
            "cursor on the name of one."
        )
    definitions = reading.definitions
    if definitions is None or not reading.is_current:
        raise EditError("The texts do not run as they are: mend their problems, then rename.")
    check_spelling(subject.kind, subject.name, new)
    spots = sorted(
        {(one.file, one.start): one for one in _spots(subject, new, definitions, book)}.values(),
        key=lambda one: (one.file, one.start),
    )
    if len(spots) > PLACES_LIMIT:
        raise EditError(f"{subject.name} is named at more places than can be renamed at once.")
    places = tuple(_place(one, subject.name, reading) for one in spots)
    renaming = Renaming(subject.kind, subject.name, new, places)
    _try(renaming, reading)
    return renaming


def _spots(subject: Subject, new: str, definitions: Definitions, book: UsesBook) -> Iterator[Spot]:
    if is_name_group(subject.kind):
        group = NameGroup(subject.name, _elements(subject, definitions), definitions, book)
        if not group.members:
            raise EditError(f"{subject.name} is defined in no file of this robot.")
        check_group(group, new, definitions, book)
        yield from _group_spots(group, definitions)
    elif subject.kind is Kind.ARG:
        check_arg(subject.name, new, definitions, book)
        yield from arg_spots(subject.name, definitions, book)
    else:
        check_macro(subject.name, new, definitions)
        yield from macro_spots(subject.name, subject.elements, definitions)


def _elements(subject: Subject, definitions: Definitions) -> Iterator[SourceElement]:
    """Yield the elements that define a subject: of a value in a call, the macros called."""
    for element in subject.elements:
        if element.tag in {"xacro:property", "xacro:macro"}:
            yield element
        else:
            called = definitions.called.get(element, ())
            yield from (one for one in called if has_parameter(one, subject.name))


def _group_spots(group: NameGroup, definitions: Definitions) -> Iterator[Spot]:
    for element in group.members:
        if element.tag == "xacro:macro":
            if named := parameter_bytes(element, group.name):
                yield Spot(element.tree.path, *named)
        else:
            yield from attribute_value(element, "name")
    yield from (read.spot for read in group.reads())
    yield from given_spots(group.name, group.members, definitions)


def _place(spot: Spot, old: str, reading: Reading) -> RenamedPlace:
    """Return a spot as a place; of `xacro:ns.name` only the name.

    Raises:
        EditError: The name is written differently there, by an expression or a reference.
    """
    data = reading.text(spot.file) or b""
    place = reading.place(spot.file, spot.start, spot.end)
    written, name = data[spot.start : spot.end], old.encode()
    before = written[: -len(name)] if written.endswith(name) else None
    if before is None or (before and not before.endswith((b":", b"."))):
        raise EditError(
            f"{place.file}:{place.line} does not spell {old} out: rename it there by hand first."
        )
    start = spot.end - len(name)
    return RenamedPlace(
        reading.place(spot.file, start, spot.end),
        reading.places(spot.file).line(place.line),
        spot.in_run,
        start,
        spot.end,
    )


def _try(renaming: Renaming, reading: Reading) -> None:
    """Run with the new name; the robot must come out as it was."""
    trace = reading.trace
    assert trace is not None
    texts = {one.place.file for one in renaming.places}
    tried = reading.tried(
        {file: renamed(reading.text(file) or b"", file, renaming) for file in texts},
        renamed_arguments(renaming, reading.arguments),
    )
    if tried is None or write_xml(tried.root) != write_xml(trace.root):
        raise EditError(
            f"With {renaming.new} in the place of {renaming.old} the robot would be another one: "
            "choose another name."
        )


def renamed(data: bytes, file: str, renaming: Renaming) -> bytes:
    """Return the bytes of a file with the new name."""
    new, parts, at = renaming.new.encode(), list[bytes](), 0
    for one in renaming.places:
        if one.place.file == file:
            parts += [data[at : one.start], new]
            at = one.end
    return b"".join([*parts, data[at:]])


def renamed_arguments(renaming: Renaming, arguments: Mapping[str, str]) -> dict[str, str]:
    """Return the arguments that are passed, the renamed one under its new name."""
    if renaming.kind is not Kind.ARG:
        return dict(arguments)
    return {renaming.new if name == renaming.old else name: v for name, v in arguments.items()}


def check_spelling(kind: Kind, old: str, new: str) -> None:
    """Refuse what is no name of its kind.

    Raises:
        EditError: It is none, or the one that it has.
    """
    pattern = _TAG if kind is Kind.MACRO else _IDENTIFIER
    if not pattern.fullmatch(new) or len(new) > NAME_LIMIT:
        letters = "letters, digits, - and _" if kind is Kind.MACRO else "letters, digits and _"
        raise EditError(f"{new!r} is no name: use {letters}, beginning with a letter or _.")
    if new == old:
        raise EditError(f"It is called {old} already: type another name.")
    is_keyword = keyword.iskeyword(new) if kind is not Kind.MACRO else new in XACRO_TAGS
    if is_keyword:
        raise EditError(f"{new} is a word of the language itself: choose another name.")


def check_group(group: NameGroup, new: str, definitions: Definitions, book: UsesBook) -> None:
    """Refuse a name that another property or parameter has where the group is read or defined.

    Raises:
        EditError: It is taken, or a reader of it would read the group.
    """
    if new in definitions.trace.scope.run.symbols:
        raise EditError(f"Every expression knows {new} already: choose another name.")
    _refuse_built(_built(definitions), group.name, new)
    _refuse_forwarded(group.name, definitions)
    _refuse_forwarded(new, definitions)
    other = NameGroup(new, (), definitions, book)
    homes = _homes(group)
    for one in (*other.properties, *other.macros):
        macro = one if one in other.macros else macro_around(one)
        if macro is None or macro in homes:
            raise _taken(new, one)
    for read in other.all_reads:
        macro = macro_around(read.element)
        if macro in homes or (None in homes and macro is None):
            raise _taken(new, read.element)


def check_arg(name: str, new: str, definitions: Definitions, book: UsesBook) -> None:
    """Refuse a name that another arg has, or that somebody asks for.

    Raises:
        EditError: It is taken.
    """
    if not definitions.named("xacro:arg", name):
        raise EditError(f"{name} is declared in no file of this robot.")
    _refuse_built(_built(definitions), name, new)
    for element in definitions.named("xacro:arg", new):
        raise _taken(new, element)
    for tree in definitions.trace.trees.values():
        for use in book.of(tree):
            if use.command == "arg" and ("$" in use.name or use.name == new):
                raise _taken(new, use.element)
            if use.command == "eval" and use.name == new:
                raise _taken(new, use.element)


def check_macro(name: str, new: str, definitions: Definitions) -> None:
    """Refuse a name that another macro has, or that is called already.

    Raises:
        EditError: It is taken, or calls are made by expressions.
    """
    _refuse_built(_built(definitions), name, new)
    for _, macro in definitions.macros:
        if own_name(macro) == new:
            raise _taken(new, macro)
    for tree in definitions.trace.trees.values():
        for element in tree.elements:
            if called_name(element).rpartition(".")[2] == new:
                raise _taken(new, element)


def arg_spots(name: str, definitions: Definitions, book: UsesBook) -> Iterator[Spot]:
    """Yield the declarations of an arg, `$(arg name)`, its name in `$(eval ...)`, `arg('name')`.

    Raises:
        EditError: `arg(...)` is called with what is no plain text.
    """
    for element in definitions.named("xacro:arg", name):
        yield from attribute_value(element, "name")
    for tree in definitions.trace.trees.values():
        for use in book.of(tree):
            if use.command in {"arg", "eval"} and use.name == name:
                yield Spot(tree.path, use.starts[0], use.ends[0])
            yield from _asked_for(tree, use, name)


def _asked_for(tree: SourceTree, use: Use, name: str) -> Iterator[Spot]:
    """Yield the text in `arg('name')` and `xacro.arg('name')`."""
    if use.chain is None or use.chain.steps[-1].key != "arg":
        return
    if not _CALLED.match(tree.data, use.ends[-1]):  # of `$(arg name)`
        return
    found = _GIVEN.match(tree.data, use.ends[-1])
    if found is None:
        raise EditError(
            f"{tree.path}:{use.element.line} makes the name of an arg by an expression: it may be "
            f"{name}, so rename by hand."
        )
    assert found.lastindex is not None
    if found[found.lastindex] == name.encode():
        yield Spot(tree.path, *found.span(found.lastindex))


def macro_spots(
    name: str, elements: Iterable[SourceElement], definitions: Definitions
) -> Iterator[Spot]:
    """Yield the definitions of a macro and its calls, opening and closing tags.

    Raises:
        EditError: A call may mean another macro of that name as well.
    """
    members = same_macros(name, elements, definitions)
    if not members:
        raise EditError(f"{name} is defined in no file of this robot.")
    for element in members:
        yield from attribute_value(element, "name")
    for tree in definitions.trace.trees.values():
        calls = [one for one in tree.elements if _calls(one, name, members, definitions)]
        for call in calls:
            in_run = call in definitions.called
            if call.tag == "xacro:call":
                yield from attribute_value(call, "macro")
                continue
            start = call.offset + 1
            yield Spot(tree.path, start, start + len(call.tag.encode(tree.encoding)), in_run)
            if not call.closes_itself:
                start = call.end_tag + 2
                yield Spot(tree.path, start, start + len(call.tag.encode(tree.encoding)), in_run)


def same_macros(
    name: str, elements: Iterable[SourceElement], definitions: Definitions
) -> frozenset[SourceElement]:
    """Return all macros of one name in files of the same namespaces: nothing distinguishes them."""
    alike = {e for _, e in definitions.macros if own_name(e) == name}
    homes = {definitions.namespaces_of(one.tree.path) for one in set(elements) & alike}
    return frozenset(one for one in alike if definitions.namespaces_of(one.tree.path) in homes)


def own_name(macro: SourceElement) -> str:
    """Return the name of a macro as calls have it, without namespaces."""
    return macro.attributes.get("name", "").removeprefix("xacro:")


def _calls(
    element: SourceElement,
    name: str,
    members: frozenset[SourceElement],
    definitions: Definitions,
) -> bool:
    called = called_name(element)
    known = definitions.called.get(element)
    if not known and (called.rpartition(".")[2] != name or "$" in called):
        return False
    meant = frozenset(known or definitions.macros_by_name.get(called, ()))
    return _is_of(element, meant, members, name) if meant & members else False


def given_spots(
    name: str, members: frozenset[SourceElement], definitions: Definitions
) -> Iterator[Spot]:
    """Yield the attributes of calls that give a parameter.

    Raises:
        EditError: A call may mean another macro as well.
    """
    for tree in definitions.trace.trees.values():
        for element in tree.elements:
            if name not in element.attributes or not (called := called_name(element)):
                continue
            known = definitions.called.get(element)
            meant = known or definitions.macros_by_name.get(called, ())
            taking = frozenset(one for one in meant if has_parameter(one, name))
            if taking & members and _is_of(element, taking, members, name):
                yield from attribute_name(element, name, in_run=bool(known))


def _is_of(
    element: SourceElement,
    meant: frozenset[SourceElement],
    members: frozenset[SourceElement],
    name: str,
) -> bool:
    if meant <= members:
        return True
    raise EditError(
        f"{element.tree.path}:{element.line} may call another macro with {name} as well: rename it "
        "there by hand first."
    )


def _homes(group: NameGroup) -> set[SourceElement | None]:
    """Return the macros in which a group is defined or read; None: outside of all."""
    homes = {one if one.tag == "xacro:macro" else macro_around(one) for one in group.members}
    return homes | {macro_around(read.element) for read in group.reads()}


def _taken(new: str, element: SourceElement) -> EditError:
    return EditError(
        f"{new} is a name already, at {element.tree.path}:{element.line}: choose another one."
    )


def _built(definitions: Definitions) -> Iterator[tuple[SourceElement, str]]:
    """Yield the names that are made by expressions, as they are written."""
    for tree in definitions.trace.trees.values():
        for element in tree.elements:
            own = element.xacro_name
            if own not in {"property", "arg", "macro", "insert_block", "call"}:
                continue
            text = element.attributes.get("macro" if own == "call" else "name", "")
            if "$" in text:
                yield element, text


def _refuse_built(built: Iterator[tuple[SourceElement, str]], *names: str) -> None:
    for element, text in built:
        pieces = _PIECES.split(text)
        for name in names:
            if _may_be(name, pieces):
                raise EditError(
                    f"{element.tree.path}:{element.line} makes a name by an expression, {text}: it "
                    f"may be {name}, so nobody can vouch for the renaming."
                )


def _may_be(name: str, pieces: list[str]) -> bool:
    """Whether a name is these pieces in their order, with anything between them."""
    first, last = pieces[0], pieces[-1]
    if not name.startswith(first) or not name.endswith(last):
        return False
    at, end = len(first), len(name) - len(last)
    for piece in pieces[1:-1]:
        found = name.find(piece, at, end)
        if found < 0:
            return False
        at = found + len(piece)
    return at <= end


def _refuse_forwarded(name: str, definitions: Definitions) -> None:
    """A parameter with `:=^` takes what its caller has under the same name."""
    for _, macro in definitions.macros:
        _, defaults = read_parameters(macro.attributes.get("params", ""))
        if name in defaults and defaults[name].forward:
            raise EditError(
                f"{macro.tree.path}:{macro.line} takes {name} over from its caller by name (:=^): "
                "give it there by hand first."
            )
