"""The port that the studio listens on, and its address."""

from __future__ import annotations

import errno
import os
import socket
from typing import Final

from studio.errors import PortTakenError, SettingsError
from studio.settings import ANY_HOST, ANY_HOSTS, DEFAULT_PORT, LOOPBACK_HOSTS

CODE: Final = "code"
"""The part of an address that holds a one-time code."""
FULL_SCREEN: Final = "fullscreen=1"
"""Has the page begin with the 3D view alone; `model/view.js` reads it."""
_PORTS_TRIED: Final = 100


def bind(host: str, port: int | None) -> socket.socket:
    """Return a listening socket: on the given port, else the default or the next free one.

    Raises:
        PortTakenError: The port that was asked for is taken.
        SettingsError: The host is not one of this machine, or no port is free.
    """
    wanted = range(DEFAULT_PORT, DEFAULT_PORT + _PORTS_TRIED) if port is None else [port]
    for number in wanted:
        try:
            return _listen(host, number)
        except OSError as error:
            if error.errno != errno.EADDRINUSE:
                raise SettingsError(
                    f"The studio cannot listen on {host}, port {number} ({error.strerror}): "
                    "choose another --host or --port."
                ) from error
    if port is not None:
        raise PortTakenError(host, port)
    raise SettingsError(
        f"No port from {wanted[0]} to {wanted[-1]} is free on {host}: choose one with --port."
    )


def _listen(host: str, port: int) -> socket.socket:
    family, kind, protocol, _, address = socket.getaddrinfo(
        host, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE
    )[0]
    listener = socket.socket(family, kind, protocol)
    try:
        if os.name == "posix":  # elsewhere it would share the port with another program
            listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listener.bind(address)
        listener.listen(128)  # now: of two studios that start at once only one gets the port
    except OSError:
        listener.close()
        raise
    return listener


def port_of(listener: socket.socket) -> int:
    """Return the port that it got."""
    return int(listener.getsockname()[1])


def bracketed(host: str) -> str:
    """Return a host as it stands before a port."""
    return f"[{host}]" if ":" in host else host


def page_address(host: str, port: int, base: str = "", *, tls: bool = False) -> str:
    """Return the address of the page for a browser on this machine."""
    name = {ANY_HOST: "127.0.0.1", "::": "::1"}.get(host, host)
    return _address(name, port, base, tls=tls)


def with_token(address: str, token: str) -> str:
    """Return the address with the token that a browser exchanges for a cookie."""
    return f"{address}?token={token}"


def with_code(address: str, code: str) -> str:
    """Return the same with a one-time code instead of the token."""
    return f"{address}?{CODE}={code}"


def lan_addresses(host: str, port: int, base: str = "", *, tls: bool = False) -> tuple[str, ...]:
    """Return where other machines find the page, the likeliest first; nowhere on loopback."""
    if host not in ANY_HOSTS:
        return () if host in LOOPBACK_HOSTS else (_address(host, port, base, tls=tls),)
    names = [own for family, far in _FAR if (own := _own_address(family, far))]
    if host == ANY_HOST:
        names = [name for name in names if ":" not in name]
    names.append(f"{socket.gethostname().lower().removesuffix('.local')}.local")
    return tuple(_address(name, port, base, tls=tls) for name in dict.fromkeys(names))


_FAR: Final = ((socket.AF_INET, "192.0.2.1"), (socket.AF_INET6, "2001:db8::1"))
"""Addresses of documentation (RFC 5737, RFC 3849): to connect a datagram socket sends nothing."""


def _own_address(family: int, far: str) -> str:
    """Return the address of the interface by which this machine reaches others; empty: none."""
    try:
        with socket.socket(family, socket.SOCK_DGRAM) as asking:
            asking.connect((far, 9))
            own: str = asking.getsockname()[0]
    except OSError:
        return ""
    return "" if own.startswith("127.") or own == "::1" else own


def _address(name: str, port: int, base: str, *, tls: bool) -> str:
    scheme = "https" if tls else "http"
    shown = "" if port == (443 if tls else 80) else f":{port}"
    return f"{scheme}://{bracketed(name)}{shown}{base}/"
