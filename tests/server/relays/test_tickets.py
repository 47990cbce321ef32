"""Tickets and the identity of a room: what its studio signed, in one text, and nothing else."""

from __future__ import annotations

import base64
import os
import re
import string

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.classroom.members import readable
from studio.errors import RelayLineError, TicketError
from studio.protocol.classroom import NAME_MAX
from studio.server.relays.tickets import (
    TICKET_LETTERS_MAX,
    RoomIdentity,
    Ticket,
    TicketIssuer,
    read_ticket,
    room_id,
    verify_room,
)

ROOM = RoomIdentity(bytes(range(32)))
ISSUER = TicketIssuer(os.urandom(32), ROOM.id)
PERSON = "0123456789abcdef"
LETTERS = string.ascii_letters + string.digits + "-_"
ORDER = 2**252 + 27742317777372353535851937790883648493
"""Of the group of Ed25519."""


def read(text: str) -> Ticket:
    return read_ticket(text, ISSUER.public, ROOM.id)


@given(st.text(max_size=200).map(readable))
def test_a_ticket_says_who_somebody_is(name: str):
    text = ISSUER.issue(PERSON, name, "student")
    assert read(text) == Ticket(PERSON, name, "student")
    assert re.fullmatch(r"[A-Za-z0-9_.-]+", text)
    assert ISSUER.issue(PERSON, name, "student") == text


@pytest.mark.parametrize("letter", ["a", "ü", "漢", "\U0001f916"])
def test_a_ticket_of_the_longest_name_fits_into_a_cookie(letter: str):
    name = letter * NAME_MAX
    text = ISSUER.issue(PERSON, name, "presenter")
    assert len(text) <= TICKET_LETTERS_MAX
    assert read(text).name == name


def test_what_would_be_too_long_is_not_issued():
    with pytest.raises(ValueError, match="shorter"):
        ISSUER.issue(PERSON, "n" * 300, "student")


@given(st.data())
def test_a_ticket_with_another_letter_is_refused(drawn: st.DataObject):
    text = ISSUER.issue(PERSON, drawn.draw(st.sampled_from(["A", "Ada", "Ada L"])), "student")
    at = drawn.draw(st.integers(0, len(text) - 1))
    letter = drawn.draw(st.one_of(st.sampled_from(LETTERS), st.characters()))
    changed = text[:at] + letter + text[at + 1 :]
    if changed == text:
        assert read(changed).person == PERSON
    else:
        with pytest.raises(TicketError):
            read(changed)


@pytest.mark.parametrize("name", ["A", "Ad", "Ada"])
def test_every_other_last_letter_is_refused(name: str):
    """Some of its bits are unused, with two of these names."""
    text = ISSUER.issue(PERSON, name, "student")
    for letter in set(LETTERS) - {text[-1]}:
        with pytest.raises(TicketError):
            read(text[:-1] + letter)


@given(st.data())
def test_a_ticket_with_a_changed_byte_is_refused(drawn: st.DataObject):
    text = ISSUER.issue(PERSON, "Ada", "student")
    data = bytearray(base64.urlsafe_b64decode(text + "=" * (-len(text) % 4)))
    data[drawn.draw(st.integers(0, len(data) - 1))] ^= drawn.draw(st.integers(1, 255))
    with pytest.raises(TicketError):
        read(base64.urlsafe_b64encode(data).decode().rstrip("="))


@pytest.mark.parametrize("more", ["=", "==", "A", "AA", " ", "\n", ".", "é", "\ud800"])
def test_a_ticket_with_more_around_it_is_refused(more: str):
    for name in ("A", "Ad", "Ada"):
        text = ISSUER.issue(PERSON, name, "student")
        for changed in (text + more, more + text, text[:9] + more + text[9:]):
            with pytest.raises(TicketError):
                read(changed)


def test_a_second_signature_of_the_same_ticket_is_refused():
    """Of Ed25519 the second half may be counted around the group once more, if nobody looks."""
    text = ISSUER.issue(PERSON, "Ada", "student")
    data = base64.urlsafe_b64decode(text + "=" * (-len(text) % 4))
    second = int.from_bytes(data[32:64], "little") + ORDER
    changed = data[:32] + second.to_bytes(32, "little") + data[64:]
    with pytest.raises(TicketError):
        read(base64.urlsafe_b64encode(changed).decode().rstrip("="))


