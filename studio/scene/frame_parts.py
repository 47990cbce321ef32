"""A large frame in parts, so that an array that was sent once is not sent again: it is named."""

from __future__ import annotations

import hashlib
from collections import OrderedDict
from itertools import pairwise
from typing import TYPE_CHECKING, Final

from studio.errors import SceneError
from studio.scene.opened_frames import places_of_arrays

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

DIGEST_BYTES: Final = 16
WHOLE_BYTES: Final = 256 << 10
"""A frame up to this goes as it is."""
ARRAY_BYTES: Final = 16 << 10
"""A shorter array goes with the frame."""


def digest_of(data: bytes | memoryview) -> bytes:
    """Return what names these bytes."""
    return hashlib.blake2b(data, digest_size=DIGEST_BYTES).digest()


def split_frame(
    frame: bytes,
) -> tuple[tuple[bytes, ...], tuple[bool, ...], dict[bytes, memoryview]]:
    """Return the parts of a frame, which of them are digests, and the bytes of each digest.

    Its messages are not decoded, and those of a small frame are not even unpacked. The bytes are
    views of the frame.

    Raises:
        SceneError: A large frame is none of viser's.
    """
    if len(frame) <= WHOLE_BYTES:
        return (frame,), (False,), {}
    view = memoryview(frame)
    places = [(a, b) for a, b in places_of_arrays(frame) if b - a >= ARRAY_BYTES]
    edges = [0, *(edge for place in places for edge in place), len(frame)]
    parts: list[bytes] = []
    is_digest: list[bool] = []
    blobs: dict[bytes, memoryview] = {}
    for number, (begin, end) in enumerate(pairwise(edges)):
        if number % 2:
            digest = digest_of(view[begin:end])
            blobs[digest] = view[begin:end]
            parts.append(digest)
        elif begin < end:
            parts.append(frame[begin:end])
        else:
            continue
        is_digest.append(bool(number % 2))
    return tuple(parts), tuple(is_digest), blobs


def join_frame(
    parts: Sequence[bytes], is_digest: Sequence[bool], blob_of: Callable[[bytes], bytes | None]
) -> bytes:
    """Return the frame of these parts; that it is one of viser's is not looked at.

    Args:
        parts: Of `split_frame`.
        is_digest: Of `split_frame`.
        blob_of: Returns the bytes that have this digest.

    Raises:
        SceneError: There is no blob of a digest, or it is not said of each part what it is.
    """
    if len(parts) != len(is_digest):
        raise SceneError(f"{len(parts)} parts of a frame come with {len(is_digest)} marks.")
    if len(parts) == 1 and not is_digest[0]:
        return parts[0]
    joined: list[bytes] = []
    for part, is_name in zip(parts, is_digest, strict=True):
        found = blob_of(part) if is_name else part
        if found is None:
            raise SceneError(f"A frame of the 3D view lacks the bytes with digest {part.hex()}.")
        joined.append(found)
    return b"".join(joined)


class BlobStore:
    """Keeps bytes by their digest: those that were put or asked for last.

    Args:
        bytes_max: Of all together; the last one is kept even if it is larger.
    """

    def __init__(self, bytes_max: int) -> None:
        self._bytes_max = bytes_max
        self._blobs: OrderedDict[bytes, bytes] = OrderedDict()
        self.size = 0
        """Bytes of all together."""

    def put(self, digest: bytes, data: bytes) -> None:
        """Keep them.

        Raises:
            SceneError: These bytes have another digest.
        """
        if digest_of(data) != digest:
            raise SceneError(f"{len(data)} bytes for the 3D view are not those of {digest.hex()}.")
        self.size += len(data) - len(self._blobs.pop(digest, b""))
        self._blobs[digest] = data
        while self.size > self._bytes_max and len(self._blobs) > 1:
            _, oldest = self._blobs.popitem(last=False)
            self.size -= len(oldest)

    def get(self, digest: bytes) -> bytes | None:
        """Return the bytes; None if they are not there (any more)."""
        data = self._blobs.get(digest)
        if data is not None:
            self._blobs.move_to_end(digest)
        return data
