"""What viser's page has after the frames that it got, arrays included."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import msgspec
import zstandard

from tests.support.viser_frames import Peer

if TYPE_CHECKING:
    from collections.abc import Iterable

    from tests.support.viser_frames import Sent


def content_of(frame: bytes) -> list[Sent]:
    """The messages of one frame with the bytes of their arrays."""
    packed_size = int.from_bytes(frame[8:16], "little")
    inner = zstandard.ZstdDecompressor().decompress(frame[16 : 16 + packed_size])
    decoded = msgspec.msgpack.decode(inner)
    arrays: list[bytes] = []
    at = 16 + packed_size
    for length in decoded["binaryBufferLengths"]:
        at += -at % 8
        arrays.append(frame[at : at + length])
        at += length
    assert at == len(frame)
    return cast("list[Sent]", _with_arrays(decoded["messages"], arrays))


def _with_arrays(value: Any, arrays: list[bytes]) -> Any:  # noqa: ANN401
    if isinstance(value, list):
        return [_with_arrays(one, arrays) for one in cast("list[Any]", value)]
    if isinstance(value, dict):
        fields = cast("dict[str, Any]", value)
        if "__binary_index" in fields:
            return (arrays[fields["__binary_index"]], fields["dtype"])
        return {name: _with_arrays(one, arrays) for name, one in fields.items()}
    return value


class PageState:
    """Nodes and settings, as viser's page keeps them."""

    def __init__(self) -> None:
        self.nodes: dict[str, Sent] = {}
        """By name: the message that made it, its properties as they are now."""
        self.said: dict[tuple[str, str], Sent] = {}
        """By kind of message and the name or uuid in it: what was said last."""
        self.ends_of_replay = 0

    def __eq__(self, other: object) -> bool:
        return isinstance(other, PageState) and vars(self) == vars(other)

    __hash__ = None  # pyright: ignore[reportAssignmentType]

    def apply(self, messages: Iterable[Sent]) -> None:
        for message in messages:
            self._apply(message["type"], message)

    def _apply(self, kind: str, message: Sent) -> None:
        name = message.get("name")
        if kind == "ReplayDoneMessage":
            self.ends_of_replay += 1
        elif kind == "RemoveSceneNodeMessage":
            assert name is not None
            self._remove(name)
        elif kind == "SceneNodeUpdateMessage":
            if name in self.nodes:
                self.nodes[name]["props"].update(message["updates"])
        elif name is not None and "props" in message:
            self.nodes[name] = {**message, "props": dict(message["props"])}
        else:
            self.said[kind, name or message.get("uuid") or ""] = message

    def _remove(self, name: str) -> None:
        def is_below(other: str) -> bool:
            return other == name or other.startswith(f"{name}/")

        self.nodes = {other: node for other, node in self.nodes.items() if not is_below(other)}
        self.said = {key: said for key, said in self.said.items() if not is_below(key[1])}


class WatchingPeer(Peer):
    """A peer that keeps what its page has."""

    def __init__(self) -> None:
        super().__init__()
        self.state = PageState()

    def look(self) -> PageState:
        """Take in what came, and return what the page has."""
        frames, self.frames = self.frames, []
        for frame in frames:
            self.state.apply(content_of(frame))
        return self.state
