"""Running: tasks by the numbers of their deeds, each of which is cancelled with a reason."""

from __future__ import annotations

import asyncio
import logging
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Generic, Literal, TypeVar

from studio.errors import StudioError

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable, Coroutine

ValueT = TypeVar("ValueT")
_log = logging.getLogger(__name__)


@dataclass(frozen=True, slots=True)
class Outcome(Generic[ValueT]):
    """What became of something that was waited for."""

    kind: Literal["done", "failed", "cancelled"]
    value: ValueT | None = None
    trouble: str = ""


class Running:
    """Starts and ends what is waited for; all on the loop."""

    def __init__(self) -> None:
        self._waits: dict[int, asyncio.Task[Any]] = {}
        self._ends: set[asyncio.Task[None]] = set()

    def start(
        self,
        number: int,
        wanted: Coroutine[object, object, ValueT],
        finish: Callable[[Outcome[ValueT]], Coroutine[object, object, None]],
    ) -> None:
        """Wait for something; what became of it, however it ends, is given to `finish`."""
        wait = asyncio.create_task(wanted)
        self._waits[number] = wait
        # A task of its own: one that is cancelled before it began would not come to its end.
        end = asyncio.create_task(self._finish(number, wait, finish))
        self._ends.add(end)
        end.add_done_callback(self._ends.discard)

    def cancel(self, number: int, reason: str = "") -> None:
        """Wait no longer; with a reason it is said to have failed."""
        if number in self._waits:
            self._waits[number].cancel(reason)

    async def end_all(self, reason: str) -> None:
        """Wait for nothing any more, and return once all has come to its end."""
        for wait in tuple(self._waits.values()):
            wait.cancel(reason)
        await asyncio.gather(*self._ends)

    async def _finish(
        self,
        number: int,
        wait: asyncio.Task[ValueT],
        finish: Callable[[Outcome[ValueT]], Coroutine[object, object, None]],
    ) -> None:
        outcome = await outcome_of(wait)
        self._waits.pop(number, None)
        await finish(outcome)


async def outcome_of(wanted: Awaitable[ValueT]) -> Outcome[ValueT]:
    """Wait for something; errors and ends become words."""
    try:
        return Outcome("done", await wanted)
    except StudioError as error:
        return Outcome("failed", trouble=str(error))
    except asyncio.CancelledError as error:
        reason = str(error)
        return Outcome("failed" if reason else "cancelled", trouble=reason)
    except Exception:  # noqa: BLE001 - a deed that ends unsaid would seem to run for ever
        _log.exception("What was asked of a node could not be carried through.")
        return Outcome("failed", trouble="It failed in the studio: the terminal says why.")
