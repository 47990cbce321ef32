from __future__ import annotations

import pytest
import xxhash

from studio.ros.tokens import gid_of

TOKEN = "@ros2_lv/0/a1/0/0/NN/%/%/talker"


def test_a_gid_is_both_halves_little_endian_low_half_first():
    whole = xxhash.xxh3_128_intdigest(TOKEN.encode())
    low, high = whole & (2**64 - 1), whole >> 64
    assert gid_of(TOKEN) == low.to_bytes(8, "little") + high.to_bytes(8, "little")


def test_the_gid_of_nothing_is_the_published_hash_of_nothing():
    # XXH3-128 of no bytes, seed 0, from the test vectors of the algorithm.
    assert gid_of("")[::-1].hex() == "99aa06d3014798d86001c324468d497f"


@pytest.mark.parametrize("more", ["/backends:cpu:", "x"])
def test_every_chunk_of_a_token_counts(more: str):
    assert gid_of(TOKEN + more) != gid_of(TOKEN)
    assert len(gid_of(TOKEN + more)) == 16
