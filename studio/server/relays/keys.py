"""The key of a relay: by it, relay and studio prove to each other who they are.

A key is a public key of P-256, of the authority that signs the relay's certificate, and a seed, of
which both make the authority that signs the studio's. Who knows the key can connect to the relay,
and cannot pass for it.
"""

from __future__ import annotations

import base64
import hmac
import re
from dataclasses import dataclass, field
from datetime import timedelta
from typing import TYPE_CHECKING, Final

from studio.errors import RelayKeyError, RelayLineError, SettingsError, WireSettingsError
from studio.ros.wire.certificates import certificate_pem, derived_key, key_pem
from studio.ros.wire.credentials import Credentials
from studio.ros.wire.endpoints import parse_endpoint
from studio.server.ports import bracketed

if TYPE_CHECKING:
    from cryptography.hazmat.primitives.asymmetric.ec import (
        EllipticCurvePrivateKey,
        EllipticCurvePublicKey,
    )

    from studio.ros.wire.endpoints import Endpoint

KEY_LETTERS: Final = 68
"""Of a key; 51 bytes, so that no bit of the last letter is unused."""
_SECRET_BYTES: Final = 32
_POINT_BYTES: Final = 33
_SEED_BYTES: Final = 18
_LIFE: Final = timedelta(days=3650)
"""Who has the key makes certificates anew: the end of one would only stop a relay that runs on."""
_AUTHORITY: Final = "Authority of a relay"
_RELAY: Final = "Relay"
_STUDIOS: Final = "Authority of the studios of a relay"
_STUDIO: Final = "Studio"
_SEED: Final = "Seed of the studios of a relay"
_SAYS: Final = b"studio relay says\0"
"""Before what is signed; no certificate begins so."""
_HOST: Final = re.compile(r"[a-z0-9._:%-]+")


class RelayIdentity:
    """What a relay makes of its secret.

    Args:
        secret: Of `new_secret`; the same one makes the same key.

    Raises:
        ValueError: It is no secret.
    """

    def __init__(self, secret: str) -> None:
        self._secret = bytes.fromhex(secret)
        if len(self._secret) != _SECRET_BYTES:
            raise ValueError(f"A relay's secret has {_SECRET_BYTES} bytes, in hex: make a new one.")
        self._authority = derived_key(self._secret, _AUTHORITY)
        self._seed = hmac.digest(self._secret, _SEED.encode(), "sha256")[:_SEED_BYTES]
        self.key = _key_text(_point(self._authority.public_key()) + self._seed)
        """What the relay prints; who has it can connect."""

    @property
    def credentials(self) -> Credentials:
        """To listen by."""
        own = derived_key(self._secret, _RELAY)
        return Credentials(
            _studios(self._seed)[1],
            _certificate(_RELAY, own.public_key(), _AUTHORITY, self._authority, serves=True),
            key_pem(own),
        )

    def sign(self, data: bytes) -> bytes:
        """Sign as the relay; `RelayAddress.verify` checks it."""
        from cryptography.hazmat.primitives import hashes  # noqa: PLC0415 - takes its time
        from cryptography.hazmat.primitives.asymmetric import ec  # noqa: PLC0415

        return self._authority.sign(_SAYS + data, ec.ECDSA(hashes.SHA256()))

    def proves(self, given: str) -> bool:
        """Return whether this is the key, in a time that does not tell how much of it is right."""
        return hmac.compare_digest(given.encode(errors="replace"), self.key.encode())


@dataclass(frozen=True, slots=True)
class RelayAddress:
    """Where a relay is, and its key, which is never shown."""

    endpoint: str
    """`tls/HOST:PORT`"""
    key: str = field(repr=False)

    def __str__(self) -> str:
        return self.endpoint

    @property
    def line(self) -> str:
        """What `studio relay` prints of it, with the key."""
        return f"{self.endpoint}#{self.key}"

    @property
    def credentials(self) -> Credentials:
        """To connect by; each time with another certificate."""
        from cryptography.hazmat.primitives.asymmetric import ec  # noqa: PLC0415 - takes its time

        public, seed = _read_key(self.key)
        authority, _ = _studios(seed)
        own = ec.generate_private_key(ec.SECP256R1())
        return Credentials(
            _anchor(public),
            _certificate(_STUDIO, own.public_key(), _STUDIOS, authority, serves=False),
            key_pem(own),
        )

    def verify(self, data: bytes, signature: bytes) -> None:
        """Check that the relay signed this.

        Raises:
            RelayLineError: It did not.
        """
        from cryptography.exceptions import InvalidSignature  # noqa: PLC0415 - takes its time
        from cryptography.hazmat.primitives import hashes  # noqa: PLC0415
        from cryptography.hazmat.primitives.asymmetric import ec  # noqa: PLC0415

        public, _ = _read_key(self.key)
        try:
            public.verify(signature, _SAYS + data, ec.ECDSA(hashes.SHA256()))
        except InvalidSignature:
            raise RelayLineError("what came is not signed by the relay of this key.") from None


