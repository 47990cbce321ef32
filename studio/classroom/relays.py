"""The relays of a class: other machines that pass it on to more browsers."""

from __future__ import annotations

from typing import Final, Protocol

from studio.errors import CommandError
from studio.protocol.commands import Commands, Scope
from studio.protocol.relays import AddRelay, RemoveRelay


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


class NoRelays:
    """Of a studio that dials none."""

    async def add(self, line: str, /) -> None:
        """Refuse it."""
        del line
        raise CommandError("This studio cannot use relays: all browsers come to it directly.")

    async def remove(self, endpoint: str, /) -> None:
        """Refuse it."""
        raise CommandError(f"This studio has no relay {endpoint}: it cannot use any.")


COMMANDS: Final = Commands[Relays](Scope.STUDIO)
COMMANDS.presenter(AddRelay, lambda relays, c, _: relays.add(c.line))
COMMANDS.presenter(RemoveRelay, lambda relays, c, _: relays.remove(c.endpoint))
