"""A frame of viser's, opened: its messages, what each of them replaces, and back into a frame.

Arrays are views of the frame that they came in; the messages that have them share them.
"""

# viser's insides are met here, in host.py and in wire.py only.
# pyright: reportPrivateUsage=false, reportUnknownMemberType=false
from __future__ import annotations

import weakref
from functools import lru_cache
from typing import TYPE_CHECKING, Annotated, Any, Final, NamedTuple, TypeAlias, cast

import msgspec
import numpy as np
import zstandard
from viser import _messages

from studio.errors import SceneError

if TYPE_CHECKING:
    from collections.abc import Iterable

    from studio.scene.wire import Packer

INNER_BYTES_MAX: Final = 256 << 20
"""Messages of one frame without their arrays; pictures and GLB files are in it."""
_HEADER_BYTES: Final = 16
_SMALL_BYTES: Final = 64 << 10
"""The arrays of a smaller frame are copied, so that none of them keeps the frame."""
_SHORT_BYTES: Final = 4 << 10
_PLACEHOLDER: Final = b"__binary_index"
END_OF_REPLAY: Final = "ReplayDoneMessage"
"""Tells a page that it has the whole state; each page has its own."""

Fields: TypeAlias = "dict[str, Any]"


class Array:
    """An array of a message: its bytes and numpy's name of their type."""

    __slots__ = ("__weakref__", "dtype", "view")

    def __init__(self, view: memoryview, dtype: str) -> None:
        self.view, self.dtype = view, dtype

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Array) or self.dtype != other.dtype:
            return False
        if self.view.nbytes != other.view.nbytes:
            return False
        ours, theirs = (np.asarray(one.view) for one in (self, other))
        return bool(np.array_equal(ours, theirs))

    __hash__ = object.__hash__


class Slot(NamedTuple):
    """What a message replaces, as viser's own buffer of messages sees it."""

    key: str
    """Of one key the newest message counts."""
    entity: tuple[str, str] | None
    """The kind and id of the thing that it makes, changes or removes; None: of none."""
    phase: str | None
    """Of the thing's life: create, update_dict, update_simple, remove; None: beside it."""


class Message:
    """One message of a frame, as MessagePack, or once looked into as fields with their Arrays."""

    __slots__ = ("_fields", "_raw", "kind", "slot")

    def __init__(self, kind: str, slot: Slot, raw: bytes, fields: Fields | None = None) -> None:
        self.kind, self.slot = kind, slot
        self._raw, self._fields = raw, fields

    @property
    def body(self) -> msgspec.Raw | Fields:
        """What goes into a frame."""
        return msgspec.Raw(self._raw) if self._fields is None else self._fields

    def fields(self) -> Fields:
        """Look into it; what is changed in them is changed in the message."""
        if self._fields is None:
            self._fields = cast("Fields", msgspec.msgpack.decode(self._raw))
            self._raw = b""
        return self._fields

    def says_the_same(self, other: Message) -> bool:
        """Whether it has the content of the other."""
        if self._fields is None and other._fields is None:
            return self._raw == other._raw
        return self.fields() == other.fields()


class OpenedFrame(NamedTuple):
    """The messages of a frame, in order, without that of the end of the replay."""

    frame: bytes
    messages: list[Message]
    stamp_s: float
    ends_replay: bool
    """The last message told that this is the whole state."""
    arrays: list[Array]


class _Inner(msgspec.Struct):
    messages: list[msgspec.Raw]
    timestampSec: float  # noqa: N815 - viser's name
    binaryBufferLengths: list[Annotated[int, msgspec.Meta(ge=0)]] = []  # noqa: N815


class _Lengths(msgspec.Struct):
    binaryBufferLengths: list[Annotated[int, msgspec.Meta(ge=0)]] = []  # noqa: N815


class _Head(msgspec.Struct):
    """What the key of most messages is made of."""

    type: str
    name: str | None = None
    uuid: str | None = None
    updates: dict[str, msgspec.Raw] | None = None


_INNER: Final = msgspec.msgpack.Decoder(_Inner)
_LENGTHS: Final = msgspec.msgpack.Decoder(_Lengths)
_HEAD: Final = msgspec.msgpack.Decoder(_Head)
_BAD = (
    msgspec.MsgspecError, zstandard.ZstdError, ValueError, TypeError, KeyError, IndexError,
    AttributeError, RecursionError, OverflowError,
)  # fmt: skip


