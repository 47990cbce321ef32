"""The RelayedScene: a 3D view that is drawn elsewhere, served from the frames that a page gets."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, Final

from studio.errors import SceneError
from studio.scene.kept_messages import KeptMessages
from studio.scene.opened_frames import HeldFrames, closed, opened
from studio.scene.seats import (
    BAD_VERSION,
    RETRY_S,
    SUBPROTOCOL,
    Connection,
    Seat,
    Seats,
    Servings,
    listen,
)
from studio.scene.wire import Packer, message_type

if TYPE_CHECKING:
    import asyncio
    from collections.abc import Callable, Iterable

    from studio.scene.opened_frames import Message, OpenedFrame

_NOT_SHOWN: Final = (
    *("Gui", "RunJavascript", "FileTransfer", "LocalStorage", "Notification", "ShareUrl"),
    *("RegisterCommand", "CommandUpdate", "GetRender"),
)
"""Beginnings of kinds of messages by which another host would act in the page of who looks."""
_PANEL: Final = "GuiSetPanel"
_THEME: Final = "ThemeConfigurationMessage"
_REMOVALS_AT_ONCE: Final = 64
"""So many nodes are removed before those are forgotten that no page has any more."""


class RelayedScene:
    """Serves pages from the frames of another host; used on the thread of `loop` only.

    A page in step gets the frames as they came. One that comes, or comes back from falling behind,
    gets what it misses of the messages that still count. One that comes before the first frame
    waits for it.
    """

    def __init__(self, loop: asyncio.AbstractEventLoop) -> None:
        self._loop = loop
        self._kept = KeptMessages()
        self._held = HeldFrames()
        self._packer = Packer()
        self._stamp_s = 0.0
        self._seats = Seats(lambda: self._kept.newest, self._frame_for)
        self._servings = Servings(loop)
        self._ids = itertools.count()
        self._retry: asyncio.TimerHandle | None = None

    @property
    def message_count(self) -> int:
        """How many messages it keeps for those who come."""
        return len(self._kept)

    def take(self, frame: bytes, *, is_first: bool) -> None:
        """Bring the pages to where the origin is.

        Args:
            frame: As it came from the origin.
            is_first: It is the whole state: the line is new, or was cut. Pages get what differs.

        Raises:
            SceneError: It is no frame of viser's, or a later one came first; nothing changed.
        """
        if self._servings.stopped:
            return
        if not is_first and self._seats.published < 0:
            raise SceneError("A frame of the 3D view came before the first one with all of it.")
        frame_opened = opened(frame)
        _demand_views(frame_opened.messages)
        self._stamp_s = frame_opened.stamp_s
        if not is_first:
            for message in frame_opened.messages:
                self._kept.add(message)
        elif self._seats.published < 0:
            self._begin(frame, frame_opened)
            frame = b""
        else:
            self._kept.renew(frame_opened.messages)
            missed = self._kept.since(self._seats.published)
            frame = closed(missed, self._stamp_s, self._packer) if missed else b""
        self._held.hold(len(frame_opened.frame), frame_opened.arrays)
        self._publish(frame)

    async def serve(
        self,
        connection: Connection,
        allowed: Callable[[str], bool],
        subprotocol: str | None = SUBPROTOCOL,
    ) -> None:
        """Serve viser's page over one accepted websocket until it or this view closes.

        Args:
            connection: The websocket; its socket is closed by the caller.
            allowed: Not asked: what a page says to viser is read and forgotten.
            subprotocol: What the websocket was accepted with; closed at once when it is not
                SUBPROTOCOL.
        """
        if subprotocol != SUBPROTOCOL:
            connection.close(BAD_VERSION)
        elif not self._servings.stopped:
            await self._servings.run(self._serve(connection))

    def close(self) -> None:
        """End the serving of all pages, and take nothing more."""
        self._servings.stop()
        if self._retry is not None:
            self._retry.cancel()

    async def _serve(self, connection: Connection) -> None:
        seat = Seat(next(self._ids), connection, self._seats.catch_up)
        connection.on_drain(seat.outlet.resume)
        self._seats.join(seat)
        try:
            if self._seats.published >= 0:
                seat.resync()
                self._retry_soon()
            await listen(connection, _overhear)
        finally:
            self._seats.leave(seat)

    def _begin(self, frame: bytes, frame_opened: OpenedFrame) -> None:
        for message in frame_opened.messages:
            self._kept.add(message)
        if frame_opened.ends_replay:
            self._seats.remember(frame, self._kept.newest)
        self._seats.published = self._kept.newest  # pages that waited are behind it

    def _publish(self, frame: bytes) -> None:
        self._seats.publish(frame, self._kept.newest)
        if self._kept.removals > _REMOVALS_AT_ONCE:
            has_some = [cursor for cursor in self._seats.cursors.values() if cursor >= 0]
            self._kept.forget_removals(min(has_some, default=self._kept.newest))
        self._retry_soon()

    def _retry_soon(self) -> None:
        """Nothing tells when a page that fell behind has room for what is fresh."""
        if self._retry is None and self._seats.is_behind:
            self._retry = self._loop.call_later(RETRY_S, self._try_again)

    def _try_again(self) -> None:
        self._retry = None
        self._publish(b"")

    def _frame_for(self, seat: Seat, _newest: int) -> tuple[bytes, bool]:
        missed = self._kept.since(seat.cursor)
        if not missed and seat.replayed:
            return b"", True
        frame = closed(missed, self._stamp_s, self._packer, ends_replay=not seat.replayed)
        return frame, True


def _demand_views(messages: Iterable[Message]) -> None:
    """Pass if messages only show something.

    Raises:
        SceneError: One of them does more in a page.
    """
    for message in messages:
        kind = message.kind
        does_more = kind.startswith(_NOT_SHOWN) and not kind.startswith(_PANEL)
        if does_more or (kind == _THEME and message.fields().get("titlebar_content")):
            raise SceneError(f"{kind} is no part of a 3D view that is shown to others.")


def _overhear(raw: bytes) -> None:
    """Check that a page speaks viser's protocol; what it says is not used.

    Raises:
        SceneError: It does not.
    """
    message_type(raw)
