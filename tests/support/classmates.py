"""People who join the class of a running studio as their browsers do, without a browser."""

from __future__ import annotations

import json
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any
from urllib.parse import urlsplit

import httpx2
from websockets.sync.client import connect
from websockets.typing import Origin, Subprotocol

if TYPE_CHECKING:
    import ssl
    from collections.abc import Generator

    from httpx2 import Response
    from websockets.sync.connection import Connection

_PATIENCE_S = 60.0
CLOSE_S = 1.0
"""The other side's goodbye waits behind all that was not read here; the default is 10 s."""


class Lane:
    """A control lane, and all events that came on it."""

    def __init__(self, connection: Connection) -> None:
        self._connection = connection
        self.events: list[dict[str, Any]] = []
        self._requests = 0

    def until(self, kind: str, **fields: Any) -> dict[str, Any]:  # noqa: ANN401
        """The next event of a kind that has these fields, among those that come from now on."""
        while True:
            event = self._next()
            if event["type"] == kind and fields.items() <= event.items():
                return event

    def ask(self, kind: str, **fields: Any) -> dict[str, Any]:  # noqa: ANN401
        """Send a command; what it is answered, `done` or `refused` at last."""
        self._requests += 1
        self._connection.send(json.dumps({"type": kind, "request": self._requests, **fields}))
        while True:
            event = self._next()
            if event.get("request") == self._requests and event["type"] in {"done", "refused"}:
                return event

    def newest(self, kind: str) -> dict[str, Any]:
        """The newest event of a kind that has come."""
        return next(event for event in reversed(self.events) if event["type"] == kind)

    def _next(self) -> dict[str, Any]:
        while isinstance(message := self._connection.recv(timeout=_PATIENCE_S), bytes):
            pass
        self.events.append(json.loads(message))
        return self.events[-1]


class Classmate:
    """One browser; `origin` is the address that it comes by, with a path behind a proxy."""

    def __init__(self, address: str, context: ssl.SSLContext | None = None) -> None:
        parts = urlsplit(address)
        self.origin = f"{parts.scheme}://{parts.netloc}"
        self.base = parts.path.rstrip("/")
        self._context = context
        self.client = httpx2.Client(
            base_url=self.origin + self.base,
            headers={"accept": "text/html", "origin": self.origin},
            trust_env=False,
            verify=context or False,
            timeout=_PATIENCE_S,
        )

    def join(self, name: str, code: str = "", password: str = "") -> Response:
        """Fill in the form; the answer redirects to the robot, or says why not."""
        form = {"name": name, "code": code, "password": password}
        return self.client.post("/join", data=form)

    @property
    def cookie(self) -> str:
        """The `Cookie` header."""
        return "; ".join(f"{name}={value}" for name, value in self.client.cookies.items())

    @contextmanager
    def lane(self, origin: str = "") -> Generator[Lane]:
        """The control lane, as its page opens it."""
        with self.websocket("/control", origin=origin) as connection:
            yield Lane(connection)

    def websocket(self, path: str, *subprotocols: str, origin: str = "") -> Connection:
        """A websocket, as its page opens it, or one of another origin."""
        return connect(
            f"{self.origin.replace('http', 'ws', 1)}{self.base}{path}",
            origin=Origin(origin or self.origin),
            subprotocols=[Subprotocol(one) for one in subprotocols] or None,
            additional_headers={"Cookie": self.cookie},
            ssl=self._context,
            proxy=None,
            open_timeout=_PATIENCE_S,
            max_size=None,
            close_timeout=CLOSE_S,
        )

    def close(self) -> None:
        self.client.close()


@contextmanager
def classmate(address: str, name: str, code: str) -> Generator[Classmate]:
    """Somebody who has joined."""
    made = Classmate(address)
    try:
        assert made.join(name, code).status_code == 303
        yield made
    finally:
        made.close()
