"""The relays of a class: other machines that pass it on to more browsers."""

from __future__ import annotations

from typing import Final, Protocol

from studio.errors import CommandError
from studio.protocol.commands import Commands, Scope
from studio.protocol.relays import AddRelay, RemoveRelay
from studio.protocol.relays import Relays as RelaysEvent


class Relays(Protocol):
    """Those that a studio dials."""

    async def add(self, line: str, /) -> None:
        """Share the class by the relay that prints this line, too.

        Raises:
            CommandError: There is no such line, or this studio cannot use relays.
        """
        ...

    async def remove(self, endpoint: str, /) -> None:
        """Share it by this one no more.

        Raises:
            CommandError: It is none of them.
        """
        ...

    def addresses(self) -> tuple[str, ...]:
        """Return where people type the code, of those that are there."""
        ...

    def rooms(self) -> tuple[str, ...]:
        """Return the addresses of the class's page at those that are there."""
        ...

    def guests(self) -> int:
        """Return how many pages are open there of people who are not in the class."""
        ...

    def event(self) -> RelaysEvent:
        """Return them, for presenters."""
        ...


class NoRelays:
    """Of a studio that dials none."""

    async def add(self, line: str, /) -> None:
        """Refuse it."""
        del line
        raise CommandError("This studio cannot use relays: all browsers come to it directly.")

    async def remove(self, endpoint: str, /) -> None:
        """Refuse it."""
        raise CommandError(f"This studio has no relay {endpoint}: it cannot use any.")

    def addresses(self) -> tuple[str, ...]:
        """Return none."""
        return ()

    def rooms(self) -> tuple[str, ...]:
        """Return none."""
        return ()

    def guests(self) -> int:
        """Return 0."""
        return 0

    def event(self) -> RelaysEvent:
        """Return none."""
        return RelaysEvent(relays=())


COMMANDS: Final = Commands[Relays](Scope.STUDIO)
COMMANDS.presenter(AddRelay, lambda relays, c, _: relays.add(c.line))
COMMANDS.presenter(RemoveRelay, lambda relays, c, _: relays.remove(c.endpoint))
