"""The pool of domains and certificates, all of it made from one secret; and the lines to copy."""

from __future__ import annotations

from datetime import timedelta
from typing import TYPE_CHECKING, Final

from studio.ros.wire.certificates import certificate_pem, derived_key, key_pem
from studio.ros.wire.credentials import Credentials

if TYPE_CHECKING:
    from cryptography.hazmat.primitives.asymmetric.ec import EllipticCurvePrivateKey

POOL_SIZE: Final = 60
"""Domains of one class; Zenoh reads its rules at the start, so all are made at once."""
_FIRST: Final = 41
"""Up to 101 a domain is usable on every system by every middleware of ROS 2."""
_LIFE: Final = timedelta(days=120)
_AUTHORITY: Final = "Nodes of a class"
_ROUTER: Final = "Router of a class"
_STUDIO: Final = "studio"


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
        return Credentials(self._authority, self._signed(name), key_pem(self._key(name)))

    def _key(self, name: str) -> EllipticCurvePrivateKey:
        return derived_key(bytes.fromhex(self.secret), name)

    def _signed(self, name: str) -> str:
        """Return the certificate of a name in PEM, signed by the authority."""
        return certificate_pem(
            name,
            self._key(name).public_key(),
            _AUTHORITY,
            self._key(_AUTHORITY),
            life=_LIFE,
            serves=None if name == _AUTHORITY else name == _ROUTER,
        )


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