def opened(frame: bytes) -> OpenedFrame:
    """Open a frame.

    Raises:
        SceneError: It is none of viser's.
    """
    try:
        inner, at = _inner_of(frame)
        found = _INNER.decode(inner)
        places = _places(found.binaryBufferLengths, at, len(frame))
        arrays = _Arrays(frame, places)
        messages = [_message(raw, arrays) for raw in found.messages]
    except _BAD as error:
        raise _malformed(error) from error
    kept = [message for message in messages if message.kind != END_OF_REPLAY]
    ends_replay = bool(messages) and messages[-1].kind == END_OF_REPLAY
    return OpenedFrame(frame, kept, found.timestampSec, ends_replay, list(arrays.made.values()))


def places_of_arrays(frame: bytes) -> list[tuple[int, int]]:
    """Return where each array of a frame begins and ends; its messages are not decoded.

    Raises:
        SceneError: It is none of viser's.
    """
    try:
        inner, at = _inner_of(frame)
        return _places(_LENGTHS.decode(inner).binaryBufferLengths, at, len(frame))
    except _BAD as error:
        raise _malformed(error) from error


def closed(
    messages: Iterable[Message], stamp_s: float, packer: Packer, *, ends_replay: bool = False
) -> bytes:
    """Return a frame of these messages; an array that several of them have is in it once.

    Args:
        messages: In order.
        stamp_s: viser's page plays frames at the pace of their stamps.
        packer: Makes the frame.
        ends_replay: Say at the end that this is the whole state.
    """
    views: list[memoryview] = []
    indices: dict[int, int] = {}

    def reference(array: Array) -> Fields:
        at = indices.get(id(array))
        if at is None:
            at = indices[id(array)] = len(views)
            views.append(array.view)
        return {"__binary_index": at, "dtype": array.dtype}

    bodies: list[msgspec.Raw | Fields] = [message.body for message in messages]
    if ends_replay:
        bodies.append({"type": END_OF_REPLAY})
    encoder = msgspec.msgpack.Encoder(enc_hook=reference)
    return packer.frame(msgspec.Raw(encoder.encode(bodies)), stamp_s, views)


def removal_of(create: Message) -> Message:
    """Return the message that removes the node of the scene which `create` made."""
    assert create.slot.entity is not None
    gone: dict[str, str] = {
        "type": "RemoveSceneNodeMessage",
        "name": create.slot.entity[1],
        "owner": create.fields().get("owner", ""),
    }
    slot = Slot(create.slot.key, create.slot.entity, "remove")
    return Message(gone["type"], slot, msgspec.msgpack.encode(gone))


class HeldFrames:
    """Frames of which arrays are kept; one of which less than half is kept is let go."""

    def __init__(self) -> None:
        self._frames: list[tuple[int, list[weakref.ref[Array]]]] = []

    def hold(self, size: int, arrays: list[Array]) -> None:
        """Watch the arrays of one more frame; forget those frames that nobody needs."""
        if arrays and size > _SMALL_BYTES:
            self._frames.append((size, [weakref.ref(array) for array in arrays]))
            self.let_go()

    def let_go(self) -> None:
        """Copy what is kept of frames of which most is not."""
        self._frames = [held for held in self._frames if _is_worth(*held)]


def _is_worth(size: int, arrays: list[weakref.ref[Array]]) -> bool:
    kept = [array for reference in arrays if (array := reference()) is not None]
    if sum(array.view.nbytes for array in kept) * 2 >= size:
        return True
    for array in kept:
        array.view = memoryview(bytes(array.view))
    return False


def _inner_of(frame: bytes) -> tuple[bytes, int]:
    """Return the messages as MessagePack, and where the arrays begin."""
    size, packed_size = (int.from_bytes(frame[at : at + 8], "little") for at in (0, 8))
    at = _HEADER_BYTES + packed_size
    packed = memoryview(frame)[_HEADER_BYTES:at]
    if len(packed) != packed_size or size > INNER_BYTES_MAX:
        raise ValueError(f"its head says {size} bytes, packed {packed_size}, of {len(frame)}")
    if zstandard.get_frame_parameters(packed).content_size != size:
        raise ValueError("its two lengths differ")
    return zstandard.ZstdDecompressor().decompress(packed), at


