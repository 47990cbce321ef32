"""A line that can be cut as a cable is: what is on the way goes no further, and nobody is told."""

from __future__ import annotations

import socket
import struct
import threading
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Generator

_CHUNK_BYTES: Final = 1 << 16
_RESETS: Final = struct.pack("ii", 1, 0)


class CutLine:
    """A TCP proxy on loopback, in threads of its own."""

    def __init__(self, port: int) -> None:
        """Listen, to pass on to this port."""
        self._target = port
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.port = int(self._listener.getsockname()[1])
        self._there, self._back = threading.Event(), threading.Event()
        self._ends: list[socket.socket] = []
        self._flow()
        threading.Thread(target=self._accept, daemon=True).start()

    def cut(self, *, back_flows: bool = False) -> None:
        """Pass on nothing more; or nothing to the port, while what it says still comes back."""
        self._there.clear()
        if not back_flows:
            self._back.clear()

    def go_on(self, *, resets: bool = False) -> None:
        """Pass on again, what waited first; or reset what is open.

        A connection that was begun meanwhile stays silent for ever, as one whose first packet is
        sent again after a minute only.
        """
        if resets:
            self._reset()
        self._flow()

    def close(self) -> None:
        """End all."""
        self._listener.close()
        self._reset()
        self._flow()

    def _flow(self) -> None:
        self._there.set()
        self._back.set()

    def _reset(self) -> None:
        ends, self._ends = self._ends, []
        for one in ends:
            with suppress(OSError):
                one.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, _RESETS)
                one.shutdown(socket.SHUT_RD)
            one.close()

    def _accept(self) -> None:
        with suppress(OSError):
            while True:
                near, _ = self._listener.accept()
                self._ends.append(near)
                if not (self._there.is_set() and self._back.is_set()):
                    continue
                try:
                    far = socket.create_connection(("127.0.0.1", self._target))
                except OSError:
                    near.close()
                    continue
                self._ends.append(far)
                for work in ((near, far, self._there), (far, near, self._back)):
                    threading.Thread(target=_pass_on, args=work, daemon=True).start()


def _pass_on(source: socket.socket, target: socket.socket, flows: threading.Event) -> None:
    with suppress(OSError):
        while True:
            data = source.recv(_CHUNK_BYTES)
            flows.wait()
            if not data:
                break
            target.sendall(data)
    for one in (source, target):
        with suppress(OSError):
            one.shutdown(socket.SHUT_RDWR)


@contextmanager
def cut_line(port: int) -> Generator[CutLine]:
    """A proxy to a port."""
    made = CutLine(port)
    try:
        yield made
    finally:
        made.close()
