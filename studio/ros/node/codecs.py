"""The codecs of a process: the code that reads and writes a class is made once."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

from studio.errors import MessageValueError
from studio.ros.cdr import Codec
from studio.ros.types.classes import MessageValue, definition_of

if TYPE_CHECKING:
    from studio.ros.types.definitions import Message


@cache
def codec_of(kind: type[MessageValue]) -> Codec:
    """Give the codec of a class, the same each time."""
    return Codec(kind)


def check_kind(expected: Message, value: object) -> MessageValue:
    """Give back a value of the type that is expected.

    Raises:
        MessageValueError: It is no message, or one of another type.
    """
    if not isinstance(value, MessageValue):
        given = type(value).__name__
        raise MessageValueError(expected.name, f"a value of the type is expected, not {given}")
    if definition_of(value) is not expected and definition_of(value).name != expected.name:
        raise MessageValueError(expected.name, f"it was given a {definition_of(value).name}")
    return value
