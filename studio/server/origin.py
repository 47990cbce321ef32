"""The host names of this studio, and the origins that may send requests to it."""

from __future__ import annotations

import ipaddress
import socket
from dataclasses import dataclass
from urllib.parse import urlsplit

from studio.settings import ANY_HOSTS, LOOPBACK_HOSTS

_DEFAULT_PORTS = {"http": 80, "https": 443}


@dataclass(frozen=True, slots=True)
class Authority:
    """Name and port of a `Host` header or an origin; `port` None when it is not written."""

    name: str
    port: int | None


def parse_authority(text: str) -> Authority | None:
    """Read `name`, `name:port` or `[v6]:port`; None for anything else."""
    try:
        parts = urlsplit(f"//{text}")
        name, port = parts.hostname, parts.port
    except ValueError:
        return None
    plain = not (parts.path or parts.query or parts.fragment or "@" in parts.netloc)
    return Authority(name, port) if name and plain else None


def is_loopback(host: str) -> bool:
    """Whether only programs of this machine reach a server bound to `host`."""
    if host in LOOPBACK_HOSTS:
        return True
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


@dataclass(frozen=True, slots=True)
class KnownHosts:
    """The names that a `Host` header may carry, against DNS rebinding.

    Beyond loopback any literal address is known: rebinding needs a name.
    """

    names: frozenset[str]
    any_address: bool

    @classmethod
    def of(cls, bound_host: str, public: str = "") -> KnownHosts:
        """Loopback names, the bound host, and the machine's own name when bound to everything.

        Args:
            bound_host: What the studio listens on.
            public: Another name by which others come; empty: there is none.
        """
        names = {*LOOPBACK_HOSTS, bound_host.lower(), public.lower() or bound_host.lower()}
        if bound_host in ANY_HOSTS:
            machine = socket.gethostname().lower()
            names |= {machine, f"{machine}.local"}
        return cls(frozenset(names), any_address=not is_loopback(bound_host))

    def knows(self, host: Authority) -> bool:
        """Whether this studio is called that."""
        return host.name in self.names or (self.any_address and _is_address(host.name))


def _is_address(name: str) -> bool:
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True


def is_same_origin(origin: str, host: Authority) -> bool:
    """Whether a page of `origin` was served under this `Host`; a tunnel may have added TLS."""
    scheme, separator, rest = origin.partition("://")
    default_port = _DEFAULT_PORTS.get(scheme)
    asker = parse_authority(rest) if separator else None
    if asker is None or default_port is None:
        return False
    return (asker.name, asker.port or default_port) == (host.name, host.port or default_port)
