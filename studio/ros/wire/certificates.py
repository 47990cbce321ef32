"""Keys that are made from a secret, and certificates by which routers and sessions are known."""

from __future__ import annotations

import hmac
import secrets
from datetime import UTC, datetime, timedelta
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from cryptography.hazmat.primitives.asymmetric.ec import (
        EllipticCurvePrivateKey,
        EllipticCurvePublicKey,
    )

_CLOCKS_APART: Final = timedelta(days=1)


def new_secret() -> str:
    """Return what keys are made from: 32 bytes, in hex."""
    return secrets.token_hex(32)


def derived_key(secret: bytes, name: str) -> EllipticCurvePrivateKey:
    """Return the key of a name (P-256), the same for the same secret."""
    from cryptography.hazmat.primitives.asymmetric import ec  # noqa: PLC0415 - takes its time

    made = hmac.digest(secret, name.encode(), "sha512")
    order = ec.SECP256R1().group_order
    return ec.derive_private_key(int.from_bytes(made) % (order - 1) + 1, ec.SECP256R1())


def key_pem(key: EllipticCurvePrivateKey) -> str:
    """Return a private key in PEM."""
    from cryptography.hazmat.primitives import serialization  # noqa: PLC0415 - takes its time

    return key.private_bytes(
        serialization.Encoding.PEM,
        serialization.PrivateFormat.PKCS8,
        serialization.NoEncryption(),
    ).decode()


def certificate_pem(
    name: str,
    public: EllipticCurvePublicKey,
    issuer: str,
    authority: EllipticCurvePrivateKey,
    *,
    life: timedelta,
    serves: bool | None = None,
) -> str:
    """Return a certificate in PEM: of who listens, who connects, or (None) an authority.

    Who may only connect cannot pass for who listens. It is valid a day ago already, for clocks
    differ.
    """
    from cryptography import x509  # noqa: PLC0415 - takes its time
    from cryptography.hazmat.primitives import hashes, serialization  # noqa: PLC0415
    from cryptography.x509.oid import ExtendedKeyUsageOID, NameOID  # noqa: PLC0415

    def named(text: str) -> x509.Name:
        return x509.Name([x509.NameAttribute(NameOID.COMMON_NAME, text)])

    now = datetime.now(UTC)
    made = (
        x509.CertificateBuilder()
        .subject_name(named(name))
        .issuer_name(named(issuer))
        .public_key(public)
        .serial_number(x509.random_serial_number())
        .not_valid_before(now - _CLOCKS_APART)
        .not_valid_after(now + life)
        .add_extension(x509.BasicConstraints(serves is None, None), critical=True)
    )
    if serves is not None:
        usages = ExtendedKeyUsageOID
        usage = usages.SERVER_AUTH if serves else usages.CLIENT_AUTH
        made = made.add_extension(x509.ExtendedKeyUsage([usage]), critical=False)
    signed = made.sign(authority, hashes.SHA256())
    return signed.public_bytes(serialization.Encoding.PEM).decode()
