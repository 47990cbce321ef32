"""Sends to a client without waiting, and holds back a bounded amount for a slow one."""

from __future__ import annotations

import itertools
from collections import OrderedDict
from typing import TYPE_CHECKING, Protocol, TypeAlias

if TYPE_CHECKING:
    from collections.abc import Callable

GATE_BYTES = 1 << 20
"""While a transport holds more than this, nothing is written to it."""
QUEUE_BYTES = 16 << 20
"""Messages without a key that a client may owe us before it is given up."""

Late: TypeAlias = "Callable[[], bytes]"
"""Makes the bytes of a held-back message when they can be sent; empty: nothing to send."""


class Transport(Protocol):
    """A client's transport: a socket that buffers and never blocks."""

    def write(self, data: bytes, /) -> None:
        """Take one whole message."""
        ...

    def pending_bytes(self) -> int:
        """Bytes taken and not yet handed to the system."""
        ...


class Outlet:
    """Writes while the transport takes bytes; what cannot go now waits, the newest of each key.

    Order is kept: a message never overtakes one that was posted before it; a newer message of a
    key takes a place at the end. Memory of one client: the gate plus one message in its
    transport, one message per key, and `queue_bytes` of messages without a key.

    Args:
        transport: Where the bytes go.
        gate_bytes: Nothing is written while the transport holds more than this.
        fresh_bytes: Nothing that could be made late is written while the transport holds more than
            this and more than the last of its kind: it would be old when it arrives. No event tells
            that a transport holds less than before: whoever gives this calls `resume` regularly.
        queue_bytes: Keyless bytes that may wait; one more and the client is hopeless.
        on_hopeless: Called once, when the client is given up; close its socket there.
    """

    def __init__(
        self,
        transport: Transport,
        *,
        gate_bytes: int = GATE_BYTES,
        fresh_bytes: int | None = None,
        queue_bytes: int = QUEUE_BYTES,
        on_hopeless: Callable[[], None] = lambda: None,
    ) -> None:
        self._transport = transport
        self._gate_bytes, self._queue_bytes = gate_bytes, queue_bytes
        self._on_hopeless = on_hopeless
        self._waiting: OrderedDict[str | int, bytes | Late] = OrderedDict()
        self._fresh_bytes = gate_bytes if fresh_bytes is None else fresh_bytes
        self._late_bytes = 0
        """Of the last message that could have been made late."""
        self._keyless = itertools.count()
        self._keyless_bytes = 0
        self.closed = False

    @property
    def holds_back(self) -> bool:
        """Whether something waits for the transport to drain."""
        return bool(self._waiting)

    def post(self, data: bytes | Late, key: str | None = None, late: Late | None = None) -> bool:
        """Write now, or hold back until `resume`; True when nothing is held back afterwards.

        Args:
            data: One whole message, or what makes it; the same bytes may go to many outlets.
            key: Of one key only the newest is kept; a message that is yet to be made needs one.
            late: With a key: makes the message again when it goes out late, instead of `data`.
        """
        if self.closed:
            return False
        if not self._waiting and self._is_open(late or data):
            self._write(data, late)
            return True
        if key is None:
            assert isinstance(data, bytes)
            self._hold(data)
        else:
            self._waiting.pop(key, None)
            self._waiting[key] = late or data
        return self.resume()

    def resume(self) -> bool:
        """Write what was held back as far as the gate lets it; True when nothing is left."""
        while self._waiting and self._is_open(next(iter(self._waiting.values()))):
            key, data = self._waiting.popitem(last=False)
            if isinstance(key, int) and isinstance(data, bytes):
                self._keyless_bytes -= len(data)
            self._write(data)
        return not self._waiting

    def close(self) -> None:
        """Forget what waits; later posts go nowhere."""
        self.closed = True
        self._waiting.clear()
        self._keyless_bytes = 0

    def _is_open(self, data: bytes | Late) -> bool:
        """Whether it may be written now: `data` as it would wait."""
        pending_bytes = self._transport.pending_bytes()
        if pending_bytes > self._gate_bytes:
            return False
        return isinstance(data, bytes) or pending_bytes <= max(self._fresh_bytes, self._late_bytes)

    def _write(self, data: bytes | Late, late: Late | None = None) -> None:
        made = data if isinstance(data, bytes) else data()
        if not (isinstance(data, bytes) and late is None):
            self._late_bytes = len(made)
        if made or isinstance(data, bytes):
            self._transport.write(made)

    def _hold(self, data: bytes) -> None:
        self._waiting[next(self._keyless)] = data
        self._keyless_bytes += len(data)
        if self._keyless_bytes > self._queue_bytes:
            self.close()
            self._on_hopeless()
