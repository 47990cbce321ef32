"""Checks name, origin and person of every request before it is routed."""

from __future__ import annotations

import re
from contextlib import suppress
from http import HTTPStatus
from typing import TYPE_CHECKING
from urllib.parse import parse_qsl, quote, urlencode

from starlette.datastructures import Headers, MutableHeaders
from starlette.requests import ClientDisconnect
from starlette.responses import PlainTextResponse, RedirectResponse, Response
from starlette.websockets import WebSocketDisconnect

from studio.protocol.roles import Role
from studio.server.http_protocol import connection_of
from studio.server.origin import is_same_origin
from studio.server.pages import no_access_page, return_page
from studio.server.policy import COMMON_HEADERS, NOTHING_POLICY
from studio.server.ports import CODE, FULL_SCREEN
from studio.server.websocket import socket_of

if TYPE_CHECKING:
    from collections.abc import Callable

    from starlette.types import ASGIApp, Message, Receive, Scope, Send

    from studio.protocol.roles import Person
    from studio.server.cookies import Cookies
    from studio.server.credentials import Credentials
    from studio.server.front import Caller, Front

_SAFE_METHODS = frozenset({"GET", "HEAD"})
_PUBLIC_PREFIXES = ("/a/", "/favicon.ico")
JOIN_PATH = "/join"
"""The form by which others join; of its own, because who has no role may open it."""
HEALTH_PATH = "/health"
"""Of a server that takes passes: there pages of its neighbours see that it runs."""
PASS, NEXT = "pass", "next"
"""In the query of `JOIN_PATH`: proof of a member, given by another relay; where they go on."""
_DOCUMENT = re.compile(r"/d/[^/\\?#\x00-\x1f\x7f]+")
_SLASHES = "/\\"
_BEARER = "bearer "
_CROWDED = "This studio has as many viewers as it takes: close a tab, or try again later."


