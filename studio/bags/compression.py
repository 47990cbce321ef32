"""Decompression within bounds: of chunks, of messages and of whole files."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING, Final, Protocol, cast

import zstandard
from lz4 import frame as _frame

from studio.errors import DamagedPartError

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path
    from typing import BinaryIO

PART_BYTES_MAX: Final = 256 * 2**20
"""Of a chunk or a message, decompressed: no recorder writes larger ones."""
ZSTD_MAGIC: Final = b"\x28\xb5\x2f\xfd"
_STEP_BYTES: Final = 2**20
_UNKNOWN: Final = (2**64 - 1, -1)
"""What frames say that do not tell their size."""


class _LZ4Decompressor(Protocol):
    """What is used of lz4's, which has no types."""

    def decompress(self, data: bytes | memoryview, max_length: int) -> bytes:
        """Return at most so many bytes."""
        ...


_LZ4: Final = cast("Callable[[], _LZ4Decompressor]", cast("object", _frame.LZ4FrameDecompressor))


class _Tools(threading.local):
    """Decompressors of one thread: none of them may be used by two at a time."""

    def __init__(self) -> None:
        self.zstd = zstandard.ZstdDecompressor(max_window_size=PART_BYTES_MAX)


_TOOLS: Final = _Tools()


def decompressed(data: bytes | memoryview, compression: str, size: int) -> bytes:
    """Return what was compressed: `size` bytes.

    Args:
        data: One frame.
        compression: `zstd`, `lz4`, or empty for none.
        size: As the file declares it.

    Raises:
        DamagedPartError: It is something else, or larger, or than any part may be.
    """
    if size > PART_BYTES_MAX:
        raise DamagedPartError(f"it would take {size} bytes, more than any part of a bag may")
    found = _by_name(compression)(data, size)
    if len(found) != size:
        raise DamagedPartError(f"it holds {len(found)} bytes instead of {size}")
    return found


def decompressed_begin(data: bytes | memoryview, compression: str, size: int) -> bytes:
    """Decompress the beginning of a frame whose end is missing, as far as it goes.

    Raises:
        DamagedPartError: It is something else.
    """
    if compression == "zstd":
        return _zstd_begin(data, min(size, PART_BYTES_MAX))
    return _by_name(compression)(data, min(size, PART_BYTES_MAX))[:size]


def _zstd_begin(data: bytes | memoryview, size: int) -> bytes:
    found: list[bytes] = []
    reader = _TOOLS.zstd.stream_reader(data)
    try:
        while size > 0 and (piece := reader.read(min(size, _STEP_BYTES))):
            found.append(piece)
            size -= len(piece)
    except zstandard.ZstdError:
        pass  # what came before it is whole
    return b"".join(found)


def decompressed_message(data: bytes) -> bytes:
    """Return a message that was compressed by itself, with zstd; its frame says how large it is.

    Raises:
        DamagedPartError: It is something else, or too large.
    """
    size = _content_size(data, PART_BYTES_MAX)
    if size > PART_BYTES_MAX:
        raise DamagedPartError(f"a message would take more than {PART_BYTES_MAX} bytes")
    return _zstd(data, size)


def decompress_file(
    source: Path, target: BinaryIO, bytes_max: int, told: Callable[[int], None]
) -> None:
    """Decompress a file that was compressed whole, with zstd.

    Args:
        source: The file.
        target: Gets the bytes.
        bytes_max: So many may come out of it.
        told: Is told how many bytes of the source were read, now and then.

    Raises:
        DamagedPartError: It is no such file, is damaged, or holds more; of one that is cut off,
            what comes before the cut is written.
        OSError: The disk refuses it.
    """
    written = 0
    with source.open("rb") as stream:
        reader = _TOOLS.zstd.stream_reader(stream, read_across_frames=True)
        try:
            while piece := reader.read(_STEP_BYTES):
                written += len(piece)
                if written > bytes_max:
                    raise DamagedPartError(f"it holds more than {bytes_max} bytes")
                target.write(piece)
                told(stream.tell())
        except zstandard.ZstdError as error:
            raise DamagedPartError(f"it is damaged ({error})") from None


def _by_name(compression: str) -> Callable[[bytes | memoryview, int], bytes]:
    match compression:
        case "":
            return _plain
        case "zstd":
            return _zstd
        case "lz4":
            return _lz4
        case _:
            raise DamagedPartError(
                f'it is compressed with "{compression[:20]}", which is unknown here'
            )


def _plain(data: bytes | memoryview, _size: int) -> bytes:
    return bytes(data)


def _content_size(data: bytes | memoryview, unknown: int) -> int:
    """Return what a frame of zstd says to hold, or `unknown`; so much memory is taken for it."""
    try:
        size = zstandard.frame_content_size(data)
    except zstandard.ZstdError as error:
        raise DamagedPartError(f"it is no frame of zstd ({error})") from None
    return unknown if size in _UNKNOWN else size


def _zstd(data: bytes | memoryview, size: int) -> bytes:
    told = _content_size(data[:18], size)
    if told > size:
        raise DamagedPartError(f"it would take {told} bytes instead of {size}")
    try:
        return _TOOLS.zstd.decompress(data, max_output_size=size)
    except zstandard.ZstdError as error:
        raise DamagedPartError(f"it cannot be decompressed ({error})") from None


def _lz4(data: bytes | memoryview, size: int) -> bytes:
    try:
        # One byte more than it should have, so that what is larger is noticed.
        return _LZ4().decompress(data, size + 1)
    except (RuntimeError, ValueError, EOFError) as error:
        raise DamagedPartError(f"it cannot be decompressed ({error})") from None
