"""What a callback may ask to be told beside a message, by taking a second argument."""

from __future__ import annotations

import inspect
from typing import TYPE_CHECKING, TypeAlias, TypedDict

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.ros.node.inbox import RawSample


class MessageInfo(TypedDict):
    """Times are since the Unix epoch; the GID names the publisher, as in its token."""

    source_timestamp: int
    received_timestamp: int
    publication_sequence_number: int
    reception_sequence_number: int | None
    publisher_gid: bytes


TakeBytes: TypeAlias = "Callable[[bytes, MessageInfo], None]"
"""Takes a message as it came, and what came with it."""


def info_of(sample: RawSample) -> MessageInfo:
    """Tell what came with a sample."""
    attachment = sample.attachment
    return MessageInfo(
        source_timestamp=attachment.source_time_ns,
        received_timestamp=sample.received_ns,
        publication_sequence_number=attachment.sequence,
        reception_sequence_number=None,
        publisher_gid=attachment.gid,
    )


def wants_info(callback: Callable[..., object]) -> bool:
    """Whether a callback takes the message and what came with it: it must have two arguments."""
    try:
        inspect.signature(callback).bind(object())
    except TypeError:
        return True
    except ValueError:  # of built-in functions nothing is known
        return False
    return False
