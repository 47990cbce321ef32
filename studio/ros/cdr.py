"""Messages as the CDR that ROS 2 sends, written and read by generated code."""

from __future__ import annotations

import struct
from functools import cache
from typing import Any

from studio.errors import CdrError, MessageValueError, OtherMessageError
from studio.ros.types.classes import MessageValue, check_message, definition_of, parts_of
from studio.ros.types.definitions import Message, Shape
from studio.ros.types.rosbags import SerdeError, cdr_code

HEADER_BYTES = 4
_LITTLE, _BIG = b"\x00\x01\x00\x00", b"\x00\x00\x00\x00"
# What generated code raises for values that do not fit, and for bytes that do not.
_MISFITS = (
    struct.error, TypeError, ValueError, AttributeError, OverflowError, AssertionError,
    IndexError, SerdeError,
)  # fmt: skip


class Codec:
    """Encodes and decodes the values of one class; code is made when it is first needed."""

    def __init__(self, kind: type[MessageValue]) -> None:
        self._name = definition_of(kind).name
        self._code = cdr_code(kind)
        self._bounded = _has_bounds(kind)

    def encode(self, message: MessageValue, *, little_endian: bool = True) -> bytearray:
        """Write a message with its header of four bytes.

        Raises:
            MessageValueError: A field holds what its type does not take.
        """
        if self._bounded:
            check_message(message)
        try:
            return self._encode(message, little_endian=little_endian)
        except _MISFITS as error:
            check_message(message)
            raise MessageValueError(self._name, f"it cannot be written ({error})") from error

    def decode(self, data: bytes | bytearray | memoryview) -> Any:  # noqa: ANN401
        """Read a message; its arrays of numbers are read-only views of `data`.

        Bytes after the message are passed over: senders that share memory send more.

        Raises:
            CdrError: The bytes are no such message.
        """
        # Plain CDR begins with 0, and 0 or 1 for the order of bytes.
        if len(data) < HEADER_BYTES or data[0] or data[1] > 1:
            raise CdrError(self._name, "they do not begin with the header of plain CDR")
        code = self._code
        read = code.deserialize_cdr_le if data[1] else code.deserialize_cdr_be
        body = memoryview(data)[HEADER_BYTES:]
        try:
            # Of bytes it is read-only already.
            return read(body if body.readonly else body.toreadonly(), 0, code.cls, code.parts)[0]
        except (*_MISFITS, MessageValueError) as error:
            raise CdrError(self._name, str(error).rstrip(".")) from None

    def _encode(self, message: MessageValue, *, little_endian: bool) -> bytearray:
        code = self._code
        size = HEADER_BYTES + code.getsize_cdr(0, message, code.parts)
        written = bytearray(size)
        written[:HEADER_BYTES] = _LITTLE if little_endian else _BIG
        write = code.serialize_cdr_le if little_endian else code.serialize_cdr_be
        end = write(memoryview(written)[HEADER_BYTES:], 0, message, code.parts)
        if end + HEADER_BYTES != size:
            raise ValueError("a field changed while it was written")
        return written


def _has_bounds(kind: type[MessageValue]) -> bool:
    """Whether a sequence or string within is bounded, which generated code does not check."""
    return any(
        field.type.string_bound or (field.type.shape is Shape.BOUNDED and not field.type.numeric)
        for one in parts_of(kind).values()
        for field in definition_of(one).fields
    )


@cache
def codec_of(kind: type[MessageValue]) -> Codec:
    """Return the codec of a class, the same each time."""
    return Codec(kind)


def check_kind(expected: Message, value: object) -> MessageValue:
    """Return a value if it is of the expected type.

    Raises:
        OtherMessageError: It is no message, or one of another type.
    """
    if not isinstance(value, MessageValue):
        given = type(value).__name__
        raise OtherMessageError(expected.name, f"a value of the type is expected, not {given}")
    if definition_of(value) is not expected and definition_of(value).name != expected.name:
        raise OtherMessageError(expected.name, f"it was given a {definition_of(value).name}")
    return value
