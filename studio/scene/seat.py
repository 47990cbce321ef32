"""A Seat: one page that looks at a document, and how far it has followed."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.hub import Outlet

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.scene.connection import Connection

_STREAM = "scene"
_TRY_AGAIN_LATER = 1013


class Seat:
    """Hands frames to one page; one that fell behind gets the state of now when it drains.

    `cursor` is the id of the newest message that the page has; what it missed is never queued,
    but made by `catch_up(seat)` from what still counts when there is room again.
    """

    def __init__(
        self, seat_id: int, connection: Connection, catch_up: Callable[[Seat], bytes]
    ) -> None:
        self.id = seat_id
        self.cursor = -1
        self.replayed = False
        self.outlet = Outlet(connection, on_hopeless=lambda: connection.close(_TRY_AGAIN_LATER))
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
