"""Checks Host, Origin and role of every request before it is routed."""

from __future__ import annotations

from contextlib import suppress
from http import HTTPStatus
from http.cookies import CookieError, SimpleCookie
from typing import TYPE_CHECKING
from urllib.parse import parse_qsl, quote, urlencode

from starlette.datastructures import Headers, MutableHeaders
from starlette.requests import ClientDisconnect
from starlette.responses import PlainTextResponse, RedirectResponse, Response
from starlette.websockets import WebSocketDisconnect

from studio.protocol.roles import Role, Visitor
from studio.server.http_protocol import connection_of
from studio.server.origin import Authority, KnownHosts, is_same_origin, parse_authority
from studio.server.pages import no_access_page, return_page
from studio.server.policy import COMMON_HEADERS, NOTHING_POLICY
from studio.server.ports import CODE
from studio.server.websocket import socket_of

if TYPE_CHECKING:
    from starlette.types import ASGIApp, Message, Receive, Scope, Send

    from studio.server.credentials import Credentials

_SAFE_METHODS = frozenset({"GET", "HEAD"})
_PUBLIC_PREFIXES = ("/a/", "/favicon.ico")
_BEARER = "bearer "
_CROWDED = "This studio has as many viewers as it takes: close a tab, or try again later."


class Guard:
    """ASGI middleware in front of everything; leaves the caller's role in `scope["state"]`."""

    def __init__(
        self, app: ASGIApp, hosts: KnownHosts, credentials: Credentials, port: int
    ) -> None:
        self._app, self._hosts, self._credentials, self._port = app, hosts, credentials, port

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

    def _settle(self, scope: Scope) -> tuple[Response | None, Visitor | None]:
        """Return the answer to a caller who may not pass, or is sent on; and who it is."""
        headers = Headers(scope=scope)
        host = self._host(headers)
        if host is None:
            sentence = "This studio does not go by that name: use the address it printed."
            return _forbidden(sentence), None
        bearer = self._visitor_of_bearer(headers)
        visitor = bearer or self._visitor_of_cookie(headers, host)
        if not _recognise(scope, visitor):
            return PlainTextResponse(_CROWDED, HTTPStatus.SERVICE_UNAVAILABLE), None
        if scope["type"] == "http" and scope["path"].startswith(_PUBLIC_PREFIXES):
            return None, visitor
        if not _may_ask_from_there(scope, headers, host, has_bearer=bearer is not None):
            sentence = "Another page may not do this: only the studio's own page may."
            return _forbidden(sentence), visitor
        role = visitor.role if visitor else None
        if _is_page_request(scope):
            answer = self._exchange(scope, headers, host, role)
            if answer is not None:
                return answer, visitor
        scope.setdefault("state", {}).update(visitor=visitor)
        return None if role else _stranger(scope, headers), visitor

    def _host(self, headers: Headers) -> Authority | None:
        """Return the one known name that the request is addressed to."""
        given = headers.getlist("host")
        host = parse_authority(given[0]) if len(given) == 1 else None
        return host if host and self._hosts.knows(host) else None

    def _visitor_of_bearer(self, headers: Headers) -> Visitor | None:
        """Return the visitor of `Authorization: Bearer <token>`; scripts have no cookie."""
        given = headers.get("authorization", "")
        if given[: len(_BEARER)].lower() != _BEARER:
            return None
        role = self._credentials.role_of_token(given[len(_BEARER) :].strip())
        return Visitor(role) if role else None

    def _visitor_of_cookie(self, headers: Headers, host: Authority) -> Visitor | None:
        """A browser that has a presenter's cookie and a viewer's is a presenter's."""
        if self._credentials.token is None:
            return Visitor(Role.PRESENTER)
        jar = _cookies(headers)
        for role in (Role.PRESENTER, Role.VIEWER):
            given = jar.get(self._cookie_name(host, role))
            visitor = self._credentials.visitor_of_cookie(given) if given else None
            if visitor is not None:
                return visitor
        return None

    def _cookie_name(self, host: Authority, role: Role) -> str:
        """Return a name with the port that the browser uses, for all ports of a host share cookies.

        Each role has its own: a viewer's link does not replace the presenter's cookie, not even
        when it comes from another site, without the cookie.
        """
        name = f"studio-{host.port or self._port}"
        return name if role is Role.PRESENTER else f"{name}-{role.value}"

    def _exchange(
        self, scope: Scope, headers: Headers, host: Authority, role: Role | None
    ) -> Response | None:
        """Take the token or the one-time code out of the address and give the cookie for it."""
        query = parse_qsl(scope["query_string"].decode("latin-1"), keep_blank_values=True)
        earned, rest = self._earned(query, is_head=scope["method"] == "HEAD")
        if len(rest) == len(query):
            return None
        if earned is None and role is None:
            return no_access_page(spent=True)
        asked = urlencode(rest)
        response = _go_to(_own_path(scope) + (f"?{asked}" if asked else ""), headers)
        if earned is not None and earned is not role and role is not Role.PRESENTER:
            response.set_cookie(
                self._cookie_name(host, earned),
                self._credentials.cookie_of(earned),
                path="/",
                httponly=True,
                samesite="strict",
            )
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


def _recognise(scope: Scope, visitor: Visitor | None) -> bool:
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
    scope: Scope, headers: Headers, host: Authority, *, has_bearer: bool
) -> bool:
    """Whether the request comes from our page, as far as the browser reports it."""
    origin, site = headers.get("origin"), headers.get("sec-fetch-site")
    if origin is not None and not is_same_origin(origin, host):
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


def _cookies(headers: Headers) -> dict[str, str]:
    """Return all cookies; those of other programs on this host may be of any form."""
    found: dict[str, str] = {}
    for part in headers.get("cookie", "").split(";"):
        jar: SimpleCookie = SimpleCookie()
        try:
            jar.load(part.strip())
        except CookieError:
            continue
        found |= {name: morsel.value for name, morsel in jar.items()}
    return found


def _own_path(scope: Scope) -> str:
    """Return a path for a redirect: one leading slash, else it would name another host."""
    return "/" + quote(scope["path"].lstrip("/\\"))


def _go_to(address: str, headers: Headers) -> Response:
    """Send on. From another site's link a redirect would not carry the strict cookie yet."""
    if headers.get("sec-fetch-site") in {"cross-site", "same-site"}:
        return return_page(address)
    return RedirectResponse(address, 303, headers={"referrer-policy": "no-referrer"})


def _stranger(scope: Scope, headers: Headers) -> Response:
    """Return the answer for a stranger: a page for a person, a sentence for a program."""
    if scope["type"] == "http" and "text/html" in headers.get("accept", ""):
        if headers.get("sec-fetch-site") in {"cross-site", "same-site"}:
            query = scope["query_string"].decode("latin-1")
            return return_page(_own_path(scope) + (f"?{query}" if query else ""))
        return no_access_page(spent=False)
    return _forbidden("Open the address that the studio printed: it carries the key.")


def _forbidden(sentence: str) -> Response:
    return PlainTextResponse(sentence, 403)
