"""A Line: messages to the other side in their order, sealed; and what comes from there.

What was sent and is not confirmed yet is what waits: a line that is slow holds back as a slow
browser's socket does.
"""

from __future__ import annotations

import queue
import threading
import time
from collections import deque
from typing import TYPE_CHECKING, Final, Protocol

from studio.errors import RelayLineError
from studio.ros.wire.zenoh import ZError
from studio.server.relays.messages import encode
from studio.server.relays.sealing import Joiner, split

if TYPE_CHECKING:
    import asyncio
    from collections.abc import Callable, Iterable

    from studio.ros.wire.zenoh import Outgoing
    from studio.server.relays.messages import Down, Up
    from studio.server.relays.sealing import Opener, Sealer

_LATE_S: Final = 0.3
"""While what was sent is confirmed within this time, the line counts as empty."""
_UNCONFIRMED_MAX: Final = 8 << 20
_CONFIRM_BYTES: Final = 64 << 10
_CONFIRM_S: Final = 0.05
_MESSAGE, _CONFIRMED = b"m", b"c"
"""First byte of a message, and of how many bytes of messages came."""


class Ends(Protocol):
    """Who uses the line; called on the loop's thread."""

    def take(self, data: bytes, /) -> None:
        """Take a message that came."""
        ...

    def missed(self) -> None:
        """Messages that were sent did not come."""
        ...


class Line:
    """One end of a line, used on the loop's thread; two threads send and open for it.

    Args:
        loop: Where messages are taken.
        open_publisher: Opens what they are sent by, in the thread that sends; it may wait.
        keys: Seal what goes, and open what comes.
    """

    def __init__(
        self,
        loop: asyncio.AbstractEventLoop,
        open_publisher: Callable[[], Outgoing],
        keys: tuple[Sealer, Opener],
    ) -> None:
        self._loop, self._open_publisher = loop, open_publisher
        self._sealer, self._opener = keys
        self._joiner = Joiner()
        self._ends: Ends | None = None
        self._early: list[tuple[list[bytes], bool]] = []
        self._outgoing: queue.SimpleQueue[bytes | None] = queue.SimpleQueue()
        self._unconfirmed: deque[tuple[int, float]] = deque()
        """The end of each message in the stream, in bytes, and when it was sent."""
        self._resumes: list[Callable[[], object]] = []
        self.sent_bytes = self.confirmed_bytes = self.received_bytes = 0
        self.refused = 0
        """Messages that were forged, sent again, or out of their order."""
        self._confirmed_to_them = 0
        self._confirming: asyncio.TimerHandle | None = None
        self.closed = False
        self._sending = threading.Thread(target=self._send_all, name="relay-line", daemon=True)
        self._sending.start()

    def begin(self, ends: Ends) -> None:
        """Hand over what comes, and what came before."""
        self._ends = ends
        early, self._early = self._early, []
        for messages, gap in early:
            self._take(messages, gap=gap)

    def send(self, message: Up | Down) -> None:
        """Send a message; it never waits."""
        self.write(encode(message))

    def write(self, data: bytes, /) -> None:
        """Send a message that is encoded already."""
        if not self.closed:
            self.sent_bytes += len(data)
            self._unconfirmed.append((self.sent_bytes, time.monotonic()))
            self._outgoing.put(_MESSAGE + data)

    def pending_bytes(self) -> int:
        """Bytes that wait on the way; 0 while the other side is not late."""
        unconfirmed = self.sent_bytes - self.confirmed_bytes
        return unconfirmed if self.lag_s > _LATE_S or unconfirmed > _UNCONFIRMED_MAX else 0

    @property
    def lag_s(self) -> float:
        """Age of the oldest message that is not confirmed."""
        return time.monotonic() - self._unconfirmed[0][1] if self._unconfirmed else 0.0

    def on_drain(self, resume: Callable[[], object]) -> None:
        """Call `resume` whenever something was confirmed."""
        self._resumes.append(resume)

    def off_drain(self, resume: Callable[[], object]) -> None:
        """Call it no more."""
        if resume in self._resumes:
            self._resumes.remove(resume)

    def feed(self, sealed: Iterable[bytes]) -> None:
        """Open what came, in the one thread that reads it."""
        whole: list[bytes] = []
        gap = False
        for one in sealed:
            try:
                opened = self._opener.open(one)
                gap |= opened.gap
                joined = self._joiner.take(opened.data, gap=opened.gap)
            except RelayLineError:
                self.refused += 1
                continue
            if joined is not None:
                whole.append(joined)
        if (whole or gap) and not self._loop.is_closed():
            self._loop.call_soon_threadsafe(lambda: self._take(whole, gap=gap))

    def close(self) -> None:
        """Send and take nothing more."""
        self.closed = True
        self._ends = None
        self._resumes.clear()
        self._outgoing.put(None)
        if self._confirming is not None:
            self._confirming.cancel()

    def _take(self, messages: list[bytes], *, gap: bool) -> None:
        if self.closed:
            return
        if self._ends is None:
            self._early.append((messages, gap))
            return
        if gap:
            self._ends.missed()
        for data in messages:
            if data[:1] == _CONFIRMED:
                self._confirmed(int.from_bytes(data[1:9], "little"))
            else:
                self.received_bytes += len(data) - 1
                self._ends.take(data[1:])
            if self.closed:
                return
        self._confirm_soon()

    def _confirmed(self, size: int) -> None:
        """The other side has so many bytes of ours."""
        self.confirmed_bytes = min(max(self.confirmed_bytes, size), self.sent_bytes)
        while self._unconfirmed and self._unconfirmed[0][0] <= self.confirmed_bytes:
            self._unconfirmed.popleft()
        for resume in tuple(self._resumes):
            resume()

    def _confirm_soon(self) -> None:
        if self.received_bytes - self._confirmed_to_them >= _CONFIRM_BYTES:
            self._confirm()
        elif self._confirming is None and self.received_bytes > self._confirmed_to_them:
            self._confirming = self._loop.call_later(_CONFIRM_S, self._confirm)

    def _confirm(self) -> None:
        if self._confirming is not None:
            self._confirming.cancel()
            self._confirming = None
        self._confirmed_to_them = self.received_bytes
        if not self.closed:
            self._outgoing.put(_CONFIRMED + self.received_bytes.to_bytes(8, "little"))

    def _send_all(self) -> None:
        """Seal and send, in a thread: Zenoh waits while the network takes nothing."""
        try:
            publisher = self._open_publisher()
            while (data := self._outgoing.get()) is not None:
                for piece in split(data):
                    publisher.put(self._sealer.seal(piece))
        except (ZError, RelayLineError):  # the session has ended, and whoever watches it is told
            return
