"""The sealed stream: what comes is what the other end sent, in order, and nothing else."""

from __future__ import annotations

import os

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.errors import RelayLineError
from studio.server.relays.sealing import (
    MESSAGE_BYTES_MAX,
    PIECE_BYTES,
    SEAL_BYTES,
    Handshake,
    Joiner,
    Opener,
    Sealer,
    split,
)


def line() -> tuple[Sealer, Opener]:
    """From an origin to a relay."""
    origin, relay = Handshake(), Handshake()
    sealer, _ = origin.keys(relay.public, b"transcript", is_origin=True)
    _, opener = relay.keys(origin.public, b"transcript", is_origin=False)
    return sealer, opener


def test_each_end_opens_what_the_other_sealed():
    origin, relay = Handshake(), Handshake()
    down, up_opener = origin.keys(relay.public, b"transcript", is_origin=True)
    up, down_opener = relay.keys(origin.public, b"transcript", is_origin=False)
    for data in (b"", b"one", os.urandom(PIECE_BYTES)):
        for sealer, opener in ((down, down_opener), (up, up_opener)):
            sealed = sealer.seal(data)
            assert len(sealed) == len(data) + SEAL_BYTES
            opened = opener.open(sealed)
            assert (opened.data, opened.gap) == (data, False)


def test_messages_are_numbered_from_one_and_the_number_is_in_front():
    sealer, _ = line()
    numbers = [int.from_bytes(sealer.seal(b"same")[:8], "little") for _ in range(3)]
    assert numbers == [1, 2, 3]


def test_what_is_sealed_does_not_show_what_it_holds():
    sealer, _ = line()
    one, other = sealer.seal(b"a" * 64), sealer.seal(b"a" * 64)
    assert b"aaaa" not in one + other
    assert one[8:] != other[8:]


@pytest.mark.parametrize(
    ("transcript", "is_origin"), [(b"transcripts", False), (b"", False), (b"transcript", True)]
)
def test_ends_that_do_not_agree_open_nothing_of_each_other(transcript: bytes, is_origin: bool):
    """On what was said before, or on which of them is the origin."""
    origin, relay = Handshake(), Handshake()
    sealer, opener = origin.keys(relay.public, b"transcript", is_origin=True)
    other_sealer, other_opener = relay.keys(origin.public, transcript, is_origin=is_origin)
    with pytest.raises(RelayLineError):
        other_opener.open(sealer.seal(b"data"))
    with pytest.raises(RelayLineError):
        opener.open(other_sealer.seal(b"data"))


def test_nobody_else_opens_it_and_nothing_of_another_line_is_taken():
    origin, relay, third = Handshake(), Handshake(), Handshake()
    sealer, _ = origin.keys(relay.public, b"transcript", is_origin=True)
    _, opener = third.keys(origin.public, b"transcript", is_origin=False)
    with pytest.raises(RelayLineError):
        opener.open(sealer.seal(b"data"))
    _, relays = relay.keys(origin.public, b"transcript", is_origin=False)
    other_sealer, _ = line()
    with pytest.raises(RelayLineError):
        relays.open(other_sealer.seal(b"data"))
    assert (opener.forged, relays.forged) == (1, 1)


def test_what_an_end_sealed_is_refused_where_it_comes_back_to_it():
    origin, relay = Handshake(), Handshake()
    sealer, opener = origin.keys(relay.public, b"transcript", is_origin=True)
    with pytest.raises(RelayLineError, match="changed"):
        opener.open(sealer.seal(b"data"))


def test_a_handshake_serves_one_line_for_its_numbers_begin_anew():
    origin, relay = Handshake(), Handshake()
    origin.keys(relay.public, b"transcript", is_origin=True)
    with pytest.raises(RelayLineError, match="twice"):
        origin.keys(relay.public, b"transcript", is_origin=True)


@pytest.mark.parametrize(
    "public",
    [b"", b"short", bytes(31), bytes(33), bytes(32), (1).to_bytes(32, "little")],
    ids=["empty", "short", "31", "33", "zero", "small order"],
)
def test_what_is_no_public_key_is_refused_and_the_handshake_is_still_good(public: bytes):
    origin, relay = Handshake(), Handshake()
    with pytest.raises(RelayLineError, match="no public key"):
        origin.keys(public, b"transcript", is_origin=True)
    sealer, _ = origin.keys(relay.public, b"transcript", is_origin=True)
    _, opener = relay.keys(origin.public, b"transcript", is_origin=False)
    assert opener.open(sealer.seal(b"data")).data == b"data"


@given(st.binary(max_size=40), st.data())
def test_a_changed_bit_is_refused_and_the_stream_goes_on(data: bytes, drawn: st.DataObject):
    sealer, opener = line()
    opener.open(sealer.seal(b"before"))
    sealed = sealer.seal(data)
    changed = bytearray(sealed)
    changed[drawn.draw(st.integers(0, len(sealed) - 1))] ^= drawn.draw(st.integers(1, 255))
    with pytest.raises(RelayLineError):
        opener.open(bytes(changed))
    assert opener.forged + opener.replayed == 1
    opened = opener.open(sealed)
    assert (opened.data, opened.gap) == (data, False)


