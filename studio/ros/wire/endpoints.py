"""Endpoints of routers as Zenoh writes them, and a probe that finds out what answers there."""

from __future__ import annotations

import ipaddress
import secrets
import socket
import time
from dataclasses import dataclass
from enum import StrEnum

from studio.errors import WireSettingsError

_STREAMS = frozenset({"tcp", "tls"})
_PROTOCOLS = _STREAMS | {"udp", "quic", "ws", "unixsock-stream", "serial", "vsock"}
CONNECT_TIMEOUT_S = 3.0
ANSWER_TIMEOUT_S = 4.0
_HANG_UPS_MAX = 4
_HANG_UP_PAUSE_S = 0.2
_INIT = 0x01
_IS_ANSWER = 0x20
_CLOSE = 0x03
_MESSAGE_ID = 0x1F
_PROTOCOL_VERSION = 9
# A client (2) with an id of 16 bytes, one less than which stands in the upper half.
_CLIENT_WITH_LONG_ID = 0xF2


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


class ProbeResult(StrEnum):
    """What was found at an endpoint."""

    NOBODY = "nobody"
    ZENOH = "zenoh"
    OTHER = "other"
    TLS = "tls"
    """Something is there, behind TLS, where only Zenoh itself can connect."""
    UNKNOWN = "unknown"
    """It cannot be checked without Zenoh."""


def probe(endpoint: Endpoint) -> ProbeResult:
    """Knock at an endpoint and leave; takes 7 s at most, and 1 ms for a router of this machine."""
    if not endpoint.is_stream:
        return ProbeResult.UNKNOWN
    for left in reversed(range(_HANG_UPS_MAX)):
        answer = _probe_once(endpoint)
        if answer is not None:
            return answer
        if left:
            time.sleep(_HANG_UP_PAUSE_S)
    return ProbeResult.OTHER


def _probe_once(endpoint: Endpoint) -> ProbeResult | None:
    """Connect once; None when the other side closed at once, as a router does that is ending."""
    try:
        link = socket.create_connection((endpoint.host, endpoint.port), CONNECT_TIMEOUT_S)
    except OSError:
        return ProbeResult.NOBODY
    with link:
        if link.getsockname() == link.getpeername():
            return ProbeResult.NOBODY  # a socket may connect to itself at a free port
        if endpoint.protocol == "tls":
            return ProbeResult.TLS
        return _answer_on(link)


def _answer_on(link: socket.socket) -> ProbeResult | None:
    """Send the first message of Zenoh's handshake; only Zenoh knows the second."""
    link.settimeout(ANSWER_TIMEOUT_S)
    message = bytes((_INIT, _PROTOCOL_VERSION, _CLIENT_WITH_LONG_ID)) + secrets.token_bytes(16)
    try:
        link.sendall(len(message).to_bytes(2, "little") + message)
        answer = link.recv(3, socket.MSG_WAITALL)
    except TimeoutError:
        return ProbeResult.OTHER
    except OSError:
        return None
    if not answer:
        return None
    return ProbeResult.ZENOH if _is_zenoh(answer) else ProbeResult.OTHER


def _is_zenoh(answer: bytes) -> bool:
    if len(answer) < 3:
        return False
    length, kind = int.from_bytes(answer[:2], "little"), answer[2] & _MESSAGE_ID
    # A router that wants a name and password reports it, and closes.
    hung_up = kind == _CLOSE and length == 2
    return hung_up or (kind == _INIT and bool(answer[2] & _IS_ANSWER))
