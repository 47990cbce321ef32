"""Descriptions of types, as nodes tell them to each other: definitions to messages and back."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from studio.errors import InterfaceTextError, RosNameError, TypeDescriptionError, UnknownTypeError
from studio.ros.names import split_type_name
from studio.ros.types.definitions import DUMMY_FIELD, Field, FieldType, Message, Shape
from studio.ros.types.hashes import TYPE_IDS, closure, type_description, type_hash
from studio.ros.types.limits import check_sizes
from studio.ros.types.parser import COUNT_MAX, MEMBERS_MAX
from studio.ros.types.plain import from_dict

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.ros.types.classes import MessageValue

PARTS_MAX = 1_000
_NESTED = 1
_BOUNDED = {21: 17, 22: 18}
_SHAPES = {0: Shape.SINGLE, 1: Shape.ARRAY, 2: Shape.BOUNDED, 3: Shape.SEQUENCE}
_IDS_PER_SHAPE = 48
# `.msg` has two names for an unsigned byte: the one that is no letter is meant.
_BASES = {number: base for base, number in TYPE_IDS.items() if base != "char"}


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
