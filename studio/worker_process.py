"""A worker process's end of its pipes, and how messages are packed at both ends.

Messages are frozen dataclasses as msgpack; nothing is unpickled. A frame is the length of what
follows (4 bytes), the length of the message's class name (1 byte), that name, and the message. A
worker first sends an empty frame: it is up. It ends when its pipe closes.

Nothing here imports asyncio: workers have no loop, and start a fifth sooner without it.
"""

from __future__ import annotations

import gc
import os
import struct
import sys
from typing import TYPE_CHECKING, Any, BinaryIO, Final

import msgspec

from studio.system import ignore_interrupt, limit_memory

if TYPE_CHECKING:
    from collections.abc import Callable

FRAME_LENGTH: Final = struct.Struct("<I")
_HEAD = struct.Struct("<IB")
_UP = FRAME_LENGTH.pack(0)
"""The frame that a new process sends when it can answer."""
_OBJECTS_WITHIN_REQUEST = 500_000
"""New objects of one request that garbage collection waits for: about 50 MB."""
_OBJECTS_KEPT = 50_000
"""New objects since the last collection that are left to the next request."""


class Codec:
    """Packs the messages of one worker as frames."""

    def __init__(self, *types: type) -> None:
        self._encoder = msgspec.msgpack.Encoder()
        self._decoders: dict[bytes, msgspec.msgpack.Decoder[Any]] = {
            one.__name__.encode(): msgspec.msgpack.Decoder(one) for one in types
        }

    def pack(self, message: object) -> bytearray:
        """Return a message as a frame."""
        name = type(message).__name__.encode()
        frame = bytearray(_HEAD.size + len(name))
        self._encoder.encode_into(message, frame, len(frame))
        _HEAD.pack_into(frame, 0, len(frame) - FRAME_LENGTH.size, len(name))
        frame[_HEAD.size : _HEAD.size + len(name)] = name
        return frame

    def unpack(self, body: bytes | bytearray) -> Any:  # noqa: ANN401 - one of the codec's types
        """Return the message of a frame, which is given without its length.

        Raises:
            KeyError: The class is none of this codec's.
            msgspec.ValidationError: The fields do not fit the class.
        """
        end = 1 + body[0]
        return self._decoders[bytes(body[1:end])].decode(memoryview(body)[end:])


def serve(
    codec: Codec,
    handle: Callable[[Any], object],
    memory_limit_bytes: int,
    answers_fd: int | None = None,
) -> None:
    """Answer requests from stdin until it closes: all that a worker does.

    What libraries print goes to stderr; only answers go to the pipe. An error that `handle` does
    not turn into an answer ends the process, and the parent reports it. `answers_fd` is the pipe,
    if it is not stdout any more.
    """
    ignore_interrupt()
    requests, answers = _take_over_pipes(answers_fd)
    limit_memory(memory_limit_bytes)
    gc.set_threshold(_OBJECTS_WITHIN_REQUEST)
    try:
        answers.write(_UP)
        answers.flush()
        while (body := _read_message(requests)) is not None:
            answers.write(codec.pack(handle(codec.unpack(body))))
            answers.flush()
            _clean_up()
    except BrokenPipeError:  # the parent is gone; what is left to write would fail again at exit
        os._exit(0)


def _clean_up() -> None:
    """Collect garbage while nobody waits: within a request it took 20 ms, seen as a stutter."""
    if gc.get_count()[0] > _OBJECTS_KEPT:
        gc.collect()


def _take_over_pipes(answers_fd: int | None) -> tuple[BinaryIO, BinaryIO]:
    """Keep the real stdout for answers, and point fd 1 at stderr for everyone else."""
    if answers_fd is not None:
        return sys.stdin.buffer, os.fdopen(answers_fd, "wb")
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    return sys.stdin.buffer, answers


def _read_message(stream: BinaryIO) -> bytes | None:
    head = stream.read(FRAME_LENGTH.size)
    if len(head) < FRAME_LENGTH.size:
        return None
    (length,) = FRAME_LENGTH.unpack(head)
    body = stream.read(length)
    return body if len(body) == length else None
