"""The pages of one view: those in step share each frame, those behind are caught up."""

from __future__ import annotations

import asyncio
import logging
from typing import TYPE_CHECKING, Any, Protocol, TypeVar

from studio.errors import SceneError
from studio.outlet import Outlet

if TYPE_CHECKING:
    from collections.abc import Callable, Container, Coroutine

VISER_VERSION = "1.1.1"
"""The one version whose insides this room knows."""
SUBPROTOCOL = f"viser-v{VISER_VERSION}"
"""Websocket subprotocol that viser's page offers; accept with it, or refuse the socket."""
BAD_VERSION = 1002
"""Closes a page of another version."""

RETRY_S = 1 / 30
"""Between two attempts to send to a page that fell behind."""
_STREAM = "scene"
_TRY_AGAIN_LATER = 1013
_FRESH_BYTES = 16 << 10
"""A page whose socket holds more does not follow: on a slow line a second of frames, or less."""
_MESSAGE_LIMIT_BYTES = 1 << 20
_INVALID, _TOO_BIG = 1007, 1009
_REMEMBERED = 4
"""Frames that brought pages to the newest message: pages that miss the same share them."""
_T = TypeVar("_T")
logger = logging.getLogger(__name__)


class Connection(Protocol):
    """One accepted websocket of viser's page; messages are binary."""

    async def receive(self) -> bytes | None:
        """Return the next message, or None when the socket is closed."""
        ...

    def write(self, data: bytes, /) -> None:
        """Send one message without waiting."""
        ...

    def pending_bytes(self) -> int:
        """Bytes written and not yet handed to the system."""
        ...

    def on_drain(self, resume: Callable[[], object], /) -> None:
        """Call `resume` on the loop's thread whenever a full buffer has emptied."""
        ...

    def close(self, code: int, /) -> None:
        """Close the socket; `receive` then answers None."""
        ...


class Seat:
    """Hands frames to one page; one that fell behind gets the state of now when it drains.

    `cursor` is the number of the newest message that the page has; what it missed is never queued,
    but made by `catch_up(seat)` from what still counts when there is room again.
    """

    def __init__(
        self, seat_id: int, connection: Connection, catch_up: Callable[[Seat], bytes]
    ) -> None:
        self.id = seat_id
        self.cursor = -1
        self.replayed = False
        """Whether it was told that it has the whole state."""
        self.outlet = Outlet(
            connection,
            fresh_bytes=_FRESH_BYTES,
            on_hopeless=lambda: connection.close(_TRY_AGAIN_LATER),
        )
        self._catch_up = catch_up

    def follow(self, frame: bytes, newest: int) -> None:
        """Send a frame that goes from `cursor` to the message `newest`."""
        if self.outlet.post(frame, _STREAM, late=self._late):
            self.cursor = max(self.cursor, newest)

    def resync(self) -> None:
        """Send all that is newer than `cursor`, now or when there is room."""
        self.outlet.post(self._late, _STREAM)

    async def send(self, data: bytes) -> None:
        """Send a frame for this page alone (viser's producer of one client writes here)."""
        self.outlet.post(data)

    def _late(self) -> bytes:
        return self._catch_up(self)


