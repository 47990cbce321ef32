"""The ROS systems that lessons look into: each once, for all who read."""

from __future__ import annotations

import asyncio
import logging
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

from studio.documents.lessons.verdict import Verdict, missing
from studio.errors import StudioError

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping

    from studio.course.lessons.checks import Check
    from studio.documents.lessons.graph_checks import GraphChecks
    from studio.live.connection.link import WireLink

_PATIENCE_S: Final = 3.0
"""So long the systems of others wait for one that does not answer."""
_log = logging.getLogger(__name__)


@dataclass(slots=True)
class Questions:
    """What is asked of one system."""

    checks: dict[str, Check] = field(default_factory=dict[str, "Check"])
    """By their lines."""
    may_call: set[str] = field(default_factory=set[str])
    """Lines of checks of somebody who may call services there."""


class Graphs:
    """Looks at systems side by side; used on the event loop only."""

    def __init__(self) -> None:
        self._checks: dict[WireLink, GraphChecks] = {}
        self._looks: dict[WireLink, asyncio.Task[dict[str, Verdict]]] = {}

    async def look(self, asked: Mapping[WireLink, Questions]) -> dict[WireLink, dict[str, Verdict]]:
        """Return how checks stand, by system and line; systems that nobody asks of are let go."""
        await self._let_go(asked.keys())
        found = await asyncio.gather(*(self._look_at(*one) for one in asked.items()))
        return dict(zip(asked, found, strict=True))

    async def close(self) -> None:
        """Let all systems go; they may be looked at again."""
        await self._let_go(())

    async def _look_at(self, link: WireLink, asked: Questions) -> dict[str, Verdict]:
        look = self._looks.get(link)
        if look is None:
            checks = self._checks.get(link) or self._checks.setdefault(link, _graph_checks(link))
            looking = checks.verdicts(asked.checks.values(), may_call=asked.may_call)
            look = self._looks[link] = asyncio.create_task(looking)
        done, _ = await asyncio.wait((look,), timeout=_PATIENCE_S)
        if not done:
            return dict.fromkeys(asked.checks, missing("answer.waiting"))
        del self._looks[link]
        try:
            found = look.result()
        except StudioError as error:  # the connection ended meanwhile
            return dict.fromkeys(asked.checks, missing("answer.failed", reason=error))
        except Exception:  # noqa: BLE001 - one system must not end it for the others
            _log.exception("A ROS system could not be looked at.")
            return dict.fromkeys(asked.checks, missing("answer.waiting"))
        return dict.fromkeys(asked.checks, missing("answer.waiting")) | found

    async def _let_go(self, kept: Collection[WireLink]) -> None:
        gone = [link for link in self._checks if link not in kept]
        looks = [self._looks.pop(link) for link in gone if link in self._looks]
        for one in looks:
            one.cancel()
        await asyncio.gather(*looks, return_exceptions=True)
        await asyncio.gather(*(self._checks.pop(link).close() for link in gone))


def _graph_checks(link: WireLink) -> GraphChecks:
    from studio.documents.lessons.graph_checks import GraphChecks  # noqa: PLC0415 - imports zenoh

    return GraphChecks(link)
