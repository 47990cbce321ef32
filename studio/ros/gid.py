"""The 16 bytes that name an endpoint in every sample: a hash of its liveliness token."""

from __future__ import annotations

import xxhash

GID_BYTES = 16


def gid_of(token: str) -> bytes:
    """Give XXH3-128 of the whole token, low half first, each half little endian.

    Peers that are no rmw_zenoh may send anything else, so that a GID nobody's token has is
    no error.
    """
    return xxhash.xxh3_128_digest(token.encode())[::-1]
