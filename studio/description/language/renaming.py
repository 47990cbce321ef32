"""What has to change for a property, arg, macro, parameter or block to have another name.

Nothing is promised that was not tried: the robot is run once more with the new name, and what comes
out has to be the same.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from studio.description.evaluator.output_tree import write_xml
from studio.description.language.definitions import parameter_bytes
from studio.description.language.name_group import NameGroup, has_parameter, is_name_group
from studio.description.language.questions import RenamedPlace, Renaming
from studio.description.language.questions import SubjectKind as Kind
from studio.description.language.references import Spot, attribute_value
from studio.description.language.rename_checks import (
    check_arg,
    check_group,
    check_macro,
    check_spelling,
)
from studio.description.language.rename_spots import arg_spots, given_spots, macro_spots
from studio.errors import EditError

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from studio.description.language.definitions import Definitions
    from studio.description.language.reading import Reading
    from studio.description.language.references import UsesBook
    from studio.description.language.subject import Subject
    from studio.description.syntax.source_tree import SourceElement

PLACES_LIMIT: Final = 20_000
_RENAMED: Final = frozenset(
    {Kind.PROPERTY, Kind.ARG, Kind.MACRO, Kind.PARAMETER, Kind.BLOCK},
)


def renaming_of(subject: Subject | None, new: str, reading: Reading, book: UsesBook) -> Renaming:
    """The places that a renaming changes.

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
    """The elements that define a subject: of a value in a call, the macros called."""
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
    """A spot as a place; of `xacro:ns.name` only the name.

    Raises:
        EditError: The name is written there in another way, by an expression or a reference.
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
    """The bytes of a file with the new name."""
    new, parts, at = renaming.new.encode(), list[bytes](), 0
    for one in renaming.places:
        if one.place.file == file:
            parts += [data[at : one.start], new]
            at = one.end
    return b"".join([*parts, data[at:]])


def renamed_arguments(renaming: Renaming, arguments: Mapping[str, str]) -> dict[str, str]:
    """The arguments that are passed, the renamed one under its new name."""
    if renaming.kind is not Kind.ARG:
        return dict(arguments)
    return {renaming.new if name == renaming.old else name: v for name, v in arguments.items()}
