"""The one door: Host, Origin and role are settled here before any route is looked for."""

from __future__ import annotations

from http.cookies import CookieError, SimpleCookie
from typing import TYPE_CHECKING
from urllib.parse import parse_qsl, quote, urlencode

from starlette.datastructures import Headers, MutableHeaders
from starlette.responses import PlainTextResponse, RedirectResponse, Response

from studio.engine.roles import Role
from studio.web.origin import Authority, KnownHosts, is_same_origin, parse_authority
from studio.web.pages import no_access_page, return_page
from studio.web.policy import COMMON_HEADERS, NOTHING_POLICY

if TYPE_CHECKING:
    from starlette.types import ASGIApp, Message, Receive, Scope, Send

    from studio.web.credentials import Credentials

_SAFE_METHODS = frozenset({"GET", "HEAD"})
_PUBLIC_PREFIXES = ("/a/", "/favicon.ico")
_BEARER = "bearer "


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
        if scope["type"] == "http":
            send = _with_headers(send)
        answer = self._settle(scope)
        await (answer or self._app)(scope, receive, send)

    def _settle(self, scope: Scope) -> Response | None:
        """The answer to a caller who may not pass, or is sent on; None for one who may."""
        headers = Headers(scope=scope)
        host = self._host(headers)
        if host is None:
            return _forbidden("This studio does not go by that name: use the address it printed.")
        if scope["type"] == "http" and scope["path"].startswith(_PUBLIC_PREFIXES):
            return None
        bearer = self._role_of_bearer(headers)
        if not _may_ask_from_there(scope, headers, host, has_bearer=bearer is not None):
            return _forbidden("Another page may not do this: only the studio's own page may.")
        role = bearer or self._role_of_cookie(headers, host)
        if _is_page_request(scope):
            answer = self._exchange(scope, headers, host, role)
            if answer is not None:
                return answer
        scope.setdefault("state", {})["role"] = role
        return None if role else _stranger(scope, headers)

    def _host(self, headers: Headers) -> Authority | None:
        """The one known name that the request is addressed to."""
        given = headers.getlist("host")
        host = parse_authority(given[0]) if len(given) == 1 else None
        return host if host and self._hosts.knows(host) else None

    def _role_of_bearer(self, headers: Headers) -> Role | None:
        """For scripts, which have no cookie: `Authorization: Bearer <token>`."""
        given = headers.get("authorization", "")
        if given[: len(_BEARER)].lower() != _BEARER:
            return None
        return self._credentials.role_of_token(given[len(_BEARER) :].strip())

    def _role_of_cookie(self, headers: Headers, host: Authority) -> Role | None:
        if self._credentials.token is None:
            return Role.PRESENTER
        jar = _cookies(headers)
        given = jar.get(self._cookie_name(host))
        return self._credentials.role_of_cookie(given) if given else None

    def _cookie_name(self, host: Authority) -> str:
        """By the port that the browser sees: cookies are shared by all ports of a host."""
        return f"studio-{host.port or self._port}"

    def _exchange(
        self, scope: Scope, headers: Headers, host: Authority, role: Role | None
    ) -> Response | None:
        """Take the token out of the address and give the cookie for it."""
        query = parse_qsl(scope["query_string"].decode("latin-1"), keep_blank_values=True)
        tokens = [value for name, value in query if name == "token"]
        if not tokens:
            return None
        earned = self._credentials.role_of_token(tokens[-1])
        if earned is None and role is None:
            return no_access_page(spent=True)
        rest = urlencode([pair for pair in query if pair[0] != "token"])
        response = _go_to(_own_path(scope) + (f"?{rest}" if rest else ""), headers)
        if earned is not None:
            response.set_cookie(
                self._cookie_name(host),
                self._credentials.cookie_of(earned),
                path="/",
                httponly=True,
                samesite="strict",
            )
        return response


def _with_headers(send: Send) -> Send:
    """Every answer tells the browser how to treat it; pages bring their own policy."""

    async def send_with_headers(message: Message) -> None:
        if message["type"] == "http.response.start":
            headers = MutableHeaders(scope=message)
            for name, value in COMMON_HEADERS:
                headers.setdefault(name.decode(), value.decode())
            headers.setdefault("content-security-policy", NOTHING_POLICY)
            headers.setdefault("cache-control", "no-store")
        await send(message)

    return send_with_headers


def _may_ask_from_there(
    scope: Scope, headers: Headers, host: Authority, *, has_bearer: bool
) -> bool:
    """Whether the page that asks is ours, as far as the browser says."""
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
    """All cookies; those of other programs on this host may be of any form."""
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
    """The path as a redirect may carry it: one leading slash, else it would name another host."""
    return "/" + quote(scope["path"].lstrip("/\\"))


def _go_to(address: str, headers: Headers) -> Response:
    """Send on. From another site's link a redirect would not carry the strict cookie yet."""
    if headers.get("sec-fetch-site") in {"cross-site", "same-site"}:
        return return_page(address)
    return RedirectResponse(address, 303, headers={"referrer-policy": "no-referrer"})


def _stranger(scope: Scope, headers: Headers) -> Response:
    """Nobody we know: a page for a person, a sentence for a program."""
    if scope["type"] == "http" and "text/html" in headers.get("accept", ""):
        if headers.get("sec-fetch-site") in {"cross-site", "same-site"}:
            query = scope["query_string"].decode("latin-1")
            return return_page(_own_path(scope) + (f"?{query}" if query else ""))
        return no_access_page(spent=False)
    return _forbidden("Open the address that the studio printed: it carries the key.")


def _forbidden(sentence: str) -> Response:
    return PlainTextResponse(sentence, 403)
