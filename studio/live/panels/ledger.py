"""Ledger: deeds of one kind, the last ones kept, and those who are told how they fare."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, Final, Generic, Protocol, TypeVar

from studio.debounce import Throttle
from studio.errors import CommandError
from studio.protocol.listeners import Audience, tell

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.protocol import Event
    from studio.protocol.listeners import Listener

_PAUSE_S: Final = 0.1
"""Between two words about what changed: feedback may come a thousand times a second."""


class Deed(Protocol):
    """Something that was begun and that has an end."""

    deed: int
    """Its number among all of its kind."""

    @property
    def is_over(self) -> bool:
        """Whether it has its end."""
        ...


DeedT = TypeVar("DeedT", bound=Deed)


class Ledger(Generic[DeedT]):
    """Keeps deeds by their numbers; all on the loop.

    Args:
        say: Makes the event of some deeds; the first argument says whether these are all.
        kept: So many that are over are kept.
        running: So many may run at once.
    """

    def __init__(
        self, say: Callable[[bool, tuple[DeedT, ...]], Event], *, kept: int, running: int
    ) -> None:
        self._say, self._kept, self._running = say, kept, running
        self._deeds: dict[int, DeedT] = {}
        self._changed: set[int] = set()
        self._audience = Audience()
        self._throttle = Throttle(self._tell, pause_s=_PAUSE_S)
        self._numbers = itertools.count(1)
        self._closed = False

    def next_number(self) -> int:
        """Give a number for one that is about to begin.

        Raises:
            CommandError: Too many run.
        """
        if sum(not one.is_over for one in self._deeds.values()) >= self._running:
            raise CommandError(
                f"{self._running} of these run already: wait for one to end, or cancel one."
            )
        return next(self._numbers)

    def add(self, deed: DeedT) -> None:
        """Keep one that begins."""
        self._deeds[deed.deed] = deed
        over = [number for number, one in self._deeds.items() if one.is_over]
        for number in over[: max(0, len(over) - self._kept)]:
            del self._deeds[number]
        self.changed(deed)

    def get(self, number: int) -> DeedT:
        """The deed of a number.

        Raises:
            CommandError: It is not known, or not any more.
        """
        found = self._deeds.get(number)
        if found is None:
            raise CommandError(f"Nothing with the number {number} is known: it may be long over.")
        return found

    def all(self) -> tuple[DeedT, ...]:
        """Those that are kept, the oldest first."""
        return tuple(self._deeds.values())

    def under_way(self) -> list[DeedT]:
        """Those that are not over."""
        return [one for one in self._deeds.values() if not one.is_over]

    def changed(self, deed: DeedT) -> None:
        """Have its news be told, soon."""
        if not self._closed:
            self._changed.add(deed.deed)
            self._throttle.trigger()

    def follow(self, listener: Listener) -> None:
        """Tell all that are kept, and what changes from now on."""
        self._audience.add(listener)
        tell(listener, self._say(True, tuple(self._deeds.values())))  # noqa: FBT003 - see `say`

    def unfollow(self, listener: Listener) -> None:
        """Tell no more; the listener need not follow."""
        self._audience.remove(listener)

    @property
    def is_followed(self) -> bool:
        """Whether anybody is told."""
        return len(self._audience) > 0

    async def close(self) -> None:
        """Tell nobody any more."""
        self._closed = True
        await self._throttle.close()

    async def _tell(self) -> None:
        changed, self._changed = self._changed, set()
        if self.is_followed:
            news = tuple(one for number, one in self._deeds.items() if number in changed)
            self._audience.tell(self._say(False, news))  # noqa: FBT003
