"""The pool of domains and certificates, all of it made from one secret; and the lines to copy."""

from __future__ import annotations

import hmac
import secrets
from datetime import UTC, datetime, timedelta
from typing import TYPE_CHECKING, Final

from studio.ros.wire.credentials import Credentials

if TYPE_CHECKING:
    from cryptography.hazmat.primitives.asymmetric.ec import EllipticCurvePrivateKey

POOL_SIZE: Final = 60
"""Domains of one class; Zenoh reads its rules at the start, so all are made at once."""
_FIRST: Final = 41
"""Up to 101 a domain is usable on every system by every middleware of ROS 2."""
_LIFE: Final = timedelta(days=120)
_CLOCKS_APART: Final = timedelta(days=1)
_AUTHORITY: Final = "Nodes of a class"
_ROUTER: Final = "Router of a class"
_STUDIO: Final = "studio"


def new_secret() -> str:
    """Return what a pool is made from, in hex."""
    return secrets.token_hex(32)


def pool_domains(taken: int) -> tuple[int, ...]:
    """Return the domains of a pool, without the one that the class itself is in."""
    domains = range(_FIRST, _FIRST + POOL_SIZE + 1)
    return tuple(one for one in domains if one != taken)[:POOL_SIZE]


class Pool:
    """Certificates of the router, of the studio, and of the users of the domains.

    Args:
        secret: Of `new_secret`; the same one makes the same keys, so that a line which was copied
            before the studio was started anew is still valid.
        domains: One for each user.
    """

    def __init__(self, secret: str, domains: tuple[int, ...]) -> None:
        self.secret, self.domains = secret, domains
        self._now = datetime.now(UTC)
        self._authority = self._signed(_AUTHORITY)

    @property
    def router(self) -> Credentials:
        """Of the router."""
        return self._credentials(_ROUTER)

    @property
    def studio(self) -> Credentials:
        """Of the studio, which looks into all domains."""
        return self._credentials(_STUDIO)

    @property
    def studio_name(self) -> str:
        """The common name of the studio's certificate."""
        return _STUDIO

    def name_of(self, domain: int) -> str:
        """Return the common name of the certificate of a domain's user."""
        return f"domain-{domain}"

    def of(self, domain: int) -> Credentials:
        """Return the credentials of a domain's user."""
        return self._credentials(self.name_of(domain))

    def _credentials(self, name: str) -> Credentials:
        return Credentials(self._authority, self._signed(name), self._key_text(name))

    def _key(self, name: str) -> EllipticCurvePrivateKey:
        from cryptography.hazmat.primitives.asymmetric import ec  # noqa: PLC0415 - takes its time

        made = hmac.new(bytes.fromhex(self.secret), name.encode(), "sha512").digest()
        order = ec.SECP256R1().group_order
        return ec.derive_private_key(int.from_bytes(made) % (order - 1) + 1, ec.SECP256R1())

    def _key_text(self, name: str) -> str:
        from cryptography.hazmat.primitives import serialization  # noqa: PLC0415

        return (
            self._key(name)
            .private_bytes(
                serialization.Encoding.PEM,
                serialization.PrivateFormat.PKCS8,
                serialization.NoEncryption(),
            )
            .decode()
        )

    def _signed(self, name: str) -> str:
        """Return the certificate of a name in PEM, signed by the authority."""
        from cryptography import x509  # noqa: PLC0415
        from cryptography.hazmat.primitives import hashes, serialization  # noqa: PLC0415
        from cryptography.x509.oid import ExtendedKeyUsageOID, NameOID  # noqa: PLC0415

        def named(text: str) -> x509.Name:
            return x509.Name([x509.NameAttribute(NameOID.COMMON_NAME, text)])

        made = (
            x509.CertificateBuilder()
            .subject_name(named(name))
            .issuer_name(named(_AUTHORITY))
            .public_key(self._key(name).public_key())
            .serial_number(x509.random_serial_number())
            .not_valid_before(self._now - _CLOCKS_APART)
            .not_valid_after(self._now + _LIFE)
            .add_extension(x509.BasicConstraints(name == _AUTHORITY, None), critical=True)
        )
        if name != _AUTHORITY:
            # Else a student could pass for the router.
            usages = ExtendedKeyUsageOID
            usage = usages.SERVER_AUTH if name == _ROUTER else usages.CLIENT_AUTH
            made = made.add_extension(x509.ExtendedKeyUsage([usage]), critical=False)
        signed = made.sign(self._key(_AUTHORITY), hashes.SHA256())
        return signed.public_bytes(serialization.Encoding.PEM).decode()


def environment_of(endpoint: str, domain: int, credentials: Credentials) -> dict[str, str]:
    """Return the variables by which ROS's nodes, and those of this house, join a domain."""
    keys = {
        "mode": '"client"',
        "connect/endpoints": f'["{endpoint}"]',
        **credentials.of_session(),
    }
    return {
        "RMW_IMPLEMENTATION": "rmw_zenoh_cpp",
        "ROS_DOMAIN_ID": str(domain),
        "ZENOH_CONFIG_OVERRIDE": ";".join(f"{key}={json5}" for key, json5 in keys.items()),
    }


def shell_line(environment: dict[str, str]) -> str:
    """Return the line for the shells of Linux and macOS; no value has a quote."""
    return "export " + " ".join(f"{name}='{value}'" for name, value in environment.items())


def powershell_line(environment: dict[str, str]) -> str:
    """Return the line for PowerShell."""
    return "; ".join(f"$env:{name}='{value}'" for name, value in environment.items())
