"""Endpoint: where a router listens, as Zenoh writes it, parted into what sockets want."""

from __future__ import annotations

import ipaddress
from dataclasses import dataclass

from studio.errors import WireSettingsError

_STREAMS = frozenset({"tcp", "tls"})
_PROTOCOLS = _STREAMS | {"udp", "quic", "ws", "unixsock-stream", "serial", "vsock"}


@dataclass(frozen=True, slots=True)
class Endpoint:
    """`protocol/host:port`; what follows, metadata and options, is Zenoh's affair.

    Attributes:
        text: As it was given.
        host: A name or address without brackets; empty where the protocol has none.
        port: 0 where the protocol has none.
    """

    text: str
    protocol: str
    host: str = ""
    port: int = 0

    @property
    def is_stream(self) -> bool:
        """Whether a TCP connection shows if anything listens there."""
        return self.protocol in _STREAMS

    @property
    def is_loopback(self) -> bool:
        """Whether only this machine can reach it."""
        if self.host == "localhost":
            return True
        try:
            return ipaddress.ip_address(self.host).is_loopback
        except ValueError:
            return False


def parse_endpoint(text: str) -> Endpoint:
    """Read an endpoint such as `tcp/127.0.0.1:7447` or `tls/[::1]:7447`.

    Raises:
        WireSettingsError: It is none.
    """
    protocol, slash, rest = text.partition("/")
    if not slash or protocol not in _PROTOCOLS or not rest:
        raise _not_understood(text)
    if protocol in {"unixsock-stream", "serial", "vsock"}:
        return Endpoint(text, protocol)
    address = rest.partition("?")[0].partition("#")[0]
    host, colon, port = address.rpartition(":")
    host = host.removeprefix("[").removesuffix("]")
    if not (colon and host and port.isascii() and port.isdigit() and 0 < int(port) <= 65535):
        raise _not_understood(text)
    try:
        host.encode("idna")
    except UnicodeError:
        raise WireSettingsError(
            f'"{host[:200]}" is no host name: each part between its dots has 1 to 63 letters.'
        ) from None
    return Endpoint(text, protocol, host, int(port))


def _not_understood(text: str) -> WireSettingsError:
    return WireSettingsError(
        f'"{text[:200]}" is no endpoint: write protocol/host:port, such as tcp/127.0.0.1:7447.'
    )
