"""Who has control of the shared robot and of the ROS system: one person at a time."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Final, Protocol

if TYPE_CHECKING:
    from collections.abc import Callable

ABSENCE_S: Final = 5.0
"""So long the holder's pages may all be gone: a reload takes less."""
MOVING_S: Final = 12.0
"""The same where a page may go on at another relay."""


class Robot(Protocol):
    """What a person in control can have set going."""

    def release(self, may_go_on: Callable[[str], bool], /) -> None:
        """End what persons steer and publish, but those who have control now."""
        ...

    async def stop(self) -> None:
        """Stop all that pages make robots do."""
        ...


class Control:
    """Holds the name of the holder; used on the event loop only.

    Args:
        on_change: Called after each change with the person who had control before.
    """

    def __init__(self, on_change: Callable[[str], object]) -> None:
        self._on_change = on_change
        self._holder = ""
        self.document = ""
        """The shared document that the holder has control of."""
        self.shown = ""
        """The copy that everybody may see; empty: none."""
        self._absence: asyncio.TimerHandle | None = None

    @property
    def holder(self) -> str:
        """The person who has it; empty: the presenter."""
        return self._holder

    def give(self, person: str, document: str = "") -> None:
        """Give it to a person, of one document; empty: back to the presenter."""
        self.back(self._holder)
        if person != self._holder:
            before, self._holder = self._holder, person
            self.document = document
            self._on_change(before)

    def left(self, person: str, *, may_move: bool = False) -> None:
        """The last page of a person was closed: control returns unless one comes back soon.

        Where relays share the class it `may_move`, which takes a page some seconds.
        """
        if person and person == self._holder and self._absence is None:
            loop = asyncio.get_running_loop()
            absence_s = MOVING_S if may_move else ABSENCE_S
            self._absence = loop.call_later(absence_s, self.give, "")

    def back(self, person: str) -> None:
        """A page of a person is there again."""
        if person == self._holder and self._absence is not None:
            self._absence.cancel()
            self._absence = None

    def close(self) -> None:
        """Wait for nobody any more."""
        self.back(self._holder)
