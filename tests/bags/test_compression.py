"""Decompression: what comes out is what went in, and no more memory is taken than may be."""

from __future__ import annotations

import io
import tracemalloc
from typing import TYPE_CHECKING, cast

import pytest
import zstandard
from hypothesis import given
from hypothesis import strategies as st
from lz4 import frame

from studio.bags.compression import (
    PART_BYTES_MAX,
    decompress_file,
    decompressed,
    decompressed_begin,
    decompressed_message,
)
from studio.errors import DamagedPartError

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

PACKERS: dict[str, Callable[[bytes], bytes]] = {
    "": bytes,
    "zstd": zstandard.compress,
    "lz4": cast("Callable[[bytes], bytes]", frame.compress),  # pyright: ignore[reportUnknownMemberType]
}
TOO_MUCH = PART_BYTES_MAX + 1
SMALL_BYTES = 10_000_000


def _unsized(data: bytes) -> bytes:
    """A frame of zstd that does not tell how much is in it."""
    packer = zstandard.ZstdCompressor(write_content_size=False)
    return packer.compress(data)


@given(st.binary(max_size=500), st.sampled_from(sorted(PACKERS)))
def test_a_part_is_what_was_packed_and_its_beginning_the_beginning(data: bytes, name: str):
    packed = PACKERS[name](data)
    assert decompressed(packed, name, len(data)) == data
    for cut in range(0, len(packed), 7):
        assert data.startswith(decompressed_begin(packed[:cut], name, len(data)))
    for size in {len(data) + 1, max(0, len(data) - 1)} - {len(data)}:
        with pytest.raises(DamagedPartError):
            decompressed(packed, name, size)


@given(st.binary(max_size=60), st.sampled_from(["zstd", "lz4", "zip"]), st.integers(0, 2**64))
def test_rubbish_is_a_sentence_or_refused_for_its_size(data: bytes, name: str, size: int):
    head = {"zstd": b"\x28\xb5\x2f\xfd", "lz4": b"\x04\x22\x4d\x18"}.get(name, b"")
    for rubbish in (data, head + data):
        with pytest.raises(DamagedPartError):
            decompressed(rubbish, name, size or 1)


@given(st.binary(max_size=60))
def test_a_message_that_is_no_frame_is_a_sentence(data: bytes):
    for rubbish in (data, b"\x28\xb5\x2f\xfd" + data):
        try:
            found = decompressed_message(rubbish)
        except DamagedPartError as error:
            found = b"" if error.reason else b"no sentence"
        assert found == b""


BOMBS: dict[str, tuple[Callable[[bytes], bytes], Callable[[bytes], bytes]]] = {
    "zstd, another size": (zstandard.compress, lambda bomb: decompressed(bomb, "zstd", 1_000)),
    "zstd, no size": (_unsized, lambda bomb: decompressed(bomb, "zstd", 1_000)),
    "lz4, another size": (PACKERS["lz4"], lambda bomb: decompressed(bomb, "lz4", 1_000)),
    "zstd, its size": (zstandard.compress, lambda bomb: decompressed(bomb, "zstd", TOO_MUCH)),
    "lz4, its size": (PACKERS["lz4"], lambda bomb: decompressed(bomb, "lz4", TOO_MUCH)),
    "lz4, cut off": (PACKERS["lz4"], lambda bomb: decompressed_begin(bomb[:-9], "lz4", 1_000)),
    "zstd, cut off": (_unsized, lambda bomb: decompressed_begin(bomb[:-9], "zstd", 1_000)),
    "message": (zstandard.compress, decompressed_message),
}
"""How a bomb is packed, and what unpacks it."""


@pytest.mark.parametrize("bomb", BOMBS)
def test_a_bomb_is_refused_before_it_takes_memory(bomb: str):
    pack, unpack = BOMBS[bomb]
    packed = pack(bytes(TOO_MUCH))
    tracemalloc.start()
    try:
        found = unpack(packed)
    except DamagedPartError as error:
        found = error.reason.encode()
    peak_bytes = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert 0 < len(found) <= 1_000
    assert peak_bytes < SMALL_BYTES


def test_a_message_that_does_not_tell_its_size_is_read_and_a_bomb_of_them_is_not():
    assert decompressed_message(_unsized(b"hello")) == b"hello"
    with pytest.raises(DamagedPartError):
        decompressed_message(_unsized(bytes(TOO_MUCH)))


def test_a_whole_file_is_unpacked_to_its_bound_and_a_cut_one_to_its_cut(tmp_path: Path):
    data = bytes(range(256)) * 20_000
    source = tmp_path / "a.zstd"
    source.write_bytes(zstandard.compress(data) + zstandard.compress(b"second frame"))
    sink, told = io.BytesIO(), list[int]()
    decompress_file(source, sink, len(data) + 12, told.append)
    assert sink.getvalue() == data + b"second frame"
    assert 0 < told[-1] <= source.stat().st_size
    with pytest.raises(DamagedPartError, match="holds more than"):
        decompress_file(source, io.BytesIO(), len(data) + 11, told.append)
    source.write_bytes(zstandard.compress(bytes(10**7) + data)[:-20])
    cut = io.BytesIO()
    decompress_file(source, cut, 2 * 10**7, told.append)
    assert (bytes(10**7) + data).startswith(cut.getvalue())
    assert len(cut.getvalue()) >= 10**7
    source.write_bytes(b"no frame at all")
    with pytest.raises(DamagedPartError, match="is damaged"):
        decompress_file(source, io.BytesIO(), 10**6, told.append)
