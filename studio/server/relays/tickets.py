"""Tickets: by them a relay knows the members of a room; and the room itself, by its public key."""

from __future__ import annotations

import base64
import hashlib
import hmac
from typing import TYPE_CHECKING, Final

import msgspec

from studio.errors import RelayLineError, TicketError

if TYPE_CHECKING:
    from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey

TICKET_LETTERS_MAX: Final = 400
ROOM_ID_LETTERS: Final = 16
_SEED_BYTES: Final = 32
_SIGNATURE_BYTES: Final = 64
_TICKETS: Final = b"studio relay ticket 1\0"
_ROOM: Final = b"studio relay room 1\0"
"""What is signed begins with one of these, so that none is taken for the other."""


class Ticket(msgspec.Struct, frozen=True, array_like=True, forbid_unknown_fields=True):
    """Who a member is, as the studio said that owns the room."""

    person: str
    name: str
    role: str


_DECODER: Final = msgspec.msgpack.Decoder(Ticket)


class TicketIssuer:
    """Makes the tickets of a room; another seed makes all of before invalid.

    Args:
        seed: 32 bytes, kept by who owns the room; may be that of its `RoomIdentity`.
        room: The id of the room, in which alone they are valid.

    Raises:
        ValueError: The seed has another length.
    """

    def __init__(self, seed: bytes, room: str) -> None:
        self._private, self._room = _private(seed, _TICKETS), room
        self.public = self._private.public_key().public_bytes_raw()
        """For relays, which check tickets by it."""

    def issue(self, person: str, name: str, role: str) -> str:
        """Return the ticket of a member, always the same, as a cookie takes it.

        Raises:
            ValueError: It has more than `TICKET_LETTERS_MAX` letters.
        """
        body = msgspec.msgpack.encode(Ticket(person, name, role))
        text = _text(self._private.sign(_signed(self._room, body)) + body)
        if len(text) > TICKET_LETTERS_MAX:
            raise ValueError(f"A ticket has {len(text)} letters: give shorter names.")
        return text


def read_ticket(text: str, public: bytes, room: str) -> Ticket:
    """Read a ticket, which is checked first; it ends only with the seed that it was made by.

    Raises:
        TicketError: It is none, or of another room.
    """
    from cryptography.exceptions import InvalidSignature  # noqa: PLC0415 - takes its time
    from cryptography.hazmat.primitives.asymmetric import ed25519  # noqa: PLC0415

    if not 0 < len(text) <= TICKET_LETTERS_MAX:
        raise TicketError("it is empty or too long.")
    try:
        data = base64.urlsafe_b64decode(text + "=" * (-len(text) % 4))
    except ValueError:
        raise TicketError("it is not written as tickets are.") from None
    if _text(data) != text:  # what decodes the same would be a second text of one ticket
        raise TicketError("it is not written as tickets are.")
    signature, body = data[:_SIGNATURE_BYTES], data[_SIGNATURE_BYTES:]
    try:
        key = ed25519.Ed25519PublicKey.from_public_bytes(public)
        key.verify(signature, _signed(room, body))
        return _DECODER.decode(body)
    except (InvalidSignature, ValueError, msgspec.MsgspecError):
        raise TicketError("this room's studio did not make it.") from None


class RoomIdentity:
    """The key pair by which a room is known to relays.

    Args:
        seed: 32 bytes, kept by who owns the room.

    Raises:
        ValueError: The seed has another length.
    """

    def __init__(self, seed: bytes) -> None:
        self._private = _private(seed, _ROOM)
        self.public = self._private.public_key().public_bytes_raw()
        self.id = room_id(self.public)

    def sign(self, data: bytes) -> bytes:
        """Sign as the room; `verify_room` checks it."""
        return self._private.sign(_ROOM + data)


def room_id(public: bytes) -> str:
    """Return the id of the room of a public key: 16 lowercase letters and digits."""
    digest = hashlib.blake2b(public, digest_size=ROOM_ID_LETTERS * 5 // 8).digest()
    return base64.b32encode(digest).decode().lower()


def verify_room(room: str, public: bytes, data: bytes, signature: bytes) -> None:
    """Check that a room has this public key, and signed this.

    Raises:
        RelayLineError: It has not, or did not.
    """
    from cryptography.exceptions import InvalidSignature  # noqa: PLC0415 - takes its time
    from cryptography.hazmat.primitives.asymmetric import ed25519  # noqa: PLC0415

    if room_id(public) != room:
        raise RelayLineError("the public key that came is not that of the room.")
    try:
        ed25519.Ed25519PublicKey.from_public_bytes(public).verify(signature, _ROOM + data)
    except (InvalidSignature, ValueError):
        raise RelayLineError("what came is not signed by the room.") from None


def _private(seed: bytes, purpose: bytes) -> Ed25519PrivateKey:
    from cryptography.hazmat.primitives.asymmetric import ed25519  # noqa: PLC0415 - takes its time

    if len(seed) != _SEED_BYTES:
        raise ValueError(f"A seed has {_SEED_BYTES} bytes, not {len(seed)}.")
    return ed25519.Ed25519PrivateKey.from_private_bytes(hmac.digest(seed, purpose, "sha256"))


def _signed(room: str, body: bytes) -> bytes:
    """Return what is signed of a ticket; no two rooms and bodies make the same."""
    name = room.encode()
    return _TICKETS + len(name).to_bytes(4) + name + body


def _text(data: bytes) -> str:
    return base64.urlsafe_b64encode(data).decode().rstrip("=")
