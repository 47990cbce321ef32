"""Whether a class of messages is what its name means to the session that it is used on."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

from studio.errors import OtherTypeError
from studio.ros.types.classes import MessageValue, class_of_field, definition_of
from studio.ros.types.hashes import type_hash

if TYPE_CHECKING:
    from studio.ros.types.definitions import Message
    from studio.ros.types.library import TypeLibrary


def check_same_type(types: TypeLibrary, kind: type[MessageValue]) -> str:
    """Give the full name of a class's type.

    Raises:
        OtherTypeError: The library means something else by the name: the class is another
            distribution's, or was made before its text changed.
        UnknownTypeError: The library knows no such type.
    """
    name = definition_of(kind).name
    if types.hash_of(name) != _hash_of_class(kind):
        raise OtherTypeError(name, types.distro)
    return name


@cache
def _hash_of_class(kind: type[MessageValue]) -> str:
    found = _parts_of(kind)
    return type_hash(definition_of(kind), found.__getitem__)


def _parts_of(kind: type[MessageValue]) -> dict[str, Message]:
    found = {definition_of(kind).name: definition_of(kind)}
    waiting = [kind]
    while waiting:
        one = waiting.pop()
        for field in definition_of(one).fields:
            if field.type.nested and field.type.base not in found:
                part = class_of_field(one, field)
                found[field.type.base] = definition_of(part)
                waiting.append(part)
    return found