class Guard:
    """ASGI middleware in front of everything; leaves who asks in `scope["state"]`.

    Args:
        app: What it guards.
        front: Where the studio is reached.
        credentials: Prove a role.
        cookies: By which browsers are known.
        joining: Whether others may join the class, so that strangers are sent to its form.
    """

    def __init__(
        self,
        app: ASGIApp,
        front: Front,
        credentials: Credentials,
        cookies: Cookies,
        joining: Callable[[], bool],
    ) -> None:
        self._app, self._front, self._joining = app, front, joining
        self._credentials, self._cookies = credentials, cookies

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer what may not pass; hand on the rest with its role."""
        if scope["type"] == "lifespan":
            await self._app(scope, receive, send)
            return
        answer, visitor = self._settle(scope)
        if scope["type"] == "http":
            send = _with_headers(send, closing=visitor is None)
        with suppress(ClientDisconnect, WebSocketDisconnect):  # the browser left and gets no answer
            await (answer or self._app)(scope, receive, send)

    def _settle(self, scope: Scope) -> tuple[Response | None, Person | None]:
        """Return the answer to a caller who may not pass, or is sent on; and who it is."""
        headers = Headers(scope=scope)
        caller = self._front.caller(scope, headers)
        if caller is None:
            sentence = "This studio does not go by that name: use the address it printed."
            return _forbidden(sentence), None
        if not self._front.enter(scope):
            return self._go_to("/", headers, scope["query_string"].decode("latin-1")), None
        bearer = self._visitor_of_bearer(headers)
        visitor = bearer or self._cookies.visitor(headers, caller)
        if not _recognise(scope, visitor):
            return PlainTextResponse(_CROWDED, HTTPStatus.SERVICE_UNAVAILABLE), None
        if self._is_public(scope):
            return None, visitor
        if not _may_ask_from_there(scope, headers, caller, has_bearer=bearer is not None):
            sentence = "Another page may not do this: only the studio's own page may."
            return _forbidden(sentence), visitor
        return self._admit(scope, headers, caller, visitor), visitor

    def _is_public(self, scope: Scope) -> bool:
        path: str = scope["path"]
        is_health = path == HEALTH_PATH and self._cookies.takes_passes
        return scope["type"] == "http" and (is_health or path.startswith(_PUBLIC_PREFIXES))

    def _admit(
        self, scope: Scope, headers: Headers, caller: Caller, visitor: Person | None
    ) -> Response | None:
        """Return the answer to who is sent on, or may see nothing; None lets them in."""
        if _is_page_request(scope):
            answer = self._exchange(scope, headers, caller, visitor)
            if answer is not None:
                return answer
        scope.setdefault("state", {}).update(visitor=visitor, caller=caller)
        if visitor is not None or scope["path"] == JOIN_PATH:
            return None
        return self._stranger(scope, headers, caller)

    def _visitor_of_bearer(self, headers: Headers) -> Person | None:
        """Return the visitor of `Authorization: Bearer <token>`; scripts have no cookie."""
        given = headers.get("authorization", "")
        if given[: len(_BEARER)].lower() != _BEARER:
            return None
        role = self._credentials.role_of_token(given[len(_BEARER) :].strip())
        return self._cookies.of_role(role) if role else None

    def _exchange(
        self, scope: Scope, headers: Headers, caller: Caller, visitor: Person | None
    ) -> Response | None:
        """Take what is secret out of the address, and give the cookie for it."""
        query = parse_qsl(scope["query_string"].decode("latin-1"), keep_blank_values=True)
        if scope["path"] == JOIN_PATH:
            return self._exchange_join(query, headers, caller, visitor)
        role = visitor.role if visitor else None
        earned, rest = self._earned(query, is_head=scope["method"] == "HEAD")
        if len(rest) == len(query):
            return None
        if earned is None and role is None:
            return no_access_page(spent=True)
        response = self._go_to(scope["path"], headers, urlencode(rest))
        if earned is not None and earned is not role and role is not Role.PRESENTER:
            self._cookies.give(response, caller, earned)
        return response

    def _exchange_join(
        self,
        query: list[tuple[str, str]],
        headers: Headers,
        caller: Caller,
        visitor: Person | None,
    ) -> Response | None:
        """Take the code of a link into a cookie; who has a place here goes there."""
        if self._cookies.takes_passes and PASS in dict(query):
            return self._exchange_pass(dict(query), headers, caller, visitor)
        if visitor is not None and visitor.role is not Role.GUEST:
            return self._go_to("/", headers)
        if not query:
            return None
        response = self._go_to(JOIN_PATH, headers)  # without a token that was sent here, too
        if code := dict(query).get(CODE):
            self._cookies.keep_code(response, caller, code)
        return response

    def _exchange_pass(
        self, given: dict[str, str], headers: Headers, caller: Caller, visitor: Person | None
    ) -> Response:
        """Take a pass into a cookie; it replaces nobody's place, and lets in nobody sent out.

        Also from elsewhere it redirects at once: a member's cookie comes along, and so no page
        ever has the pass in its address.
        """
        member = self._cookies.member_of_pass(given[PASS])
        has_place = visitor is not None and visitor.role is not Role.GUEST
        if not has_place and self._cookies.is_sent_out(headers, caller):
            member = None
        if member is None:
            return _see_other(self._own("/" if has_place else JOIN_PATH))
        if visitor is not None and has_place and visitor.person != member.person:
            return _see_other(self._own("/"))
        response = _see_other(self._own(*_goal(given)))
        if not has_place:
            self._cookies.give_member(response, caller, given[PASS])
        return response

    def _earned(
        self, query: list[tuple[str, str]], *, is_head: bool
    ) -> tuple[Role | None, list[tuple[str, str]]]:
        """Return the role that a query gives, and what else is in it."""
        given = dict(query)
        earned = self._credentials.role_of_token(given.get("token", ""))
        if earned is None and not is_head:  # HEAD does not spend the code
            earned = self._credentials.redeem(given.get(CODE, ""))
        return earned, [pair for pair in query if pair[0] not in {"token", CODE}]

    def _go_to(self, path: str, headers: Headers, query: str = "") -> Response:
        """Send on. From another site's link a redirect would not carry the strict cookie yet."""
        address = self._own(path, query)
        if _comes_from_elsewhere(headers):
            return return_page(address)
        return _see_other(address)

    def _own(self, path: str, query: str = "") -> str:
        # One leading slash, whatever path was asked for: else it would name another host.
        own = f"{self._front.base}/{quote(path.lstrip(_SLASHES))}"
        return f"{own}?{query}" if query else own

    def _stranger(self, scope: Scope, headers: Headers, caller: Caller) -> Response:
        """Return the answer for a stranger: a page for a person, a sentence for a program."""
        if scope["type"] != "http" or "text/html" not in headers.get("accept", ""):
            return _forbidden("Open the address that the studio printed: it carries the key.")
        if _comes_from_elsewhere(headers):
            return self._go_to(scope["path"], headers, scope["query_string"].decode("latin-1"))
        if self._credentials.guests and not self._cookies.is_sent_out(headers, caller):
            response = self._go_to(scope["path"], headers)
            self._cookies.give(response, caller, Role.GUEST)
            return response
        if self._joining():
            return self._go_to(JOIN_PATH, headers)
        return no_access_page(spent=False)


