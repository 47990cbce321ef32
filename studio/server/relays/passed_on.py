"""Commands that a relay passed on to the origin, until it has answered them to their pages."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Final

from studio.errors import CommandError
from studio.protocol.commands import COMMAND_LIMIT_BYTES
from studio.protocol.documents import Refused
from studio.protocol.listeners import send
from studio.server.relays.messages import Ask

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.errors import StudioError
    from studio.protocol import Command
    from studio.protocol.listeners import Listener

_PENDING_MAX: Final = 10_000
_PENDING_BYTES_MAX: Final = 32 << 20
_STARTED_ANEW: Final = (
    "The studio was started anew before it answered: see whether this was done, and do it again "
    "if it was not."
)


class _Asked:
    def __init__(self, listener: Listener, request: int, ask: Ask) -> None:
        self.listener, self.request, self.ask = listener, request, ask
        self.was_sent = False
        """To the run of the studio that there is, or was last."""
        self.settled: asyncio.Future[None] = asyncio.get_running_loop().create_future()

    def settle(self) -> None:
        """Nobody waits any more."""
        if not self.settled.done():
            self.settled.set_result(None)

    def refuse(self, error: StudioError) -> None:
        """Answer in the place of the origin."""
        refusal = Refused(request=self.request, kind=type(error).__name__, reason=str(error))
        send(self.listener, refusal)
        self.settle()


class PassedOn:
    """Used on the event loop only.

    Args:
        put: Puts a message on the line; answers whether there is one.
    """

    def __init__(self, put: Callable[[Ask], bool]) -> None:
        self._put = put
        self._asked: dict[int, _Asked] = {}
        self._bytes = 0

    async def ask(self, number: int, page: int, command: Command, listener: Listener) -> None:
        """Ask, and wait until it is answered; on a new line it is asked again.

        Raises:
            CommandError: Too much is asked already, or the command is too long.
        """
        if len(self._asked) >= _PENDING_MAX or self._bytes > _PENDING_BYTES_MAX:
            raise CommandError("Too much is asked for here at once: try again in a moment.")
        if not command.id:  # asked twice it runs once
            now_s = asyncio.get_running_loop().time()
            command = command.model_copy(update={"id": f"{now_s:.6f}-{number}"})
        text = command.model_dump_json().encode()
        if len(text) > COMMAND_LIMIT_BYTES:
            raise CommandError(f"A command of more than {COMMAND_LIMIT_BYTES} bytes is not read.")
        ask = Ask(page, number, text)
        asked = self._asked[number] = _Asked(listener, command.request, ask)
        asked.was_sent = self._put(ask)
        self._bytes += len(text)
        try:
            await asked.settled
        finally:
            self._asked.pop(number, None)
            self._bytes -= len(text)

    def ask_again(self, arrive: Callable[[Listener], object]) -> None:
        """Ask on a new line; `arrive` has the origin know a page before."""
        for asked in self._asked.values():
            arrive(asked.listener)
            asked.was_sent |= self._put(asked.ask)

    def refuse_sent(self) -> None:
        """The studio was started anew: nobody knows whether what was sent before has been done."""
        sent = [one for one in self._asked.values() if one.was_sent]
        self._refuse(CommandError(_STARTED_ANEW), sent)

    def settle(self, number: int) -> None:
        """It was answered."""
        if asked := self._asked.pop(number, None):
            asked.settle()

    def leave(self, page: int) -> None:
        """Nobody waits any more at a page."""
        for number in [one for one, asked in self._asked.items() if asked.ask.page == page]:
            self.settle(number)

    def refuse_all(self, error: StudioError) -> None:
        """Answer all in the place of the origin."""
        self._refuse(error, list(self._asked.values()))

    def _refuse(self, error: StudioError, refused: list[_Asked]) -> None:
        for asked in refused:
            del self._asked[asked.ask.number]
            asked.refuse(error)
