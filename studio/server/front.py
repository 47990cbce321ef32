"""What stands before the studio: its names, a sub-path, a proxy; and who asks, seen through it."""

from __future__ import annotations

import ipaddress
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from studio.errors import SettingsError
from studio.server.origin import parse_authority

if TYPE_CHECKING:
    from starlette.datastructures import Headers
    from starlette.types import Scope

    from studio.server.origin import Authority, KnownHosts


_MAPPED: Final = "::ffff:"
"""Before an IPv4 address that came to a socket of IPv6."""


@dataclass(frozen=True, slots=True)
class Caller:
    """Who asks: under which name of ours, from which address, and whether by https."""

    host: Authority
    address: str
    is_secure: bool


class Front:
    """Reads requests as the browser sent them.

    Args:
        hosts: The names of this studio.
        port: The port that it listens on.
        base: The path below which it is reached, as `/studio`; empty: the whole host is ours.
        proxies: Addresses of proxies, whose headers tell who asks.
    """

    def __init__(
        self,
        hosts: KnownHosts,
        port: int,
        base: str = "",
        proxies: frozenset[str] = frozenset(),
    ) -> None:
        self.port, self.base = port, base
        self._hosts, self._proxies = hosts, proxies

    def caller(self, scope: Scope, headers: Headers) -> Caller | None:
        """Return who asks; None if it is not us who is asked."""
        client = scope.get("client")
        address = client[0].removeprefix(_MAPPED) if client else ""
        is_secure = scope["scheme"] in {"https", "wss"}
        is_passed_on = address in self._proxies and "x-forwarded-for" in headers
        given = headers.getlist("host")
        if is_passed_on:
            named = _values(headers, "x-forwarded-host")[-1:]
            given = named or given
            is_secure = _values(headers, "x-forwarded-proto")[-1:] == ["https"] or is_secure
            address = self._farthest(headers, address)
        host = self._host(given)
        return Caller(host, address, is_secure) if host else None

    def enter(self, scope: Scope) -> bool:
        """Take the sub-path off the address; False for the sub-path itself without its slash."""
        path: str = scope["path"]
        if self.base and (path == self.base or path.startswith(f"{self.base}/")):
            if path == self.base:
                return False
            scope["path"] = path[len(self.base) :]
            scope["raw_path"] = scope["raw_path"][len(self.base.encode()) :]
        return True

    def _host(self, given: list[str]) -> Authority | None:
        """Return the one known name that the request is addressed to."""
        host = _only(given)
        return host if host and self._hosts.knows(host) else None

    def _farthest(self, headers: Headers, address: str) -> str:
        """Return the last address before our proxies; what comes before it may be made up."""
        for one in reversed(_values(headers, "x-forwarded-for")):
            if one not in self._proxies:
                return one[:64]
        return address


def _only(given: list[str]) -> Authority | None:
    return parse_authority(given[0]) if len(given) == 1 else None


def _values(headers: Headers, name: str) -> list[str]:
    """Return all values of a header, of all its lines: the nearest proxy wrote the last."""
    return [
        one for line in headers.getlist(name) for part in line.split(",") if (one := part.strip())
    ]


def base_path(text: str) -> str:
    """Return a sub-path as it is used: with a slash before it and none behind, or empty.

    Raises:
        SettingsError: It cannot be part of an address.
    """
    path = "/" + text.strip("/")
    parts = path[1:].split("/")
    if path == "/":
        return ""
    if not all(part and part.isascii() and _is_plain(part) for part in parts):
        raise SettingsError(
            f"{text!r} is no path for --base-path: use letters, digits, dots and dashes, as in "
            "/studio."
        )
    return path


def _is_plain(part: str) -> bool:
    letters = part.replace("-", "").replace("_", "").replace(".", "").replace("~", "")
    return letters.isalnum()


def proxy_addresses(given: list[str]) -> frozenset[str]:
    """Return the addresses of `--trusted-proxy`.

    Raises:
        SettingsError: One is no address.
    """
    try:
        return frozenset(str(ipaddress.ip_address(one)) for one in given)
    except ValueError as error:
        raise SettingsError(
            f"--trusted-proxy takes an IP address, as 127.0.0.1: {error}."
        ) from error
