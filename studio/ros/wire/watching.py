"""RouterWatch: whether a session's router is there, and who is told when it goes or returns."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING, Self

import zenoh

from studio.ros.wire.door import watch_transports
from studio.ros.wire.reading import ReadingThread

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.ros.wire.session import WireSession


class RouterWatch:
    """Follows the links of one session; Zenoh itself mends them, within a second.

    What was declared stands again when a router is back, and so do the tokens of all others.
    """

    def __init__(
        self, wire: WireSession, listener: Callable[[bool], None] = lambda _is_there: None
    ) -> None:
        """Begin to watch.

        Args:
            wire: The session.
            listener: Told whether a router is there each time that this changes, from a thread
                of this watch; it must be quick.
        """
        self._listener = listener
        self._changed = threading.Condition()
        events = watch_transports(wire.zenoh)
        # Those that are there come as events, too, yet whoever asks at once is to be told.
        self._routers = {str(zid) for zid in wire.zenoh.info.routers_zid()}
        self._thread = ReadingThread("ros-router-watch", events, self._take)

    @property
    def is_connected(self) -> bool:
        """Whether a router is there now."""
        return bool(self._routers)

    def wait_for(self, *, connected: bool, timeout_s: float | None = None) -> bool:
        """Wait until a router is there, or none; False when it is not so in time."""
        with self._changed:
            return self._changed.wait_for(lambda: self.is_connected is connected, timeout_s)

    def close(self) -> None:
        """Stop watching; again is harmless."""
        self._thread.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _take(self, events: list[zenoh.TransportEvent]) -> None:
        for event in events:
            before = self.is_connected
            with self._changed:
                self._take_one(event)
                self._changed.notify_all()
            if before is not self.is_connected:
                self._listener(self.is_connected)

    def _take_one(self, event: zenoh.TransportEvent) -> None:
        if event.transport.whatami != zenoh.WhatAmI.ROUTER:
            return
        if event.kind == zenoh.SampleKind.DELETE:
            self._routers.discard(str(event.transport.zid))
        else:
            self._routers.add(str(event.transport.zid))