def parse_relay_line(text: str) -> RelayAddress:
    """Read `tls/HOST:PORT#KEY`; blanks, and ends of lines within it, are passed over.

    Raises:
        RelayKeyError: It is none; the text is not repeated, for there may be a key in it.
    """
    address, has_key, key = "".join(text.split()).partition("#")
    if not has_key:
        raise RelayKeyError("it has no # with a key after it")
    try:
        endpoint = parse_endpoint(address)
    except WireSettingsError:
        raise RelayKeyError("what is before its # is no endpoint") from None
    if endpoint.protocol != "tls":
        raise RelayKeyError("it does not begin with tls/")
    host = endpoint.host.encode("idna").decode().lower()
    if not _HOST.fullmatch(host) or "?" in address:
        raise RelayKeyError("what is before its # is more than tls/, a host and a port")
    _read_key(key)
    return RelayAddress(f"tls/{bracketed(host)}:{endpoint.port}", key)


def listening_endpoint(text: str) -> Endpoint:
    """Read where a relay listens.

    Raises:
        WireSettingsError: It is no endpoint.
        SettingsError: It is not encrypted.
    """
    endpoint = parse_endpoint(text)
    if endpoint.protocol != "tls":
        raise SettingsError(
            f"--listen takes an encrypted endpoint, as tls/0.0.0.0:7448, not {text}."
        )
    return endpoint


def _key_text(data: bytes) -> str:
    return base64.urlsafe_b64encode(data).decode()


def _read_key(key: str) -> tuple[EllipticCurvePublicKey, bytes]:
    """Return the authority and the seed of a key, of which there is only one text."""
    from cryptography.hazmat.primitives.asymmetric import ec  # noqa: PLC0415 - takes its time

    if len(key) != KEY_LETTERS:
        raise RelayKeyError(f"its key has {len(key)} letters instead of {KEY_LETTERS}")
    try:
        data = base64.urlsafe_b64decode(key)
        if _key_text(data) != key:
            raise RelayKeyError("its key has a letter that no key has")
        public = ec.EllipticCurvePublicKey.from_encoded_point(ec.SECP256R1(), data[:_POINT_BYTES])
    except ValueError:
        raise RelayKeyError("its key is none: a letter of it was changed") from None
    return public, data[_POINT_BYTES:]


def _studios(seed: bytes) -> tuple[EllipticCurvePrivateKey, str]:
    """Return the authority of the studios, and its certificate."""
    authority = derived_key(seed, _STUDIOS)
    return authority, _certificate(_STUDIOS, authority.public_key(), _STUDIOS, authority)


def _anchor(public: EllipticCurvePublicKey) -> str:
    """Return a certificate of an authority whose private key is not here.

    Of an authority that it is told to trust, TLS takes the name and the public key; who signed it
    is not looked at. So anybody may.
    """
    from cryptography.hazmat.primitives.asymmetric import ec  # noqa: PLC0415 - takes its time

    return _certificate(_AUTHORITY, public, _AUTHORITY, ec.generate_private_key(ec.SECP256R1()))


def _certificate(
    name: str,
    public: EllipticCurvePublicKey,
    issuer: str,
    authority: EllipticCurvePrivateKey,
    *,
    serves: bool | None = None,
) -> str:
    return certificate_pem(name, public, issuer, authority, life=_LIFE, serves=serves)


def _point(public: EllipticCurvePublicKey) -> bytes:
    from cryptography.hazmat.primitives import serialization  # noqa: PLC0415 - takes its time

    return public.public_bytes(
        serialization.Encoding.X962, serialization.PublicFormat.CompressedPoint
    )
