"""Operations that pages begin and that end, such as calls and goals: which run, which are kept."""

from __future__ import annotations

import asyncio
import itertools
import logging
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final, Generic, Literal, Protocol, TypeVar

from studio.debounce import Throttle
from studio.errors import CommandError, StudioError
from studio.protocol.listeners import Audience, send

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable, Coroutine, Generator

    from studio.protocol import Event
    from studio.protocol.listeners import Listener


_PAUSE_S: Final = 0.1
"""Between two events of changes: feedback may come a thousand times a second."""


class Operation(Protocol):
    """Something that was begun and that has an end."""

    operation: int
    """Its number, of its kind."""

    @property
    def is_over(self) -> bool:
        """Whether it has its end."""
        ...


OperationT = TypeVar("OperationT", bound=Operation)


class Operations(Generic[OperationT]):
    """Operations of one kind by number, and the pages that get events of them.

    Used on the event loop only.

    Args:
        event_of: Makes the event of some operations; the first argument is whether these are all.
        kept: How many are kept after they ended.
        running: How many may run at once.
    """

    def __init__(
        self, event_of: Callable[[bool, tuple[OperationT, ...]], Event], *, kept: int, running: int
    ) -> None:
        self._event_of, self._kept, self._running = event_of, kept, running
        self._operations: dict[int, OperationT] = {}
        self._changed: set[int] = set()
        self._audience = Audience()
        self._throttle = Throttle(self._send, pause_s=_PAUSE_S)
        self._numbers = itertools.count(1)
        self._closed = False

    def next_number(self) -> int:
        """Return a number for one that is about to begin.

        Raises:
            CommandError: Too many run.
        """
        if sum(not one.is_over for one in self._operations.values()) >= self._running:
            raise CommandError(
                f"{self._running} of these run already: wait for one to end, or cancel one."
            )
        return next(self._numbers)

    def add(self, operation: OperationT) -> None:
        """Keep one that begins."""
        self._operations[operation.operation] = operation
        over = [number for number, one in self._operations.items() if one.is_over]
        for number in over[: max(0, len(over) - self._kept)]:
            del self._operations[number]
        self.changed(operation)

    def get(self, number: int) -> OperationT:
        """Return the operation of a number.

        Raises:
            CommandError: It is not known, or not any more.
        """
        found = self._operations.get(number)
        if found is None:
            raise CommandError(f"Nothing with the number {number} is known: it may be long over.")
        return found

    def all(self) -> tuple[OperationT, ...]:
        """Return the operations kept, the oldest first."""
        return tuple(self._operations.values())

    def unfinished(self) -> list[OperationT]:
        """Return the operations that run."""
        return [one for one in self._operations.values() if not one.is_over]

    def changed(self, operation: OperationT) -> None:
        """Send an event of it soon."""
        if not self._closed:
            self._changed.add(operation.operation)
            self._throttle.trigger()

    def follow(self, listener: Listener) -> None:
        """Send all that are kept, and then what changes."""
        self._audience.add(listener)
        send(listener, self._event_of(True, tuple(self._operations.values())))  # noqa: FBT003 - see `event_of`

    def unfollow(self, listener: Listener) -> None:
        """Send nothing more; the listener need not follow."""
        self._audience.remove(listener)

    @property
    def is_followed(self) -> bool:
        """Whether anybody follows."""
        return len(self._audience) > 0

    async def close(self) -> None:
        """Send nothing more."""
        self._closed = True
        await self._throttle.close()

    async def _send(self) -> None:
        changed, self._changed = self._changed, set()
        if self.is_followed:
            some = tuple(one for number, one in self._operations.items() if number in changed)
            self._audience.send(self._event_of(False, some))  # noqa: FBT003


ValueT = TypeVar("ValueT")
_log = logging.getLogger(__name__)


@dataclass(frozen=True, slots=True)
class Outcome(Generic[ValueT]):
    """Result of an operation: its value, or why it failed."""

    kind: Literal["done", "failed", "cancelled"]
    value: ValueT | None = None
    trouble: str = ""


class Begin:
    """An operation that somebody is about to begin."""

    def __init__(self, person: str) -> None:
        self.person, self.may_go_on = person, True


class Begins:
    """Operations that are about to begin: what ends all that runs ends these, too."""

    def __init__(self) -> None:
        self._begins: set[Begin] = set()

    @contextmanager
    def of(self, person: str) -> Generator[Begin]:
        """Begin one within this block; at its end it is asked whether it may still go on."""
        begin = Begin(person)
        self._begins.add(begin)
        try:
            yield begin
        finally:
            self._begins.discard(begin)

    def release(self, may_go_on: Callable[[str], bool]) -> None:
        """Let none go on but those of these persons."""
        for one in self._begins:
            one.may_go_on = one.may_go_on and may_go_on(one.person)


class RunningTasks:
    """The tasks that wait for operations to end; used on the event loop only."""

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
        """Stop waiting; with a reason, the operation failed."""
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
    """Wait for something, and return its value or its error as an outcome."""
    try:
        return Outcome("done", await wanted)
    except StudioError as error:
        return Outcome("failed", trouble=str(error))
    except asyncio.CancelledError as error:
        reason = str(error)
        return Outcome("failed" if reason else "cancelled", trouble=reason)
    except Exception:  # noqa: BLE001 - an operation without an outcome would seem to run for ever
        _log.exception("What was asked of a node could not be carried through.")
        return Outcome("failed", trouble="It failed in the studio: the terminal says why.")
