"""A Line: messages to the other side in their order, sealed; and what comes from there.

What was sent and is not confirmed yet is what waits: a line that is slow holds back as a slow
browser's socket does.
"""

from __future__ import annotations

import logging
import queue
import threading
import time
from collections import deque
from contextlib import suppress
from typing import TYPE_CHECKING, Final, Protocol

from studio.errors import RelayLineError
from studio.ros.wire.zenoh import ZError
from studio.server.relays.messages import encode
from studio.server.relays.sealing import MESSAGE_BYTES_MAX, Joiner, split

if TYPE_CHECKING:
    import asyncio
    from collections.abc import Callable, Iterable

    from studio.ros.wire.zenoh import Outgoing
    from studio.server.relays.messages import Down, Up
    from studio.server.relays.sealing import Opener, Sealer

_LATE_S: Final = 0.3
"""While what was sent is confirmed within this time, the line counts as empty."""
_UNCONFIRMED_MAX: Final = 8 << 20
_OWED_BYTES_MAX, _OWED_MAX = 160 << 20, 200_000
"""Of messages that are not confirmed: with more of them the other side is not there any more."""
_WAITING_BYTES: Final = 16 << 20
"""Of messages that came and were not taken: while there are more, no others are read."""
_WAITING_EACH: Final = 256
"""Counted for each of them, for its place in memory."""
_SLICE_S: Final = 0.005
"""So long messages are taken at once; then it is somebody else's turn on the loop."""
_CONFIRM_BYTES: Final = 64 << 10
_CONFIRM_S: Final = 0.05
_LOOK_EVERY_S: Final = 0.5
_MESSAGE, _CONFIRMED = b"m", b"c"
"""First byte of a message, and of how many bytes of messages came."""
_log = logging.getLogger(__name__)


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
        open_publisher: Opens what they are sent by, in the thread that sends; it may wait for as
            long as what it is given says that the line is open.
        keys: Seal what goes, and open what comes.
        most_bytes: Of a message that comes; a larger one is refused.
    """

    def __init__(
        self,
        loop: asyncio.AbstractEventLoop,
        open_publisher: Callable[[Callable[[], bool]], Outgoing],
        keys: tuple[Sealer, Opener],
        most_bytes: int = MESSAGE_BYTES_MAX,
    ) -> None:
        self._loop, self._open_publisher = loop, open_publisher
        self._sealer, self._opener = keys
        self._joiner = Joiner(most_bytes)
        self._ends: Ends | None = None
        self._arrived: deque[bytes | None] = deque()
        """What came and was not taken; None: messages are missing here."""
        self._room = threading.Condition()
        self._waiting_bytes = 0
        self._is_taking = False
        """Whether the loop was told that something came."""
        self._outgoing: queue.SimpleQueue[bytes | None] = queue.SimpleQueue()
        self._unconfirmed: deque[tuple[int, float]] = deque()
        """The end of each message in the stream, in bytes, and when it was sent."""
        self._resumes: list[Callable[[], object]] = []
        self.sent_bytes = self.confirmed_bytes = self.received_bytes = 0
        self._gone_bytes = 0
        """Of those sent, what Zenoh was given: no more can have come to the other side."""
        self.refused = 0
        """Messages that were forged, sent again, or out of their order."""
        self._confirmed_to_them = 0
        self._confirming: asyncio.TimerHandle | None = None
        self.closed = False
        self._sending = threading.Thread(target=self._send_all, name="relay-line", daemon=True)

    def begin(self, ends: Ends) -> None:
        """Hand over what comes, and what came before; send what waits to be sent."""
        self._ends = ends
        self._sending.start()
        self._take()

    def send(self, message: Up | Down) -> None:
        """Send a message; it never waits."""
        self.write(encode(message))

    def write(self, data: bytes, /) -> None:
        """Send a message that is encoded already; who confirms nothing is given up."""
        if self.closed:
            return
        self.sent_bytes += len(data)
        self._unconfirmed.append((self.sent_bytes, time.monotonic()))
        self._outgoing.put(_MESSAGE + data)
        owed_bytes = self.sent_bytes - self.confirmed_bytes
        if owed_bytes > _OWED_BYTES_MAX or len(self._unconfirmed) > _OWED_MAX:
            self._give_up()

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
        """Open what came, in the one thread that reads it; it waits while too much is not taken."""
        for one in sealed:
            try:
                opened = self._opener.open(one)
                joined = self._joiner.take(opened.data, gap=opened.gap)
            except RelayLineError:
                self.refused += 1
                continue
            if opened.gap:
                self._arrive(None)
            if joined is not None:
                self._arrive(joined)

    def _arrive(self, message: bytes | None) -> None:
        with self._room:
            while self._waiting_bytes > _WAITING_BYTES and not self.closed:
                self._room.wait(_LOOK_EVERY_S)
            self._arrived.append(message)
            self._waiting_bytes += len(message or b"") + _WAITING_EACH
            is_taking, self._is_taking = self._is_taking, True
        if not is_taking and not self._loop.is_closed():
            self._loop.call_soon_threadsafe(self._take)

    def close(self) -> None:
        """Send and take nothing more."""
        self.closed = True
        self._ends = None
        self._resumes.clear()
        self._unconfirmed.clear()
        self._outgoing.put(None)
        with self._room:
            self._arrived.clear()
            self._room.notify_all()
        if self._confirming is not None:
            self._confirming.cancel()

    def _take(self) -> None:
        """Hand over what came, for a moment at most: a flood leaves the loop to others, too."""
        if self._ends is None:
            return
        end_s = time.monotonic() + _SLICE_S
        while self._has_next():
            try:
                self._hand_over(self._next())
            except Exception:  # noqa: BLE001 - a bug of ours ends the line, and nothing else
                _log.exception("What came on a relay's line could not be taken.")
                self._missed()
            if self.closed:
                return
            if time.monotonic() > end_s:
                self._loop.call_soon(self._take)
                break
        self._confirm_soon()

    def _hand_over(self, message: bytes | None) -> None:
        if message is None:
            self._missed()
        elif message[:1] == _CONFIRMED:
            self._confirmed(int.from_bytes(message[1:9], "little"))
        elif self._ends is not None:
            self.received_bytes += len(message) - 1
            self._ends.take(message[1:])

    def _has_next(self) -> bool:
        with self._room:
            self._is_taking = len(self._arrived) > 0
            return self._is_taking

    def _next(self) -> bytes | None:
        with self._room:
            message = self._arrived.popleft()
            self._waiting_bytes -= len(message or b"") + _WAITING_EACH
            self._room.notify_all()
            return message

    def _confirmed(self, size: int) -> None:
        """The other side has so many bytes of ours; or says so."""
        self.confirmed_bytes = min(max(self.confirmed_bytes, size), self._gone_bytes)
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

    def _give_up(self) -> None:
        """End it soon: who sends is in the midst of something."""
        self._unconfirmed.clear()
        self._loop.call_soon(self._missed)

    def _missed(self) -> None:
        if self._ends is not None:
            self._ends.missed()

    def _send_all(self) -> None:
        """Seal and send, in a thread: Zenoh waits while the network takes nothing."""
        try:
            publisher = self._open_publisher(lambda: not self.closed)
            while (data := self._outgoing.get()) is not None:
                if data[:1] == _MESSAGE:  # before it goes, for it may be confirmed at once
                    self._gone_bytes += len(data) - 1
                for piece in split(data):
                    publisher.put(self._sealer.seal(piece))
        except (ZError, RelayLineError) as error:
            # Nobody came, the session has ended, or a message was too large to be sent at all.
            if not (self.closed or self._loop.is_closed()):
                _log.info("A relay's line ends: %s", error)
                with suppress(RuntimeError):  # the loop was closed just now
                    self._loop.call_soon_threadsafe(self._missed)