@given(st.text(max_size=500))
def test_any_text_is_refused_in_a_sentence(text: str):
    with pytest.raises(TicketError, match="is not valid"):
        read(text)


@given(st.binary(max_size=300))
def test_any_bytes_are_refused(data: bytes):
    with pytest.raises(TicketError):
        read(base64.urlsafe_b64encode(data).decode().rstrip("="))


def test_a_ticket_is_of_one_room_and_ends_with_the_seed():
    text = ISSUER.issue(PERSON, "Ada", "student")
    other_room, other_seed = (
        TicketIssuer(bytes(32), "otherroom"),
        TicketIssuer(bytes(32), ROOM.id),
    )
    for public, room in (
        (ISSUER.public, "otherroom"),
        (ISSUER.public, ""),
        (other_seed.public, ROOM.id),
        (other_room.public, ROOM.id),
        (b"", ROOM.id),
        (b"\xff" * 32, ROOM.id),
    ):
        with pytest.raises(TicketError):
            read_ticket(text, public, room)


@given(st.integers(0, 8), st.integers(0, 8))
def test_what_is_of_the_room_is_not_taken_for_what_is_of_the_person(one: int, other: int):
    rooms = [ROOM.id[:one], ROOM.id[:other]]
    text = TicketIssuer(bytes(32), rooms[0]).issue(PERSON, "Ada", "student")
    public = TicketIssuer(bytes(32), rooms[1]).public
    if one == other:
        assert read_ticket(text, public, rooms[1]).name == "Ada"
    else:
        with pytest.raises(TicketError):
            read_ticket(text, public, rooms[1])


def test_the_same_seed_makes_the_same_tickets_and_another_key_than_that_of_the_room():
    seed = os.urandom(32)
    one, again = TicketIssuer(seed, ROOM.id), TicketIssuer(seed, ROOM.id)
    text = one.issue(PERSON, "Ada", "helper")
    assert (again.public, again.issue(PERSON, "Ada", "helper")) == (one.public, text)
    assert RoomIdentity(seed).public != one.public


@pytest.mark.parametrize("size", [0, 16, 31, 33])
def test_a_seed_of_another_length_is_refused(size: int):
    with pytest.raises(ValueError, match="32 bytes"):
        TicketIssuer(bytes(size), ROOM.id)
    with pytest.raises(ValueError, match="32 bytes"):
        RoomIdentity(bytes(size))


@given(st.binary(min_size=32, max_size=32))
def test_the_id_of_a_room_is_16_small_letters_and_digits(public: bytes):
    assert re.fullmatch(r"[a-z2-7]{16}", room_id(public))
    assert room_id(public) == room_id(bytes(public))
    assert room_id(public) != room_id(public + b"\0")


def test_a_room_keeps_its_id():
    """Else links to it would lead nowhere."""
    assert (
        ROOM.id == RoomIdentity(bytes(range(32))).id == room_id(ROOM.public) == "ilbkcptelrti7q5y"
    )


def test_what_a_room_signed_is_known_and_nothing_else():
    signature = ROOM.sign(b"said")
    verify_room(ROOM.id, ROOM.public, b"said", signature)
    other = RoomIdentity(os.urandom(32))
    for room, public, data, by in (
        (ROOM.id, ROOM.public, b"other", signature),
        (ROOM.id, ROOM.public, b"said", b""),
        (ROOM.id, ROOM.public, b"said", other.sign(b"said")),
        (ROOM.id, other.public, b"said", other.sign(b"said")),
        (other.id, ROOM.public, b"said", signature),
        (room_id(b""), b"", b"said", signature),
        (room_id(b"\xff" * 32), b"\xff" * 32, b"said", signature),
    ):
        with pytest.raises(RelayLineError, match="line between studio and relay"):
            verify_room(room, public, data, by)


@given(st.integers(0, 63), st.integers(1, 255))
def test_a_changed_signature_of_a_room_is_refused(at: int, by: int):
    signature = bytearray(ROOM.sign(b"said"))
    signature[at] ^= by
    with pytest.raises(RelayLineError, match="not signed by the room"):
        verify_room(ROOM.id, ROOM.public, b"said", bytes(signature))
