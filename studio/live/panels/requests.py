"""Service calls on behalf of panels, and the errors of requests without an answer.

It imports Zenoh (through `ros`), so it is imported when it is first used.
"""

from __future__ import annotations

import asyncio
import time
from typing import TYPE_CHECKING, Any, Final, Protocol

from studio.errors import (
    CallError,
    CommandError,
    DroppedError,
    NoAnswerError,
    NotServedError,
    RouterGoneError,
    ServedOtherwiseError,
    ServiceServerGoneError,
    WireError,
)
from studio.ros.names import check_full_name, full_type_name
from studio.ros.type_lookup import known_service
from studio.ros.types.convert import from_yaml, to_json

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from studio.live.connection.link import WireLink
    from studio.ros.node.task import Future
    from studio.ros.types.library import ServiceType

SHOWN_CHARACTERS: Final = 60_000
"""Limit of a reply, a result and the like: nobody reads more."""
SERVER_PATIENCE_S: Final = 3.0
"""So long a server is waited for: it was listed, or it is just starting."""
_CHECK_EVERY_S: Final = 0.05
_ROUTER_SEEN_S: Final = 0.5
"""A call ends with its router, whose end is noticed a moment later."""


class Asked(Protocol):
    """What is asked of a service."""

    @property
    def name(self) -> str:
        """Of the service."""
        ...

    @property
    def service_type(self) -> str:
        """Its type."""
        ...

    @property
    def text(self) -> str:
        """The request, as YAML."""
        ...


class ServiceRequest:
    """One request, ready to be sent; made and closed in a thread.

    Raises:
        StudioError: The name of the service is not valid, its type is not known, or the values do
            not fit it.
    """

    def __init__(self, link: WireLink, asked: Asked, kind: ServiceType | None = None) -> None:
        """`kind` is the type, if it is known: else other nodes may be asked for it."""
        name = wire_name(asked.name)
        why: list[str] = []
        type_name = full_type_name(asked.service_type, "srv")
        if kind is None:
            kind = known_service(link.node, name, type_name, why.append)
        self._request = from_yaml(kind.Request, asked.text, now_ns=time.time_ns())
        self._client = link.node.create_client(kind, name)
        self._link = link
        self.name, self.type_name = name, type_name

    async def answer(self, timeout_s: float) -> str:
        """Send the request, and return the reply as JSON.

        Raises:
            NotServedError: Nobody serves it.
            ServedOtherwiseError: Somebody does, with another type.
            ServiceServerGoneError: Its server ended meanwhile.
            RouterGoneError: The router did.
            NoAnswerError: No reply came in time.
        """
        end_s = time.monotonic() + timeout_s
        is_ready = self._client.service_is_ready
        if not await came_true(is_ready, min(timeout_s, SERVER_PATIENCE_S)):
            types = dict(self._link.graph.services()).get(self.name, ())
            raise not_served("service", self.name, self.type_name, types)
        asked = self._client.call_async(self._request)
        left_s = max(0.0, end_s - time.monotonic())
        try:
            reply = await known_in_time(asked, left_s)
        except TimeoutError:
            raise NoAnswerError("service", self.name, timeout_s) from None
        except NotServedError:
            is_there = is_ready()
            let_fall = DroppedError("service", self.name)
            gone = let_fall if is_there else ServiceServerGoneError(self.name)
            raise await why_ended(self._link, gone) from None
        return await asyncio.to_thread(to_json, reply, SHOWN_CHARACTERS)

    def close(self) -> None:
        """Take the client back."""
        self._link.node.destroy_client(self._client)


def wire_name(text: str) -> str:
    """Return the full name of a topic, a service or a node, its first slash added if missing.

    Raises:
        RosNameError: It breaks a rule.
    """
    return check_full_name(text if text.startswith("/") else f"/{text}")


def not_served(what: str, name: str, type_name: str, types: Sequence[str]) -> CallError:
    """Return why nobody answers: there is no server, or all have other types."""
    if types:
        return ServedOtherwiseError(what, name, type_name, tuple(types))
    return NotServedError(what, name)


async def came_true(holds: Callable[[], bool], timeout_s: float) -> bool:
    """Wait until something that is cheap to see holds; False when it does not in time."""
    end_s = time.monotonic() + timeout_s
    while not holds():
        if time.monotonic() >= end_s:
            return False
        await asyncio.sleep(_CHECK_EVERY_S)
    return True


async def why_ended(link: WireLink, otherwise: WireError) -> WireError:
    """Return what ended a request: the end of the router, or `otherwise`."""
    is_away = await came_true(lambda: not link.is_connected, _ROUTER_SEEN_S)
    return RouterGoneError(link.endpoint) if is_away else otherwise


async def known_in_time(future: Future[Any], timeout_s: float) -> Any:  # noqa: ANN401
    """Wait for the answer of another node; cancelling the wait gives it up.

    Raises:
        TimeoutError: It is not known in time.
        CommandError: The connection ended meanwhile.
    """
    try:
        async with asyncio.timeout(timeout_s):
            return await future
    except asyncio.CancelledError:
        task = asyncio.current_task()
        if future.cancelled() and (task is None or not task.cancelling()):
            raise CommandError("The connection with ROS 2 ended meanwhile.") from None
        raise
    finally:
        future.cancel()