@given(st.binary(max_size=80))
def test_what_nobody_sealed_is_refused(data: bytes):
    _, opener = line()
    with pytest.raises(RelayLineError):
        opener.open(data)
    assert opener.forged + opener.replayed == 1


@given(st.binary(max_size=20), st.integers(0, SEAL_BYTES + 19), st.binary(min_size=1, max_size=4))
def test_a_shorter_or_longer_message_is_refused(data: bytes, kept: int, more: bytes):
    sealer, opener = line()
    sealed = sealer.seal(data)
    for other in (sealed[: min(kept, len(sealed) - 1)], sealed + more):
        with pytest.raises(RelayLineError):
            opener.open(other)
    assert opener.forged == 2


@given(st.lists(st.integers(0, 9), max_size=30))
def test_only_what_is_newer_than_all_before_is_opened_and_gaps_are_noted(order: list[int]):
    sealer, opener = line()
    sealed = [sealer.seal(bytes((at,))) for at in range(10)]
    last, refused = -1, 0
    for at in order:
        if at <= last:
            refused += 1
            with pytest.raises(RelayLineError, match="again, or too late"):
                opener.open(sealed[at])
        else:
            opened = opener.open(sealed[at])
            assert (opened.data, opened.gap) == (bytes((at,)), at != last + 1)
            last = at
    assert (opener.replayed, opener.forged) == (refused, 0)


def test_a_forged_number_far_ahead_keeps_nothing_out():
    sealer, opener = line()
    sealed = sealer.seal(b"data")
    with pytest.raises(RelayLineError, match="changed"):
        opener.open(b"\xff" * 8 + sealed[8:])
    assert not opener.open(sealed).gap


@given(st.binary(max_size=50), st.integers(1, 12))
def test_the_pieces_of_a_message_make_it_again(data: bytes, most: int):
    pieces = split(data, most)
    assert max(map(len, pieces)) <= most + 1
    assert len(pieces) == max(1, -(-len(data) // most))
    joiner = Joiner()
    for _ in range(2):
        made = [joiner.take(piece, gap=False) for piece in pieces]
        assert made == [None] * (len(pieces) - 1) + [data]


@given(st.lists(st.binary(max_size=12), min_size=1, max_size=6), st.integers(1, 4), st.data())
def test_of_what_is_lost_no_half_message_comes(
    messages: list[bytes], most: int, drawn: st.DataObject
):
    """Only whole messages come, in order, and all of which no piece was lost."""
    sealer, opener = line()
    pieces = [
        (at, sealer.seal(piece)) for at, one in enumerate(messages) for piece in split(one, most)
    ]
    lost = drawn.draw(st.sets(st.integers(0, len(pieces) - 1)))
    joiner, came = Joiner(), list[bytes]()
    for at, (_, sealed) in enumerate(pieces):
        if at not in lost:
            opened = opener.open(sealed)
            whole = joiner.take(opened.data, gap=opened.gap)
            if whole is not None:
                came.append(whole)
    halved = {pieces[at][0] for at in lost}
    assert came == [one for at, one in enumerate(messages) if at not in halved]


@pytest.mark.parametrize(
    "pieces",
    [
        [b""],
        [b"\x04data"],
        [b"\xffdata"],
        [b"\x00data"],
        [b"\x01data"],
        [b"\x03data", b"\x02data"],
        [b"\x03data", b"\x03data"],
        [b"\x02data", b"\x00data"],
    ],
)
def test_pieces_that_nobody_split_are_refused(pieces: list[bytes]):
    joiner = Joiner()
    for piece in pieces[:-1]:
        joiner.take(piece, gap=False)
    with pytest.raises(RelayLineError, match=r"piece|began"):
        joiner.take(pieces[-1], gap=False)
    assert joiner.take(b"\x02whole", gap=False) == b"whole"


def test_a_message_of_64_mib_travels_and_no_larger_one():
    data = os.urandom(1 << 20) * 64
    assert len(data) == MESSAGE_BYTES_MAX
    joiner = Joiner()
    *most, last = split(data)
    assert all(len(piece) <= PIECE_BYTES + 1 for piece in (*most, last))
    assert [joiner.take(piece, gap=False) for piece in most] == [None] * len(most)
    assert joiner.take(last, gap=False) == data
    with pytest.raises(RelayLineError, match="most that it carries"):
        split(data + b"x")


@pytest.mark.parametrize("size", [1 << 20, MESSAGE_BYTES_MAX + 1])
def test_a_message_that_does_not_end_is_dropped_at_its_limit(size: int):
    joiner = Joiner()
    piece = bytes(size)
    with pytest.raises(RelayLineError, match="more than"):  # noqa: PT012 - it ends in the loop
        joiner.take(b"\x03" + piece, gap=False)
        for _ in range(MESSAGE_BYTES_MAX // size):
            joiner.take(b"\x01" + piece, gap=False)
    assert joiner.take(b"\x02whole", gap=False) == b"whole"


def test_one_piece_is_bounded_too():
    with pytest.raises(RelayLineError, match="more than"):
        Joiner().take(b"\x02" + bytes(MESSAGE_BYTES_MAX + 1), gap=False)
