"""TypeLearner: has the nodes of a ROS 2 system tell types that are not known here.

Imports Zenoh, by way of ros, when it first asks.
"""

from __future__ import annotations

import asyncio
import time
from typing import TYPE_CHECKING, Final

from studio.errors import UnknownTypeError

if TYPE_CHECKING:
    from studio.live.connection.desk import WireDesk
    from studio.live.connection.link import WireLink
    from studio.ros.graph.endpoints import GraphEndpoint

_NODES_MAX: Final = 8
"""So many nodes are asked for one type: each may be silent for as long as one waits."""
_REASONS_SHOWN: Final = 2
_PAUSE_S: Final = 5.0
"""Whoever did not tell a type is not asked for it again at once, however often pages ask."""
_UNTOLD_MAX: Final = 500
_NOBODY: Final = "no known package defines it, and no node that is there tells it"
_ADVICE: Final = "drop its .{kind} file, or its package's folder, on the page"


class TypeLearner:
    """Asks for one type at a time, once for all pages; of the loop."""

    def __init__(self, wire: WireDesk) -> None:
        self._wire = wire
        self._turn = asyncio.Lock()
        self._untold: dict[str, tuple[float, str]] = {}
        """Names that nobody told: when, and why."""

    async def learn(self, name: str) -> None:
        """Have a type be known; it may be known already when its turn comes.

        Raises:
            UnknownTypeError: Nobody tells it; why, and what to do, is said.
        """
        async with self._turn:
            asked_s, why = self._untold.get(name, (float("-inf"), ""))
            if time.monotonic() - asked_s >= _PAUSE_S:
                why = await asyncio.to_thread(_ask, self._wire.current, name)
                self._keep(name, why)
        if why:
            raise UnknownTypeError(name, f"{why}; {_ADVICE.format(kind=_kind_of(name))}")

    async def texts(self, name: str) -> dict[str, str]:
        """Have how a known type, and what it is made of, are written; empty: nobody tells it."""
        async with self._turn:
            asked_s, _ = self._untold.get(name, (float("-inf"), ""))
            if time.monotonic() - asked_s < _PAUSE_S:
                return {}
            told = await asyncio.to_thread(_texts, self._wire.current, name)
            self._keep(name, "" if told else "nobody tells its text")
            return told

    def _keep(self, name: str, why: str) -> None:
        self._untold.pop(name, None)
        if why:
            self._untold[name] = (time.monotonic(), why)
        if len(self._untold) > _UNTOLD_MAX:
            self._untold.pop(next(iter(self._untold)))


def _ask(link: WireLink | None, name: str) -> str:
    """Ask the nodes that use it; why it is not known then, empty: it is. In a thread."""
    if link is None:
        return _NOBODY
    from studio.ros.type_lookup import learn_from_any  # noqa: PLC0415

    said: list[str] = []
    learn_from_any(link.node, _others(link, name), said.append)
    try:
        link.types.hash_of(name)
    except UnknownTypeError as error:
        reasons = [one.rstrip(".") for one in said[:_REASONS_SHOWN]]
        return "; ".join(reasons) or error.reason or _NOBODY
    return ""


def _texts(link: WireLink | None, name: str) -> dict[str, str]:
    if link is None:
        return {}
    from studio.ros.type_lookup import texts_of_any  # noqa: PLC0415

    return texts_of_any(link.node, _others(link, name))


def _others(link: WireLink, name: str) -> list[GraphEndpoint]:
    """One endpoint of each node that uses a type, of a few nodes; not the studio's own."""
    from studio.ros.type_lookup import users_of  # noqa: PLC0415

    others = {one.node: one for one in users_of(link.graph, name) if one.node.zid != link.zid}
    return list(others.values())[:_NODES_MAX]


def _kind_of(name: str) -> str:
    """Which file defines it."""
    return next((kind for kind in ("srv", "action") if f"/{kind}/" in name), "msg")
