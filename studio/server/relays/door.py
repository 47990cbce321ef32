"""The door of a relay: whoever types a class's code there is led to its room."""

from __future__ import annotations

from http import HTTPStatus
from typing import TYPE_CHECKING, Final, Protocol
from urllib.parse import urlencode

from starlette.requests import Request
from starlette.responses import RedirectResponse

from studio.errors import NotJoiningError
from studio.server.joining import GUESSES, Tries, body_of, fields_of
from studio.server.pages import Form, join_page

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from starlette.responses import Response
    from starlette.types import Receive, Scope, Send

    from studio.server.front import Front

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
        self._tries = Tries(*GUESSES)

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
        for room in self._rooms():
            if code and await room.knows(code):
                self._tries.give_back(place)
                query = urlencode({"code": code})
                # By its path: a form may not lead to another name of this machine.
                way = f"{self._front.base}/{room.name}/join?{query}"
                return RedirectResponse(way, HTTPStatus.SEE_OTHER)
        return self._page(request, "nobody", code)

    def _page(self, request: Request, trouble: str, code: str = "") -> Response:
        is_german = request.headers.get("accept-language", "").lower().startswith("de")
        language = "de" if is_german else "en"
        form = Form(code=code[:32], trouble=trouble, asks_name=False)
        return join_page(form, self._words(language), language, needs_password=False)