class Seats:
    """The pages of one view, each at its place in the numbered messages of that view.

    Args:
        newest: Number of the newest message.
        frame_for: Makes a frame of all that a seat misses up to that number, empty for nothing;
            and says whether another seat that misses the same may have it too.
    """

    def __init__(
        self, newest: Callable[[], int], frame_for: Callable[[Seat, int], tuple[bytes, bool]]
    ) -> None:
        self._newest, self._frame_for = newest, frame_for
        self._seats: dict[int, Seat] = {}
        self.cursors: dict[int, int] = {}
        """By seat: the newest message that it has, as of the last frame that was published."""
        self.published = -1
        self._made: dict[tuple[int, bool], bytes] = {}
        """By cursor and whether it was replayed: frames up to the message `_made_for`."""
        self._made_for = -1

    def __bool__(self) -> bool:
        return bool(self._seats)

    @property
    def is_behind(self) -> bool:
        """Whether a page waits for room."""
        return any(seat.outlet.holds_back for seat in self._seats.values())

    def join(self, seat: Seat) -> None:
        """Send it all that is published from now on."""
        self._seats[seat.id] = seat

    def leave(self, seat: Seat) -> None:
        """Send it nothing more."""
        self._seats.pop(seat.id, None)
        seat.outlet.close()
        self.cursors.pop(seat.id, None)

    def publish(self, frame: bytes, newest: int, alone: Container[int] = ()) -> None:
        """Bring every page to the message `newest`.

        Args:
            frame: What goes there from the message that was published last; empty for nothing.
            newest: Number of its last message.
            alone: Seats that must not have this frame.
        """
        self._forget_but(newest)
        for seat in self._seats.values():
            self._advance(seat, frame, newest, alone=seat.id in alone)
        self.published = newest

    def _advance(self, seat: Seat, frame: bytes, newest: int, *, alone: bool) -> None:
        """Bring one page to `newest`, by the shared frame where it fits."""
        if seat.cursor == self.published and not alone:
            if frame:
                seat.follow(frame, newest)
            else:
                seat.cursor = max(seat.cursor, newest)
        elif seat.outlet.holds_back:
            seat.outlet.resume()
        else:
            seat.resync()
        self.cursors[seat.id] = seat.cursor

    def remember(self, frame: bytes, newest: int) -> None:
        """Give this frame, the whole state up to `newest`, to those who come now."""
        self._forget_but(newest)
        self._made[-1, False] = frame

    def catch_up(self, seat: Seat) -> bytes:
        """Return all that this page misses and that still counts; the whole state if it is new."""
        newest = self._newest()
        self._forget_but(newest)
        missed = (seat.cursor, seat.replayed)
        # A class of thirty that opens the page at once is served from one encoding.
        frame = self._made.get(missed)
        if frame is None:
            frame, is_shared = self._frame_for(seat, newest)
            if is_shared:
                if len(self._made) >= _REMEMBERED:
                    del self._made[next(iter(self._made))]
                self._made[missed] = frame
        seat.cursor, seat.replayed = newest, True
        return frame

    def _forget_but(self, newest: int) -> None:
        if self._made_for != newest:
            self._made_for = newest
            self._made.clear()


class Servings:
    """What runs for the pages of a view, until `stop` ends all of it."""

    def __init__(self, loop: asyncio.AbstractEventLoop) -> None:
        self._loop = loop
        self._tasks: set[asyncio.Task[Any]] = set()
        self.stopped = False

    def start(self, work: Coroutine[Any, Any, _T]) -> asyncio.Task[_T]:
        """Run it beside others."""
        task = self._loop.create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)
        return task

    async def run(self, work: Coroutine[Any, Any, None]) -> None:
        """Run it to its end; to be stopped is no error."""
        serving = self.start(work)
        try:
            await serving
        except asyncio.CancelledError:
            if not self.stopped:
                raise
        finally:
            serving.cancel()

    def stop(self) -> None:
        """End all of it."""
        self.stopped = True
        for task in tuple(self._tasks):
            task.cancel()


async def listen(connection: Connection, take: Callable[[bytes], None]) -> None:
    """Read what a page says until it is gone or says what is too long or, by `take`, malformed.

    Args:
        connection: The page's.
        take: Called with each message; raises a SceneError for one that ends the connection.
    """
    try:
        while (raw := await connection.receive()) is not None:
            if len(raw) > _MESSAGE_LIMIT_BYTES:
                connection.close(_TOO_BIG)
                return
            take(raw)
    except SceneError as error:
        logger.info("%s", error)
        connection.close(_INVALID)
