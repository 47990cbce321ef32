"""Type descriptions, which nodes exchange by `get_type_description`.

A library learns a type only if its description has the expected hash.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from studio.errors import (
    InterfaceError,
    InterfaceTextError,
    RosNameError,
    TypeDescriptionError,
    UnknownTypeError,
)
from studio.ros.names import split_type_name
from studio.ros.types.convert import from_dict
from studio.ros.types.definitions import (
    DUMMY_FIELD,
    Action,
    Field,
    FieldType,
    Interface,
    Message,
    Service,
    Shape,
    check_sizes,
    messages_of,
)
from studio.ros.types.interface_text import (
    COUNT_MAX,
    MEMBERS_MAX,
    TEXT_BYTES_MAX,
    kind_of,
    parse_interface,
    text_of,
)
from studio.ros.types.type_hash import TYPE_IDS, closure, type_description, type_hash

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from studio.ros.types.classes import MessageValue
    from studio.ros.types.library import TypeLibrary

PARTS_MAX = 1_000
_NESTED = 1
_BOUNDED = {21: 17, 22: 18}
_SHAPES = {0: Shape.SINGLE, 1: Shape.ARRAY, 2: Shape.BOUNDED, 3: Shape.SEQUENCE}
_IDS_PER_SHAPE = 48
# `.msg` has two names for an unsigned byte: the one that is no letter is meant.
_BASES = {number: base for base, number in TYPE_IDS.items() if base != "char"}
DESCRIPTION = "type_description_interfaces/msg/TypeDescription"
SOURCE = "type_description_interfaces/msg/TypeSource"
_CALL_PARTS = {"srv": ("Request", "Response"), "action": ("Goal", "Result", "Feedback")}
# The parts of an action that stand in tokens; together they describe it whole.
ACTION_QUESTIONS = {"Goal": "SendGoal", "Result": "GetResult", "Feedback": "FeedbackMessage"}
DESCRIPTION_SERVICE_TYPE = "type_description_interfaces/srv/GetTypeDescription"
DESCRIPTION_SERVICE = "get_type_description"
DESCRIPTION_SERVICE_PARAMETER = "start_type_description_service"


def write_description(
    kind: type[MessageValue], message: Message, find: Callable[[str], Message]
) -> MessageValue:
    """Describe a message and all it is made of; `kind` is the class of TypeDescription.

    Raises:
        UnknownTypeError: What `find` raises for a part that is missing.
    """
    described: Any = type_description(message, find)
    parts = closure(message, find)
    for one in (described["type_description"], *described["referenced_type_descriptions"]):
        defaults = {field.name: field.default for field in parts[one["type_name"]].fields}
        for field in one["fields"]:
            default = defaults.get(field["name"])
            field["default_value"] = "" if default is None else str(default)
    return from_dict(kind, described)


def read_description(
    description: MessageValue, name: str, expected_hash: str
) -> dict[str, Message]:
    """Read a description of a type: it and all it is made of, by their full names.

    Raises:
        TypeDescriptionError: It is of another type, breaks a rule of types, is too large, or its
            hash is not the one that is expected.
    """
    whole = [description.type_description, *description.referenced_type_descriptions]
    if len(whole) > PARTS_MAX:
        raise TypeDescriptionError(name, f"it is made of more than {PARTS_MAX} types")
    parts: dict[str, Message] = {}
    for one in whole:
        message = _read_part(name, one)
        if parts.setdefault(message.name, message) is not message:
            raise TypeDescriptionError(name, f"{message.name} stands in it twice")
    if whole[0].type_name != name:
        raise TypeDescriptionError(name, f"it is one of {whole[0].type_name[:200]}")
    _check(name, parts, expected_hash)
    return parts


def _check(name: str, parts: dict[str, Message], expected_hash: str) -> None:
    def find(part: str) -> Message:
        if part not in parts:
            raise UnknownTypeError(part, "its description is missing")
        return parts[part]

    try:
        check_sizes(parts[name], find)
        computed = type_hash(parts[name], find)
    except (InterfaceTextError, UnknownTypeError) as error:
        raise TypeDescriptionError(name, str(error).rstrip(".")) from None
    if computed != expected_hash:
        raise TypeDescriptionError(
            name, f"its hash is {computed}, the node says {expected_hash[:80]}"
        )


def _read_part(whole: str, part: MessageValue) -> Message:
    try:
        split_type_name(part.type_name)
    except RosNameError as error:
        raise TypeDescriptionError(whole, str(error).rstrip(".")) from None
    if len(part.fields) > MEMBERS_MAX:
        raise TypeDescriptionError(whole, f"{part.type_name} has more than {MEMBERS_MAX} fields")
    fields = tuple(
        Field(field.name, _field_type(whole, f"{part.type_name}.{field.name[:80]}", field.type))
        for field in part.fields
    )
    empty = [field.name for field in fields] == [DUMMY_FIELD]
    return Message(part.type_name, () if empty else fields)


def _field_type(whole: str, where: str, described: MessageValue) -> FieldType:
    shape_number, offset = divmod(described.type_id - 1, _IDS_PER_SHAPE)
    shape, number = _SHAPES.get(shape_number), offset + 1
    base = described.nested_type_name if number == _NESTED else _BASES.get(_unbounded(number))
    if not base or shape is None:
        raise TypeDescriptionError(whole, f"{where} is of a type that .msg texts do not have")
    if max(described.capacity, described.string_capacity) > COUNT_MAX:
        raise TypeDescriptionError(whole, f"{where} holds more than {COUNT_MAX} values")
    bound = described.string_capacity if number in _BOUNDED else 0
    return FieldType(base, shape, 0 if shape is Shape.SINGLE else described.capacity, bound)


def _unbounded(number: int) -> int:
    return _BOUNDED.get(number, number)


def describe_type(types: TypeLibrary, name: str) -> MessageValue:
    """Describe a type of the library as a TypeDescription.

    Raises:
        UnknownTypeError: It, or what it is made of, is not known.
    """
    return write_description(types.message(DESCRIPTION), types.find(name), types.find)


def type_sources(types: TypeLibrary, name: str) -> list[MessageValue]:
    """Return the texts of a type and of all it is made of as TypeSources, by name.

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
    """Add a type and all it uses that is not known yet; return the names added.

    Args:
        types: The library to add to.
        name: A message, service or action.
        descriptions: Received from nodes, with the hash expected, by the name asked for: `name`
            itself, or the parts of an action in `ACTION_QUESTIONS`.
        source_texts: TypeSources; one that agrees with the description is kept with its comments,
            others are skipped.

    Raises:
        TypeDescriptionError: A description is wrong, or differs from a known type.
    """
    parts: dict[str, Message] = {}
    for asked, (expected, description) in descriptions.items():
        parts |= read_description(description, asked, expected)
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
    _check_hashes(types, name, texts, {asked: one for asked, (one, _) in descriptions.items()})
    return types.add_texts(texts) if texts else []


