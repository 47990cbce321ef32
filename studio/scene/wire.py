"""viser's wire: messages to one frame of bytes, and the type of a message that came in.

A frame is two little-endian u64 (raw and compressed length), zstd of a msgpack map, then the
arrays of the messages, each aligned to 8 bytes. Client to server is plain msgpack.
"""

# viser's insides are met here and in host.py only.
# pyright: reportPrivateUsage=false
from __future__ import annotations

from typing import TYPE_CHECKING, Any

import msgspec
import zstandard
from viser._messages import (
    SceneNodeUpdateMessage,
    SetOrientationMessage,
    SetPositionMessage,
)

from studio.errors import SceneError

if TYPE_CHECKING:
    from collections.abc import Iterable

    from viser.infra import Message

_PADDING = tuple(bytes(count) for count in range(8))


class Encoder:
    """Makes frames; keeps one compressor. Not for use from two threads at once.

    viser's page holds back a frame whose time stamp follows closely on the one before, to show it
    at the pace at which it was made, up to 100 ms late. Ours are a second apart whatever the clock
    says: an edit is shown as soon as it is there.
    """

    def __init__(self) -> None:
        self._stamp_s = 0.0
        self._zstd = zstandard.ZstdCompressor(level=1)
        self._msgpack = msgspec.msgpack.Encoder()

    def frame(self, messages: Iterable[Message]) -> bytes:
        """One frame that the page applies as a whole."""
        arrays: list[memoryview] = []
        self._stamp_s += 1.0
        inner = self._msgpack.encode(
            {
                "messages": [_as_dict(message, arrays) for message in messages],
                "timestampSec": self._stamp_s,
                "binaryBufferLengths": [array.nbytes for array in arrays],
            }
        )
        packed = self._zstd.compress(inner)
        parts: list[bytes | memoryview] = [
            len(inner).to_bytes(8, "little"),
            len(packed).to_bytes(8, "little"),
            packed,
        ]
        _append_aligned(parts, arrays, 16 + len(packed))
        return b"".join(parts)


def _as_dict(message: Message, arrays: list[memoryview]) -> dict[str, Any]:
    """As viser does; what an edit or a joint changes, without its walk over type hints."""
    if type(message) is SetPositionMessage:
        return {
            "type": "SetPositionMessage",
            "name": message.name,
            "position": message.position,
            "owner": message.owner,
        }
    if type(message) is SetOrientationMessage:
        return {
            "type": "SetOrientationMessage",
            "name": message.name,
            "wxyz": message.wxyz,
            "owner": message.owner,
        }
    if type(message) is SceneNodeUpdateMessage:
        # Of plain values only: graph.py sends arrays with a new node, never with an update.
        return {
            "type": "SceneNodeUpdateMessage",
            "name": message.name,
            "updates": message.updates,
            "owner": message.owner,
        }
    return message.as_serializable_dict(arrays)


def _append_aligned(parts: list[bytes | memoryview], arrays: list[memoryview], offset: int) -> None:
    for array in arrays:
        padding = _PADDING[-offset % 8]
        parts += (padding, array)
        offset += len(padding) + array.nbytes


class _Head(msgspec.Struct):
    """The one field that decides whether the rest is looked at."""

    type: str


_HEAD = msgspec.msgpack.Decoder(_Head)


def message_type(raw: bytes) -> str:
    """The type name of a message from the page.

    Raises:
        SceneError: It is not a viser message.
    """
    try:
        return _HEAD.decode(raw).type
    except (msgspec.MsgspecError, ValueError) as error:
        raise SceneError(f"A message to the 3D view is not one of viser's ({error}).") from error
