"""Types that a node described become types of the library, once their hashes were found right."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.errors import (
    InterfaceError,
    RosNameError,
    TypeDescriptionError,
    UnknownTypeError,
)
from studio.ros.names import split_type_name
from studio.ros.types.definitions import Action, Interface, Message, Service, messages_of
from studio.ros.types.descriptions import read_description, write_description
from studio.ros.types.hashes import closure
from studio.ros.types.parser import TEXT_BYTES_MAX, parse_interface
from studio.ros.types.writing import kind_of, text_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from studio.ros.types.classes import MessageValue
    from studio.ros.types.library import TypeLibrary

DESCRIPTION = "type_description_interfaces/msg/TypeDescription"
SOURCE = "type_description_interfaces/msg/TypeSource"
_CALL_PARTS = {"srv": ("Request", "Response"), "action": ("Goal", "Result", "Feedback")}
# The parts of an action that stand in tokens; together they describe it whole.
ACTION_QUESTIONS = {"Goal": "SendGoal", "Result": "GetResult", "Feedback": "FeedbackMessage"}


def described(types: TypeLibrary, name: str) -> MessageValue:
    """Describe a type of the library as a TypeDescription.

    Raises:
        UnknownTypeError: It, or what it is made of, is not known.
    """
    return write_description(types.message(DESCRIPTION), types.find(name), types.find)


def sources(types: TypeLibrary, name: str) -> list[MessageValue]:
    """Give the texts of a type and of all it is made of as TypeSources, by name.

    Raises:
        UnknownTypeError: It, or what it is made of, is not known.
    """
    names = {owner_of(part) for part in closure(types.find(name), types.find)}
    made: list[MessageValue] = []
    for one in sorted(names):
        interface = types.interface(one)
        text = types.text_of(one) or text_of(interface)
        made.append(
            types.message(SOURCE)(
                type_name=one, encoding=kind_of(interface), raw_file_contents=text
            )
        )
    return made


def owner_of(name: str) -> str:
    """Name the type whose text defines a part: `p/srv/T` of `p/srv/T_Request`."""
    folder, _, base = name.rpartition("/")
    return f"{folder}/{base.partition('_')[0]}"


def learn(
    types: TypeLibrary,
    name: str,
    descriptions: Mapping[str, tuple[str, MessageValue]],
    source_texts: Iterable[MessageValue] = (),
) -> list[str]:
    """Take up a type and all it is made of that is not known yet; give the names taken up.

    Args:
        types: Where to.
        name: A message, service or action.
        descriptions: What nodes said, with the hash expected, by the name that was asked: `name`
            itself, or the parts of an action that stand in `ACTION_QUESTIONS`.
        source_texts: TypeSources; one that says the same as the description is kept with its
            comments, others are passed over.

    Raises:
        TypeDescriptionError: A description is wrong, or tells a known type otherwise.
    """
    parts: dict[str, Message] = {}
    for asked, (type_hash, description) in descriptions.items():
        parts |= read_description(description, asked, type_hash)
    given = {
        one.type_name: one.raw_file_contents
        for one in source_texts
        if len(one.raw_file_contents) <= TEXT_BYTES_MAX
    }
    texts: dict[str, str] = {}
    for owner in sorted({owner_of(part) for part in parts}):
        interface = _interface(name, owner, parts)
        if interface is not None and not _is_known(types, name, interface):
            texts[owner] = _text(interface, given.get(owner))
    _try(types, name, texts, {asked: one for asked, (one, _) in descriptions.items()})
    return types.add_texts(texts) if texts else []


def written(types: TypeLibrary, source_texts: Iterable[MessageValue]) -> dict[str, str]:
    """Give those TypeSources, by name, that say what the library has; others are passed over."""
    found: dict[str, str] = {}
    for one in source_texts:
        text = one.raw_file_contents
        try:
            known = types.interface(one.type_name)
        except (InterfaceError, RosNameError):
            continue
        if len(text) <= TEXT_BYTES_MAX and _says(text, known):
            found[one.type_name] = text
    return found


def _interface(whole: str, owner: str, parts: Mapping[str, Message]) -> Interface | None:
    """Put the parts of a text together; None where only some of an action were described."""
    kind = split_type_name(owner)[1]
    if kind == "msg":
        return parts[owner]
    found = [parts.get(f"{owner}_{part}") for part in _CALL_PARTS[kind]]
    known = [part for part in found if part is not None]
    if len(known) < len(found):
        return None
    try:
        return Service(owner, *known) if kind == "srv" else Action(owner, *known)
    except TypeError:
        raise TypeDescriptionError(whole, f"{owner} has parts that do not belong to it") from None


def _is_known(types: TypeLibrary, whole: str, interface: Interface) -> bool:
    """Whether the library has it in this form.

    Raises:
        TypeDescriptionError: It has it in another: a peer changes nothing that is known.
    """
    known_parts = 0
    for message in messages_of(interface):
        try:
            known = types.find(message.name)
        except UnknownTypeError:
            continue
        known_parts += 1
        if _shape(known) != _shape(message):
            raise TypeDescriptionError(
                whole, f"{interface.name} is known here in another form, which is kept"
            )
    return known_parts == len(messages_of(interface))


def _text(interface: Interface, given: str | None) -> str:
    return given if given is not None and _says(given, interface) else text_of(interface)


def _says(text: str, interface: Interface) -> bool:
    """Whether a text defines a type as it is known."""
    try:
        return _shapes(parse_interface(interface.name, text)) == _shapes(interface)
    except (InterfaceError, RosNameError):
        return False


def _try(
    types: TypeLibrary, name: str, texts: Mapping[str, str], hashes: Mapping[str, str]
) -> None:
    """See in a library of its own that the texts give the hashes that were promised."""
    trial = types.copy()
    try:
        trial.add_texts(texts)
        for asked, expected in hashes.items():
            if trial.hash_of(asked) != expected:
                raise TypeDescriptionError(name, f"its parts do not make {asked}")
    except (InterfaceError, RosNameError) as error:
        raise TypeDescriptionError(name, str(error).rstrip(".")) from None


def _shapes(interface: Interface) -> list[object]:
    return [_shape(message) for message in messages_of(interface)]


def _shape(message: Message) -> list[tuple[str, str]]:
    # A description does not tell `char` from `uint8`.
    return [
        (field.name, str(field.type).replace("char", "uint8", field.type.base == "char"))
        for field in message.fields
    ]