def _goal(given: dict[str, str]) -> tuple[str, str]:
    """Return path and query of the document that a pass leads to; else of the first one."""
    path, (name, _, value) = given.get(NEXT, ""), FULL_SCREEN.partition("=")
    query = FULL_SCREEN if given.get(name) == value else ""
    return path if _DOCUMENT.fullmatch(path) else "/", query


def _see_other(address: str) -> Response:
    return RedirectResponse(address, 303, headers={"referrer-policy": "no-referrer"})


def _comes_from_elsewhere(headers: Headers) -> bool:
    return headers.get("sec-fetch-site") in {"cross-site", "same-site"}


def _recognise(scope: Scope, visitor: Person | None) -> bool:
    """Assign the connection to a person; False when they have too many."""
    connection = connection_of(scope) if scope["type"] == "http" else socket_of(scope)
    return connection.recognise(visitor)


def _with_headers(send: Send, *, closing: bool) -> Send:
    """Add the headers that every answer has; pages bring their own policy.

    A connection that is `closing` ends with the answer.
    """

    async def send_with_headers(message: Message) -> None:
        if message["type"] == "http.response.start":
            headers = MutableHeaders(scope=message)
            for name, value in COMMON_HEADERS:
                headers.setdefault(name.decode(), value.decode())
            headers.setdefault("content-security-policy", NOTHING_POLICY)
            headers.setdefault("cache-control", "no-store")
            if closing:
                headers["connection"] = "close"
        await send(message)

    return send_with_headers


def _may_ask_from_there(
    scope: Scope, headers: Headers, caller: Caller, *, has_bearer: bool
) -> bool:
    """Whether the request comes from our page, as far as the browser reports it."""
    origin, site = headers.get("origin"), headers.get("sec-fetch-site")
    if origin is not None and not is_same_origin(origin, caller.host):
        return False
    if scope["type"] == "websocket" or scope["method"] not in _SAFE_METHODS:
        return site in {None, "same-origin"} and (origin is not None or has_bearer)
    return site in {None, "none", "same-origin"} or _is_navigation(headers)


def _is_navigation(headers: Headers) -> bool:
    """A person follows a link, in a tab of its own."""
    return headers.get("sec-fetch-mode") == "navigate" and (
        headers.get("sec-fetch-dest") == "document"
    )


def _is_page_request(scope: Scope) -> bool:
    return (
        scope["type"] == "http"
        and scope["method"] in _SAFE_METHODS
        and not scope["path"].startswith("/api/")
    )


def _forbidden(sentence: str) -> Response:
    return PlainTextResponse(sentence, 403)
