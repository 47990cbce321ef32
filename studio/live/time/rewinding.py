"""Rewinding: the last minutes, shown by a few documents at once, while the next wait in order."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Final

from studio.live.time.shown import ShownRecording
from studio.live.time.ticks import RecordingTicks

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.live.time.past import LivePast

SEATS: Final = 8
"""Each shown past costs a reader of its own, and drawing."""


class Rewinding:
    """Gives out places to look back from; used on the event loop only.

    Attributes:
        past: What is looked at.
        ticks: Its errors and warnings.
    """

    def __init__(self, past: LivePast) -> None:
        self.past, self.ticks = past, RecordingTicks(past)
        self._seated: list[Seat] = []
        self._waiting: list[Seat] = []
        self._loop: asyncio.AbstractEventLoop | None = None
        past.on_clear = self._cleared_in_thread

    @property
    def is_possible(self) -> bool:
        """Whether anything is kept."""
        return self.past.is_keeping and self.past.end_ns > 0

    def ask(
        self,
        granted: Callable[[], object],
        moved: Callable[[], object],
        ended: Callable[[], object],
    ) -> Seat:
        """Ask for a place; it is granted at once where one is free.

        Args:
            granted: Called when it is granted later.
            moved: Called when fewer wait before it.
            ended: Called when all was forgotten, after which the place is lost.
        """
        self._loop = asyncio.get_running_loop()
        made = Seat(self, granted, moved, ended)
        (self._seated if len(self._seated) < SEATS else self._waiting).append(made)
        return made

    def place_of(self, seat: Seat) -> int:
        """Return how many are to leave before it is granted; 0: it is."""
        return self._waiting.index(seat) + 1 if seat in self._waiting else 0

    def leave(self, seat: Seat) -> None:
        """Give a place up, or stop waiting for one; again is harmless."""
        if seat in self._waiting:
            self._waiting.remove(seat)
        elif seat in self._seated:
            self._seated.remove(seat)
            if self._waiting:
                following = self._waiting.pop(0)
                self._seated.append(following)
                following.granted()
        else:
            return
        for one in tuple(self._waiting):
            one.moved()

    def leave_in_thread(self, seat: Seat) -> None:
        """Give a place up; from any thread."""
        if self._loop is not None and not self._loop.is_closed():
            self._loop.call_soon_threadsafe(self.leave, seat)

    def _cleared_in_thread(self) -> None:
        if self._loop is not None and not self._loop.is_closed():
            self._loop.call_soon_threadsafe(self._cleared)

    def _cleared(self) -> None:
        ended, self._seated, self._waiting = (*self._seated, *self._waiting), [], []
        for one in ended:
            one.ended()


class Seat:
    """A place from which the past is shown, or waited for."""

    def __init__(
        self,
        rewinding: Rewinding,
        granted: Callable[[], object],
        moved: Callable[[], object],
        ended: Callable[[], object],
    ) -> None:
        self._rewinding = rewinding
        self.granted, self.moved, self.ended = granted, moved, ended

    @property
    def place(self) -> int:
        """How many are to leave before it is granted; 0: it is."""
        return self._rewinding.place_of(self)

    def shown(self) -> ShownRecording:
        """Return the last minutes, to be let go once; with that the place is given up."""
        past = self._rewinding.past
        return ShownRecording(
            past,
            "past",
            close=lambda: self._rewinding.leave_in_thread(self),
            zero_ns=past.zero_ns,
            ticks=self._rewinding.ticks,
        )

    def leave(self) -> None:
        """Give it up."""
        self._rewinding.leave(self)
