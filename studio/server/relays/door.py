"""The door of a relay: whoever types a class's code there is led to its room."""

from __future__ import annotations

import asyncio
from http import HTTPStatus
from typing import TYPE_CHECKING, Final, Protocol
from urllib.parse import urlencode

from starlette.requests import Request
from starlette.responses import RedirectResponse

from studio.errors import NotJoiningError
from studio.server.joining import GUESSES, Rate, Tries, body_of, fields_of, language_of
from studio.server.pages import Form, join_page

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from starlette.responses import Response
    from starlette.types import Receive, Scope, Send

    from studio.server.front import Front

_PATIENCE_S: Final = 5.0
_IN_ALL: Final = Rate(100.0, 1.0)
"""Fewer than a class takes of its relays, which all are asked."""
PATHS: Final = frozenset({"", "/", "/join"})


class AsksOrigin(Protocol):
    """A room."""

    @property
    def name(self) -> str:
        """The last part of its address."""
        ...

    async def knows(self, code: str, /) -> bool:
        """Return whether this is the code of its class."""
        ...


async def _knowing(room: AsksOrigin, code: str) -> AsksOrigin | None:
    return room if await room.knows(code) else None


class Door:
    """An ASGI application of one page: a form for the code.

    Args:
        rooms: Gives those of the relay.
        front: Reads who asks.
        words: Gives the page's texts in a language.
    """

    def __init__(
        self,
        rooms: Callable[[], Iterable[AsksOrigin]],
        front: Front,
        words: Callable[[str], Mapping[str, str]],
    ) -> None:
        self._rooms, self._front, self._words = rooms, front, words
        self._tries = Tries(GUESSES[0], _IN_ALL)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Show the form, or lead to the room."""
        request = Request(scope, receive)
        answer = await self._led(request) if request.method == "POST" else self._page(request, "")
        answer.headers["connection"] = "close"
        await answer(scope, receive, send)

    async def _led(self, request: Request) -> Response:
        code = fields_of(await body_of(request)).get("code", "").strip()
        caller = self._front.caller(request.scope, request.headers)
        place = caller.address if caller else ""
        try:
            self._tries.begin(place)
        except NotJoiningError as refusal:
            return self._page(request, refusal.why)
        room = await self._room_of(code) if code else None
        if room is None:
            return self._page(request, "nobody", code)
        self._tries.give_back(place)
        # By its path: a form may not lead to another name of this machine.
        way = f"{self._front.base}/{room.name}/join?{urlencode({'code': code})}"
        return RedirectResponse(way, HTTPStatus.SEE_OTHER)

    async def _room_of(self, code: str) -> AsksOrigin | None:
        """Ask all at once: one studio that is slow keeps nobody else's people out."""
        asked = [asyncio.create_task(_knowing(one, code)) for one in self._rooms()]
        try:
            for answered in asyncio.as_completed(asked, timeout=_PATIENCE_S):
                if (room := await answered) is not None:
                    return room
        except TimeoutError:
            pass
        finally:
            for one in asked:
                one.cancel()
        return None

    def _page(self, request: Request, trouble: str, code: str = "") -> Response:
        language = language_of(request.headers)
        form = Form(code=code[:32], trouble=trouble, asks_name=False)
        return join_page(form, self._words(language), language, needs_password=False)
