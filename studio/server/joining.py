"""The form by which others join the class: a code, a name, perhaps a password."""

from __future__ import annotations

import time
from collections import OrderedDict
from dataclasses import dataclass
from http import HTTPStatus
from typing import TYPE_CHECKING, Final, Protocol, TypeAlias
from urllib.parse import parse_qs

from fastapi import APIRouter, Request
from starlette.responses import RedirectResponse, Response

from studio.errors import NotJoiningError
from studio.server.crowd import Allowance
from studio.server.guard import JOIN_PATH
from studio.server.pages import Form, join_page, no_access_page

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from studio.protocol.roles import Person
    from studio.server.cookies import Cookies
    from studio.server.front import Caller, Front

Words: TypeAlias = "Mapping[str, str]"
_BODY_LIMIT_BYTES: Final = 4 << 10
_ADDRESSES_MAX: Final = 4_096


class Admits(Protocol):
    """What one has to know to join."""

    @property
    def open(self) -> bool:
        """Whether anybody may."""
        ...

    @property
    def password(self) -> str:
        """Not empty where one is asked for."""
        ...

    def knows_link(self, given: str, /) -> bool:
        """Whether this is the code of the link, which nobody guesses."""
        ...


class Joins(Protocol):
    """The class."""

    @property
    def admission(self) -> Admits:
        """What one has to know."""
        ...

    async def join(self, name: str, code: str, password: str, cookie: str, /) -> Person:
        """Add a person.

        Raises:
            NotJoiningError: They may not join.
        """
        ...

    def cookie_of(self, person: Person, /) -> str:
        """Return the value of the cookie by which a browser is this person again."""
        ...


@dataclass(frozen=True, slots=True)
class Rate:
    """So many at once after a rest, and so many per second."""

    at_once: float
    per_s: float

    def allowance(self) -> Allowance:
        """Return one of which nothing is spent."""
        return Allowance(self.per_s, self.at_once)


class Tries:
    """Limits how often something is tried, by address and in all.

    A try is counted before it is known how it ends, for many may be made at once.
    """

    def __init__(self, of_address: Rate, in_all: Rate) -> None:
        self._rate, self._in_all = of_address, in_all.allowance()
        self._by_address: OrderedDict[str, Allowance] = OrderedDict()

    def begin(self, address: str) -> None:
        """Count a try.

        Raises:
            NotJoiningError: There were too many.
        """
        own = self._of(address)
        if self._spend(own, 1) > 0:
            self._spend(own, -1)
            raise NotJoiningError("tries", "There were too many tries: wait a minute.")

    def give_back(self, address: str) -> None:
        """Count one less: it was none."""
        self._spend(self._of(address), -1)

    def _of(self, address: str) -> Allowance:
        own = self._by_address.pop(address, None) or self._rate.allowance()
        self._by_address[address] = own
        if len(self._by_address) > _ADDRESSES_MAX:
            self._by_address.popitem(last=False)
        return own

    def _spend(self, own: Allowance, count: float) -> float:
        """Count tries; answers for how many seconds there are none left."""
        now_s = time.monotonic()
        return max(own.spend(count, now_s), self._in_all.spend(count, now_s))


GUESSES: Final = Rate(30.0, 0.5), Rate(300.0, 3.0)
"""Wrong codes and passwords of an address, which thirty students may share, and of all together:
the code of six letters is guessed within a year, then."""
_JOINS: Final = Rate(400.0, 1.0), Rate(1_000.0, 5.0)
"""People who join: those of a school come from one address."""


class Joining:
    """The routes and what they need."""

    def __init__(
        self, classroom: Joins, cookies: Cookies, front: Front, words: Callable[[str], Words]
    ) -> None:
        """Take the class and its surroundings; `words` gives the page's texts in a language."""
        self._classroom, self._cookies, self._front = classroom, cookies, front
        self._words = words
        self._tries, self._joins = Tries(*GUESSES), Tries(*_JOINS)

    def router(self) -> APIRouter:
        """Return the one address, with its form and what becomes of it."""
        router = APIRouter()
        for methods, endpoint in ((["GET", "HEAD"], self.form), (["POST"], self.join)):
            router.add_api_route(
                JOIN_PATH,
                endpoint,
                methods=methods,
                include_in_schema=False,
                response_class=Response,
                response_model=None,
            )
        return router

    async def form(self, request: Request) -> Response:
        """Return the form; the code of a link need not be typed."""
        if not self._classroom.admission.open:
            return no_access_page(spent=False)
        caller: Caller = request.scope["state"]["caller"]
        return self._page(request, Form(has_code=bool(self._cookies.code(request.headers, caller))))

    async def join(self, request: Request) -> Response:
        """Make the browser a member, and send it to the robot."""
        caller: Caller = request.scope["state"]["caller"]
        given = fields_of(await body_of(request))
        code = given.get("code", "") or self._cookies.code(request.headers, caller)
        try:
            member = await self._joined(request, caller, given, code)
        except NotJoiningError as refusal:
            form = Form(
                has_code=not given.get("code") and refusal.why != "code" and bool(code),
                code=given.get("code", ""),
                name=given.get("name", ""),
                trouble=refusal.why,
            )
            return self._page(request, form)
        response = RedirectResponse(f"{self._front.base}/", HTTPStatus.SEE_OTHER)
        self._cookies.give_member(response, caller, self._classroom.cookie_of(member))
        return response

    async def _joined(
        self, request: Request, caller: Caller, given: dict[str, str], code: str
    ) -> Person:
        admission = self._classroom.admission
        # Nobody guesses the link: who has it joins though others spend all tries.
        is_guess = bool(admission.password) or not admission.knows_link(code)
        if is_guess:
            self._tries.begin(caller.address)
        self._joins.begin(caller.address)
        cookie = self._cookies.member_cookie(request.headers, caller)
        try:
            member = await self._classroom.join(
                given.get("name", ""), code, given.get("password", ""), cookie
            )
        except NotJoiningError as refusal:
            self._joins.give_back(caller.address)
            if is_guess and refusal.why not in {"code", "password"}:
                self._tries.give_back(caller.address)
            raise
        if is_guess:
            self._tries.give_back(caller.address)
        return member

    def _page(self, request: Request, form: Form) -> Response:
        language = language_of(request.headers)
        needs_password = bool(self._classroom.admission.password)
        return join_page(form, self._words(language), language, needs_password=needs_password)


def language_of(headers: Mapping[str, str]) -> str:
    """Return the language of the plain pages that a browser prefers."""
    return "de" if headers.get("accept-language", "").lower().startswith("de") else "en"


async def body_of(request: Request) -> bytes:
    """Return the body of the form; one that is too long is none."""
    body = bytearray()
    async for part in request.stream():
        body += part
        if len(body) > _BODY_LIMIT_BYTES:
            return b""
    return bytes(body)


def fields_of(body: bytes) -> dict[str, str]:
    """Return what was filled in; nothing of what is no form."""
    try:
        found = parse_qs(body.decode(), max_num_fields=8)
    except ValueError:
        return {}
    return {name: values[0] for name, values in found.items()}
