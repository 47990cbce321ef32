"""The port that the studio listens on, and its address."""

from __future__ import annotations

import errno
import os
import socket
from typing import Final

from studio.errors import PortTakenError, SettingsError
from studio.settings import DEFAULT_PORT

CODE: Final = "code"
"""The part of an address that holds a one-time code."""
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


def address(host: str, port: int, token: str | None) -> str:
    """Return the address for a browser on this machine, with the token if one is needed."""
    return _page(host, port) + (f"?token={token}" if token else "")


def code_address(host: str, port: int, code: str) -> str:
    """Return the same with a one-time code instead of the token."""
    return f"{_page(host, port)}?{CODE}={code}"


def _page(host: str, port: int) -> str:
    name = {"0.0.0.0": "127.0.0.1", "::": "::1"}.get(host, host)
    return f"http://[{name}]:{port}/" if ":" in name else f"http://{name}:{port}/"
