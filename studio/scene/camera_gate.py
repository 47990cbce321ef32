"""A CameraGate: the first camera message of a page at once, then a few per second, newest last."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import asyncio
    from collections.abc import Callable

CAMERA_PERIOD_S = 0.2
"""Orbiting pages send up to 50 a second; nobody needs them that often."""


class CameraGate:
    """Lets one message through per period; of those that came too early the newest follows."""

    def __init__(self, loop: asyncio.AbstractEventLoop, deliver: Callable[[Any], None]) -> None:
        self._loop, self._deliver = loop, deliver
        self._timer: asyncio.TimerHandle | None = None
        self._newest: object | None = None

    def offer(self, message: object) -> None:
        """Deliver now or, when the last one was a moment ago, soon."""
        if self._timer is None:
            self._deliver(message)
            self._timer = self._loop.call_later(CAMERA_PERIOD_S, self._again)
        else:
            self._newest = message

    def close(self) -> None:
        """Forget what waits."""
        if self._timer is not None:
            self._timer.cancel()
        self._newest = None

    def _again(self) -> None:
        self._timer = None
        newest, self._newest = self._newest, None
        if newest is not None:
            self.offer(newest)
