"""Rewinding: the last minutes, shown by a few documents at once, while the next wait in order."""

from __future__ import annotations

import asyncio
import contextlib
from typing import TYPE_CHECKING, Final, NamedTuple

from studio.errors import CommandError
from studio.live.time.shown import ShownRecording
from studio.live.time.ticks import RecordingTicks

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from studio.bags.recording import RecordedTopic
    from studio.live.time.past import LivePast

SEATS: Final = 8
"""Each shown past costs a reader of its own, and drawing."""
NOTHING_KEPT: Final = (
    "The document shows what runs now, and nothing of that is kept: open a bag, or connect with a "
    "robot first."
)
_LOOK_EVERY_S: Final = 1.0


class PastFacts(NamedTuple):
    """What was kept when it was looked at; times since the Unix epoch, 0: nothing.

    `epoch` is that of the past: with another one all of this is forgotten.
    """

    epoch: int = -1
    zero_ns: int = 0
    begin_ns: int = 0
    end_ns: int = 0
    size: int = 0
    topics: Sequence[RecordedTopic] = ()
    troubles: Sequence[str] = ()


class Rewinding:
    """Gives out places to look back from; used on the event loop only.

    Attributes:
        past: What is looked at.
        ticks: Its errors and warnings; others once all was forgotten.
        facts: What is kept, not older than a second.
    """

    def __init__(self, past: LivePast) -> None:
        self.past, self.ticks, self.facts = past, RecordingTicks(past), PastFacts()
        self._seated: list[Seat] = []
        self._waiting: list[Seat] = []
        self._followers: list[Callable[[], object]] = []
        self._loop: asyncio.AbstractEventLoop | None = None
        self._looking: asyncio.Task[None] | None = None
        past.on_clear = self._cleared_in_thread

    @property
    def is_possible(self) -> bool:
        """Whether anything is kept."""
        facts, past = self.facts, self.past
        return past.is_keeping and facts.epoch == past.epoch and facts.end_ns > 0

    # Places

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

        Raises:
            CommandError: Nothing is kept.
        """
        self._demand()
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
        self._call(lambda: self.leave(seat))

    def looked_at(self) -> ShownRecording:
        """Return the last minutes without a place, to be asked and not to be shown.

        Raises:
            CommandError: Nothing is kept.
        """
        self._demand()
        return ShownRecording(self.past, "past", zero_ns=self.past.zero_ns, ticks=self.ticks)

    def _demand(self) -> None:
        if not self.is_possible:
            raise CommandError(NOTHING_KEPT)

    # What is kept

    def follow(self, changed: Callable[[], object]) -> None:
        """Call something each second while anything is kept, and once when that ends."""
        self._loop = asyncio.get_running_loop()
        self._followers.append(changed)
        self._look()

    def unfollow(self, changed: Callable[[], object]) -> None:
        """Call it no more; again is harmless."""
        with contextlib.suppress(ValueError):
            self._followers.remove(changed)

    def close(self) -> None:
        """Look no more."""
        self._followers.clear()
        if self._looking is not None:
            self._looking.cancel()

    def _look(self) -> None:
        is_looking = self._looking is not None and not self._looking.done()
        if self.past.is_keeping and not is_looking:
            self._looking = asyncio.create_task(self._keep_looking())

    async def _keep_looking(self) -> None:
        while self.past.is_keeping and self._followers:
            # While much comes, its lock is held for a while.
            found = await asyncio.to_thread(_facts_of, self.past)
            if found.epoch == self.past.epoch:
                self.facts = found
                self._tell()
            await asyncio.sleep(_LOOK_EVERY_S)

    def _tell(self) -> None:
        for one in tuple(self._followers):
            one()

    def _call(self, work: Callable[[], object]) -> None:
        if self._loop is not None and not self._loop.is_closed():
            self._loop.call_soon_threadsafe(work)

    def _cleared_in_thread(self) -> None:
        self._call(self._cleared)

    def _cleared(self) -> None:
        self.ticks = RecordingTicks(self.past)
        self.facts = PastFacts()
        ended, self._seated, self._waiting = (*self._seated, *self._waiting), [], []
        for one in ended:
            one.ended()
        self._tell()
        self._look()


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
        rewinding = self._rewinding
        return ShownRecording(
            rewinding.past,
            "past",
            close=lambda: rewinding.leave_in_thread(self),
            zero_ns=rewinding.past.zero_ns,
            ticks=rewinding.ticks,
        )

    def leave(self) -> None:
        """Give it up."""
        self._rewinding.leave(self)


def _facts_of(past: LivePast) -> PastFacts:
    """In a thread, for it waits until what comes is taken in."""
    epoch, begin_ns, end_ns = past.epoch, past.begin_ns, past.end_ns
    return PastFacts(epoch, past.zero_ns, begin_ns, end_ns, past.size, past.topics, past.troubles)
