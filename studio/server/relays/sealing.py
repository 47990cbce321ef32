"""The stream between relay and studio, sealed from end to end and numbered.

TLS ends at each router on the way, and everybody who has a relay's key can connect to it: what is
sealed here only the two can read and make, and neither repeat, reorder nor leave out unnoticed.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, TypeVar

from studio.errors import RelayLineError

if TYPE_CHECKING:
    from cryptography.hazmat.primitives.ciphers.aead import ChaCha20Poly1305

PUBLIC_BYTES: Final = 32
SEAL_BYTES: Final = 24
"""A sealed message is longer by this."""
MESSAGE_BYTES_MAX: Final = 64 * 1024 * 1024
PIECE_BYTES: Final = 64 * 1024
"""Many pieces may wait to be read, of each line: they bound what that takes."""
_NUMBER_BYTES: Final = 8
_KEY_BYTES: Final = 32
_NONCE_START: Final = b"\0\0\0\0"
_INFO: Final = b"studio relay line 1\0"
_MORE_FOLLOWS: Final = 1
_IS_FIRST: Final = 2

BytesT = TypeVar("BytesT", bytes, bytearray)


class Handshake:
    """A key pair for one line, made anew for each."""

    def __init__(self) -> None:
        from cryptography.hazmat.primitives.asymmetric import x25519  # noqa: PLC0415 - takes time

        self._private = x25519.X25519PrivateKey.generate()
        self._is_used = False
        self.public = self._private.public_key().public_bytes_raw()
        """For the other end, `PUBLIC_BYTES` long; to be signed by who sends it."""

    def keys(
        self, other_public: bytes, transcript: bytes, *, is_origin: bool
    ) -> tuple[Sealer, Opener]:
        """Return the two directions, this end's first; once, for numbers begin anew with them.

        Args:
            other_public: Of the other end, its signature checked before.
            transcript: All that both ends know of each other; where it differs, nothing is opened.
            is_origin: Which of the two this end is.

        Raises:
            RelayLineError: The other's is no public key, or this handshake was used already.
        """
        from cryptography.hazmat.primitives import hashes  # noqa: PLC0415 - takes its time
        from cryptography.hazmat.primitives.asymmetric import x25519  # noqa: PLC0415
        from cryptography.hazmat.primitives.kdf.hkdf import HKDF  # noqa: PLC0415

        if self._is_used:
            raise RelayLineError("its handshake came twice.")
        try:
            other = x25519.X25519PublicKey.from_public_bytes(other_public)
            shared = self._private.exchange(other)
        except ValueError:  # not so long, or one of the points that make no secret
            raise RelayLineError("what came in its handshake is no public key.") from None
        self._is_used = True
        origin, relay = self.public, other_public
        if not is_origin:
            origin, relay = relay, origin
        info = _INFO + origin + relay + transcript
        made = HKDF(hashes.SHA256(), 2 * _KEY_BYTES, None, info).derive(shared)
        to_relay, to_origin = made[:_KEY_BYTES], made[_KEY_BYTES:]
        if is_origin:
            return Sealer(to_relay), Opener(to_origin)
        return Sealer(to_origin), Opener(to_relay)


class Sealer:
    """Seals one direction; for one thread."""

    def __init__(self, key: bytes) -> None:
        """Begin at number 1; a second one of the same key would give both away."""
        self._cipher, self._number = _cipher(key), 0

    def seal(self, data: bytes) -> bytes:
        """Return the number, and the data as only the other end reads them."""
        self._number += 1
        number = self._number.to_bytes(_NUMBER_BYTES, "little")
        return number + self._cipher.encrypt(_NONCE_START + number, data, None)


@dataclass(frozen=True, slots=True)
class Opened:
    """A message that the other end sealed; `gap`: others before it never came."""

    data: bytes
    gap: bool


class Opener:
    """Opens one direction; for one thread. What is refused changes nothing but its counts."""

    def __init__(self, key: bytes) -> None:
        self._cipher, self._number = _cipher(key), 0
        self.replayed = 0
        self.forged = 0

    def open(self, sealed: bytes) -> Opened:
        """Open a message.

        Raises:
            RelayLineError: It came before, or after a later one, or the other end did not seal it.
        """
        from cryptography.exceptions import InvalidTag  # noqa: PLC0415 - takes its time

        if len(sealed) < SEAL_BYTES:
            self.forged += 1
            raise RelayLineError("a message is too short to be sealed.")
        number = int.from_bytes(sealed[:_NUMBER_BYTES], "little")
        if number <= self._number:
            self.replayed += 1
            raise RelayLineError("a message came again, or too late.")
        view = memoryview(sealed)
        nonce = _NONCE_START + sealed[:_NUMBER_BYTES]
        try:
            data = self._cipher.decrypt(nonce, view[_NUMBER_BYTES:], None)
        except InvalidTag:
            self.forged += 1
            raise RelayLineError("a message was changed, or is of somebody else.") from None
        gap, self._number = number != self._number + 1, number
        return Opened(data, gap)


def _cipher(key: bytes) -> ChaCha20Poly1305:
    from cryptography.hazmat.primitives.ciphers import aead  # noqa: PLC0415 - takes its time

    return aead.ChaCha20Poly1305(key)


def split(data: bytes, most: int = PIECE_BYTES) -> list[bytes]:
    """Return the pieces of a message, each of at most `most` bytes and a mark; at least one.

    Raises:
        RelayLineError: It is larger than `MESSAGE_BYTES_MAX`.
    """
    if len(data) > MESSAGE_BYTES_MAX:
        raise RelayLineError(
            f"a message has {len(data)} bytes, {MESSAGE_BYTES_MAX} are the most that it carries."
        )
    view = memoryview(data)
    starts = range(0, len(data) or 1, most)
    return [
        b"".join((_mark(start == 0, start + most < len(data)), view[start : start + most]))
        for start in starts
    ]


def _mark(is_first: bool, more_follows: bool) -> bytes:  # noqa: FBT001
    return bytes((is_first * _IS_FIRST | more_follows * _MORE_FOLLOWS,))


class Joiner:
    """Joins the pieces of messages of at most `most_bytes`; for one thread."""

    def __init__(self, most_bytes: int = MESSAGE_BYTES_MAX) -> None:
        self._most_bytes = most_bytes
        self._half: bytearray | None = None
        self._skips = False

    def take(self, piece: bytes, *, gap: bool) -> bytes | None:
        """Return the message that this piece completes, None when more follow.

        Args:
            piece: As `split` made it.
            gap: Pieces before it are missing: the half message is dropped, and so is the rest of
                one whose beginning is.

        Raises:
            RelayLineError: No `split` makes such pieces, or they are too many; the half message is
                dropped.
        """
        if gap:
            self._half, self._skips = None, True
        half, self._half = self._half, None
        if not piece or piece[0] > _IS_FIRST | _MORE_FOLLOWS:
            raise RelayLineError("a piece of a message has no mark.")
        more_follows = bool(piece[0] & _MORE_FOLLOWS)
        if piece[0] & _IS_FIRST:
            if half is not None:
                raise RelayLineError("a message began within another.")
            self._skips = False
            if not more_follows:
                return self._bounded(piece[1:])
            half = bytearray()
        elif self._skips:
            return None
        elif half is None:
            raise RelayLineError("a piece came of a message that did not begin.")
        half += memoryview(piece)[1:]
        self._bounded(half)
        if not more_follows:
            return bytes(half)
        self._half = half
        return None

    def _bounded(self, message: BytesT) -> BytesT:
        if len(message) > self._most_bytes:
            raise RelayLineError(f"a message has more than {self._most_bytes} bytes.")
        return message