def matching_sources(types: TypeLibrary, source_texts: Iterable[MessageValue]) -> dict[str, str]:
    """Return the TypeSources that agree with the library, by name; others are skipped."""
    found: dict[str, str] = {}
    for one in source_texts:
        text = one.raw_file_contents
        try:
            known = types.interface(one.type_name)
        except (InterfaceError, RosNameError):
            continue
        if len(text) <= TEXT_BYTES_MAX and _defines(text, known):
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
    return given if given is not None and _defines(given, interface) else text_of(interface)


def _defines(text: str, interface: Interface) -> bool:
    """Whether a text defines a type as it is known."""
    try:
        return _shapes(parse_interface(interface.name, text)) == _shapes(interface)
    except (InterfaceError, RosNameError):
        return False


def _check_hashes(
    types: TypeLibrary, name: str, texts: Mapping[str, str], hashes: Mapping[str, str]
) -> None:
    """Check, in a copy of the library, that the texts have the hashes that were promised."""
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
    # In descriptions `char` is `uint8`.
    return [
        (field.name, str(field.type).replace("char", "uint8", field.type.base == "char"))
        for field in message.fields
    ]


def fill_description(
    types: TypeLibrary, request: MessageValue, response: MessageValue
) -> MessageValue:
    """Fill a response with the description that is asked for, or the reason why there is none."""
    name = request.type_name
    try:
        split_type_name(name)
        known_hash = types.hash_of(name)
        if request.type_hash and request.type_hash != known_hash:
            response.failure_reason = f"{name} has the hash {known_hash} here"
            return response
        response.type_description = describe_type(types, name)
        if request.include_type_sources:
            response.type_sources = type_sources(types, name)
    except (InterfaceError, RosNameError) as error:
        response.failure_reason = str(error)
        return response
    response.successful = True
    return response
