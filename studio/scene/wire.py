"""viser's wire: messages to one frame of bytes, and the type of a message that came in.

A frame is two little-endian u64 (raw and compressed length), zstd of a msgpack map, then the
arrays of the messages, each aligned to 8 bytes. Client to server is plain msgpack.
"""

# viser's insides are met here, in host.py and in opened_frames.py only.
# pyright: reportPrivateUsage=false
from __future__ import annotations

import struct
from typing import TYPE_CHECKING, Any, cast

import msgspec
import numpy as np
import zstandard
from viser._messages import (
    SceneNodeUpdateMessage,
    SetOrientationMessage,
    SetPositionMessage,
    _CreateSceneNodeMessage,
)

from studio.errors import SceneError

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from numpy.typing import NDArray
    from viser.infra import Message

_NEAR_M = 100.0
_POSITION, _ORIENTATION = struct.Struct(">B" + 3 * "Bf"), struct.Struct(">B" + 4 * "Bf")
"""MessagePack of an array of float32."""
_PADDING = tuple(bytes(count) for count in range(8))


class Packer:
    """Makes frames of messages that are MessagePack; keeps one compressor. Not thread-safe."""

    def __init__(self) -> None:
        self._zstd = zstandard.ZstdCompressor(level=1)
        self._msgpack = msgspec.msgpack.Encoder()

    def frame(self, messages: msgspec.Raw, stamp_s: float, arrays: list[memoryview]) -> bytes:
        """Return one frame, which the page applies as a whole.

        Args:
            messages: A list of messages as MessagePack, with references to the arrays.
            stamp_s: When it was made.
            arrays: Of the messages.
        """
        inner = self._msgpack.encode(
            {
                "messages": messages,
                "timestampSec": stamp_s,
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


class Encoder:
    """Makes frames of viser's messages. Not thread-safe.

    viser's page holds back a frame whose time stamp follows closely on the one before, to show it
    at the pace at which it was made, up to 100 ms late. Ours have stamps a second apart, whatever
    the time, so that an edit is shown as soon as it arrives.
    """

    def __init__(self) -> None:
        self._stamp_s = 0.0
        self._packer = Packer()
        self._msgpack = msgspec.msgpack.Encoder()

    def frame(self, messages: Iterable[Message]) -> bytes:
        """Return one frame, which the page applies as a whole."""
        arrays = _Arrays()
        self._stamp_s += 1.0
        raw = self._msgpack.encode([_as_dict(message, arrays) for message in messages])
        return self._packer.frame(msgspec.Raw(raw), self._stamp_s, arrays.views)


class _Arrays:
    """The arrays of one frame; one that several messages have is there once."""

    def __init__(self) -> None:
        self.views: list[memoryview] = []
        self._places: dict[int, int] = {}  # by identity: the messages keep their arrays alive

    def values(self, values: Mapping[str, Any]) -> dict[str, Any]:
        """Properties with a reference to each array in its place."""
        return {name: self._plain(value) for name, value in values.items()}

    def _plain(self, value: Any) -> Any:  # noqa: ANN401 - what viser has in its properties
        if isinstance(value, np.ndarray):
            return self._reference(value)  # pyright: ignore[reportUnknownArgumentType]
        return cast("Any", value.item()) if isinstance(value, np.generic) else value

    def _reference(self, array: NDArray[Any]) -> dict[str, Any]:
        at = self._places.get(id(array))
        if at is None:
            at = self._places[id(array)] = len(self.views)
            self.views.append(array.data if array.flags.c_contiguous else array.copy().data)
        return {"__binary_index": at, "dtype": array.dtype.str}


def _as_dict(message: Message, arrays: _Arrays) -> dict[str, Any]:
    """Serialize as viser does; frequent messages without its walk over type hints."""
    if type(message) is SetPositionMessage:
        return {
            "type": "SetPositionMessage",
            "name": message.name,
            "position": _packed_position(message.position),
            "owner": message.owner,
        }
    if type(message) is SetOrientationMessage:
        return {
            "type": "SetOrientationMessage",
            "name": message.name,
            "wxyz": _packed_orientation(message.wxyz),
            "owner": message.owner,
        }
    if type(message) is SceneNodeUpdateMessage:
        return {
            "type": "SceneNodeUpdateMessage",
            "name": message.name,
            "updates": arrays.values(message.updates),
            "owner": message.owner,
        }
    if isinstance(message, _CreateSceneNodeMessage):
        return {
            "type": type(message).__name__,
            "name": message.name,
            "owner": message.owner,
            "virtual": message.virtual,
            "props": arrays.values(vars(message.props)),  # pyright: ignore[reportUnknownArgumentType, reportUnknownMemberType, reportAttributeAccessIssue]
        }
    return message.as_serializable_dict(arrays.views)


def _packed_position(position_m: tuple[float, float, float]) -> msgspec.Raw | tuple[float, ...]:
    """Half the bytes for a point that is not far away; poses are most of what moves.

    At 100 m a step of float32 is 8 um.
    """
    x_m, y_m, z_m = position_m
    if max(abs(x_m), abs(y_m), abs(z_m)) < _NEAR_M:
        return msgspec.Raw(_POSITION.pack(0x93, 0xCA, x_m, 0xCA, y_m, 0xCA, z_m))
    return position_m


def _packed_orientation(wxyz: tuple[float, float, float, float]) -> msgspec.Raw:
    w, x, y, z = wxyz
    return msgspec.Raw(_ORIENTATION.pack(0x94, 0xCA, w, 0xCA, x, 0xCA, y, 0xCA, z))


def _append_aligned(parts: list[bytes | memoryview], arrays: list[memoryview], offset: int) -> None:
    for array in arrays:
        padding = _PADDING[-offset % 8]
        parts += (padding, array)
        offset += len(padding) + array.nbytes


class _Head(msgspec.Struct):
    """The one field that decides whether the rest is decoded."""

    type: str


_HEAD = msgspec.msgpack.Decoder(_Head)


def message_type(raw: bytes) -> str:
    """Return the type name of a message from the page.

    Raises:
        SceneError: It is not a viser message.
    """
    try:
        return _HEAD.decode(raw).type
    except (msgspec.MsgspecError, ValueError) as error:
        raise SceneError(f"A message to the 3D view is not one of viser's ({error}).") from error
