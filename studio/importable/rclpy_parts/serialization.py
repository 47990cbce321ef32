"""Messages as the bytes that are sent."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from studio.ros.cdr import codec_of

if TYPE_CHECKING:
    from studio.ros.types.classes import MessageValue


def serialize_message(message: MessageValue) -> bytes:
    """Write a message as CDR with its header.

    Raises:
        MessageValueError: A field holds what its type does not take.
    """
    return bytes(codec_of(type(message)).encode(message))


def deserialize_message(serialized_message: bytes, message_type: type[MessageValue]) -> Any:  # noqa: ANN401
    """Read a message.

    Raises:
        CdrError: The bytes are no such message.
    """
    return codec_of(message_type).decode(serialized_message)