def _places(lengths: list[int], at: int, size: int) -> list[tuple[int, int]]:
    places: list[tuple[int, int]] = []
    for length in lengths:
        at += -at % 8
        places.append((at, at + length))
        at += length
    if at != size:
        raise ValueError(f"it has {size} bytes and should have {at}")
    return places


def _malformed(error: Exception) -> SceneError:
    return SceneError(f"A frame of the 3D view is not one of viser's ({error}).")


class _Arrays:
    """The arrays of a frame that is being opened, made when a message names them."""

    def __init__(self, frame: bytes, places: list[tuple[int, int]]) -> None:
        self._frame, self._places = memoryview(frame), places
        self.made: dict[tuple[int, str], Array] = {}

    def put_into(self, value: Any) -> Any:  # noqa: ANN401 - what MessagePack has
        """Return it with an Array for each reference to one."""
        if isinstance(value, list):
            return [self.put_into(one) for one in cast("list[Any]", value)]
        if not isinstance(value, dict):
            return value
        fields = cast("Fields", value)
        if "__binary_index" in fields and "dtype" in fields:
            return self._array(fields["__binary_index"], fields["dtype"])
        return {name: self.put_into(one) for name, one in fields.items()}

    def _array(self, index: int, dtype: str) -> Array:
        made = self.made.get((index, dtype))
        if made is None:
            if index < 0 or not isinstance(dtype, str):  # pyright: ignore[reportUnnecessaryIsInstance]
                raise ValueError("an array has no type")
            begin, end = self._places[index]
            view = self._frame[begin:end]
            if len(self._frame) <= _SMALL_BYTES:
                view = memoryview(bytes(view))
            made = self.made[index, dtype] = Array(view, dtype)
        return made


def _message(raw: msgspec.Raw, arrays: _Arrays) -> Message:
    head = _HEAD.decode(raw)
    data = bytes(raw)
    fields = None
    if _PLACEHOLDER in data:
        fields, data = cast("Fields", arrays.put_into(msgspec.msgpack.decode(data))), b""
    if _has_usual_key(head.type):
        names = None if head.updates is None else tuple(head.updates)
        # What is remembered of a message must not be large.
        usual_slot = _usual_slot if len(raw) < _SHORT_BYTES else _usual_slot.__wrapped__
        slot = usual_slot(head.type, head.name, head.uuid, names)
    else:
        slot = _slot(head.type, fields or msgspec.msgpack.decode(data))
    if fields is None and slot.phase in ("create", "update_dict"):
        msgspec.msgpack.decode(data)  # all of it can be looked into later
    return Message(head.type, slot, data, fields)


@lru_cache(maxsize=256)
def _has_usual_key(kind: str) -> bool:
    """Whether name, uuid and names of updates are all that the key is made of."""
    return _class(kind).redundancy_key is _messages.Message.redundancy_key


@lru_cache(maxsize=1 << 14)
def _usual_slot(
    kind: str, name: str | None, uuid: str | None, updates: tuple[str, ...] | None
) -> Slot:
    fields: Fields = {"name": name, "uuid": uuid}
    if updates is not None:
        fields["updates"] = dict.fromkeys(updates)
    return _slot(kind, fields)


def _slot(kind: str, fields: Fields) -> Slot:
    """Ask viser itself, of a message without its content."""
    message_class = _class(kind)
    message = object.__new__(message_class)
    vars(message).update(fields)
    key, phase = message.redundancy_key(), message.lifecycle_phase
    entity = message.entity_state_key()
    if phase is not None:
        assert message.entity_type is not None
        assert message.entity_id_field is not None
        entity = (message.entity_type, getattr(message, message.entity_id_field))
        if not isinstance(entity[1], str):  # pyright: ignore[reportUnnecessaryIsInstance]
            raise ValueError(f"a {kind} names nothing")
    return Slot(key, entity, phase)


def _class(kind: str) -> type[_messages.Message]:
    classes: dict[str, type[Any]] = _messages.Message._subclass_from_type_string()
    return classes[kind]
