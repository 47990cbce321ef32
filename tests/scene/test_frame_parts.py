from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from viser import _messages

from studio.errors import SceneError
from studio.scene.frame_parts import (
    ARRAY_BYTES,
    WHOLE_BYTES,
    BlobStore,
    digest_of,
    join_frame,
    split_frame,
)
from studio.scene.node import PointCloudProps
from studio.scene.wire import Encoder

LARGE = 100_000


def frame_of(*sizes: int, seed: int = 0) -> bytes:
    """A frame with clouds of so many points, whose colours are an array of 3 bytes."""
    numbers = np.random.default_rng(seed)
    rgb = np.zeros(3, np.uint8)
    return Encoder().frame(
        _messages.PointCloudMessage(
            f"/{number}",
            PointCloudProps(
                numbers.random((size, 3), np.float32), rgb, 0.1, "square", "float32", 1.0, "flat"
            ),
        )
        for number, size in enumerate(sizes)
    )


@given(st.lists(st.sampled_from((0, 1, 1000, 1365, 1366, 5000, 30_000)), max_size=6))
def test_the_parts_of_a_frame_are_that_frame(sizes: list[int]):
    frame = frame_of(*sizes)
    parts, is_digest, blobs = split_frame(frame)
    named = [part for part, is_name in zip(parts, is_digest, strict=True) if is_name]
    assert set(named) == blobs.keys()
    assert all(len(blob) >= ARRAY_BYTES for blob in blobs.values())
    assert len(frame) <= WHOLE_BYTES or len(named) == sum(size >= 1366 for size in sizes)
    store = BlobStore(1 << 30)
    for digest, data in blobs.items():
        store.put(digest, bytes(data))
    assert join_frame(parts, is_digest, store.get) == frame


def test_a_small_frame_is_one_part_whatever_is_in_it():
    small = bytes(WHOLE_BYTES)
    assert split_frame(small) == ((small,), (False,), {})
    (part,), _, _ = split_frame(small)
    assert join_frame((part,), (False,), lambda _: None) is small
    with pytest.raises(SceneError, match="not one of viser's"):
        split_frame(bytes(WHOLE_BYTES + 1))


def test_an_array_that_comes_again_has_the_digest_that_it_had():
    _, _, first = split_frame(frame_of(LARGE))
    parts, _, second = split_frame(frame_of(LARGE, 0, 7))
    assert first.keys() == second.keys()
    assert sum(map(len, parts)) < 1000


def test_a_blob_that_is_missing_is_named():
    parts, is_digest, blobs = split_frame(frame_of(LARGE))
    (digest,) = blobs
    with pytest.raises(SceneError, match=digest.hex()):
        join_frame(parts, is_digest, lambda _: None)
    with pytest.raises(SceneError, match="marks"):
        join_frame(parts, is_digest[1:], lambda _: b"")


def test_bytes_that_are_others_than_their_digest_says_are_refused():
    store = BlobStore(100)
    with pytest.raises(SceneError, match="not those of"):
        store.put(digest_of(b"one"), b"two")
    assert store.get(digest_of(b"one")) is None
    assert store.size == 0


def test_a_full_store_forgets_what_was_not_asked_for_the_longest():
    store = BlobStore(100)
    one, two, three = (bytes([number]) * 40 for number in range(3))
    store.put(digest_of(one), one)
    store.put(digest_of(two), two)
    store.put(digest_of(two), two)
    assert store.size == 80
    assert store.get(digest_of(one)) == one
    store.put(digest_of(three), three)
    assert store.get(digest_of(two)) is None
    assert store.get(digest_of(one)) == one
    large = bytes(1000)
    store.put(digest_of(large), large)
    assert store.get(digest_of(large)) is large
    assert store.size == 1000
