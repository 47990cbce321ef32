"""The runs of a document: its worker expands the newest texts, one run at a time."""

from __future__ import annotations

import asyncio
import gc
import logging
import math
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Final, Literal, Protocol, TypeAlias, TypeVar

from studio.debounce import Debouncer
from studio.description.values import (
    ArgumentsRequest,
    Edit,
    EditRequest,
    Expansion,
    Failure,
    NoReply,
    OpenRequest,
    ReloadRequest,
)
from studio.documents.questions import Questions
from studio.errors import CommandError, WorkerDiedError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from studio.description.client import DescriptionWorker
    from studio.description.editing.sources import Sources
    from studio.description.requests import Query, Reply
    from studio.description.values import ReadPolicy
    from studio.protocol.listeners import Listener


CHECK_AFTER_S: Final = 0.15
"""Quiet time after the last of some patches."""

_GONE: Final = frozenset({"worker-died", "no-session"})
"""Codes of a worker that has lost its robot, through no fault of what it was asked for."""

_log = logging.getLogger(__name__)

Outcome: TypeAlias = Expansion | Failure


_AnyReply = TypeVar("_AnyReply")


class RunTarget(Protocol):
    """What is run: file, arguments and packages at present."""

    @property
    def path(self) -> str:
        """The entry file."""
        ...

    @property
    def policy(self) -> ReadPolicy:
        """The files that it may read."""
        ...


class LastRun:
    """The outcome of the last run, and of the last good one.

    Attributes:
        expansion: The last good run; None before the first.
        failed: Whether the last run failed, so that the texts are newer than the robot.
        failure: Error of the last run that failed, a sentence.
        files: Files that the last run read, even if it failed.
    """

    def __init__(self, path: str) -> None:
        self.expansion: Expansion | None = None
        self.failed, self.failure = False, ""
        self.files: tuple[str, ...] = (path,)

    @property
    def phase(self) -> Literal["opening", "ready", "failed"]:
        """Whether there is a robot to show."""
        if self.expansion:
            return "ready"
        return "failed" if self.failed else "opening"

    def take(self, outcome: Outcome) -> None:
        """A run ended."""
        match outcome:
            case Failure():
                self.failed, self.failure = True, outcome.problem.sentence
                self.files = tuple(dict.fromkeys((*self.files, *outcome.files)))
            case Expansion():
                self.expansion, self.failed, self.files = outcome, False, outcome.files


class Runs:
    """Runs the newest texts, one run at a time; changes meanwhile wait for the next one.

    Attributes:
        last: The outcome of the last run.

    Args:
        worker: The document's own.
        sources: The texts and arguments.
        target: What to run.
        take: Called on the loop with every outcome and the version of the sources' spans that it
            belongs to, after `last` is set and before those waiting continue.
    """

    def __init__(
        self,
        worker: DescriptionWorker,
        sources: Sources,
        target: RunTarget,
        take: Callable[[Outcome, int], None],
    ) -> None:
        self._worker, self._sources, self._target, self._take = worker, sources, target, take
        self.last = LastRun(target.path)
        self._opened_with = sources.arguments
        self._edits: list[Edit] = []
        self._reload: set[str] = set()
        self._open = True
        self._arguments_changed = False
        self._waiters: list[asyncio.Future[None]] = []
        self._turns: asyncio.Task[None] | None = None
        self._check = Debouncer(self._begin_check, CHECK_AFTER_S)
        self._in_gesture = False
        """Whether an edit that waits for its run is one of a gesture."""
        self._gesture_ended_s = -math.inf
        self._questions = Questions(self._runs_end, lambda: self._gesture_ended_s, self._reply)
        self._is_closed = False

    @property
    def worker_pid(self) -> int | None:
        """Process id of the worker while it runs."""
        return self._worker.pid

    async def edit(self, edits: Iterable[Edit], *, in_gesture: bool = False) -> None:
        """Run with these edits, which the sources already hold.

        Of a gesture more are to come: questions that take long wait until it rests.
        """
        self._edits.extend(edits)
        self._in_gesture |= in_gesture
        await self._next_run()

    async def reload(self, files: Iterable[str]) -> None:
        """Run with these files read again."""
        self._reload.update(files)
        await self._next_run()

    async def arguments_changed(self) -> None:
        """Run with the sources' arguments as they are now."""
        self._arguments_changed = True
        await self._next_run()

    async def reopen(self) -> None:
        """Run from scratch, for instance after the packages changed."""
        self._open = True
        await self._next_run()

    async def ask(self, query: Query, asker: Listener) -> Reply:
        """Ask about the last good run, in a gap that edits leave.

        A worker that has no robot, for it is opening or has ended, gets one first.

        Raises:
            SupersededError: The asker has newer questions of that kind.
        """
        return await self._questions.ask(query, asker)

    async def answer(self, query: Query, reply: type[_AnyReply], asker: Listener) -> _AnyReply:
        """Ask a question and return the reply of the expected kind.

        Raises:
            CommandError: There is no answer; the sentence says why.
        """
        answer = await self.ask(query, asker)
        if isinstance(answer, reply):
            return answer
        name = Path(self._target.path).name
        raise CommandError(
            answer.sentence if isinstance(answer, NoReply) else f"{name} gave no answer."
        )

    async def close(self) -> None:
        """End the worker; those who wait, and who come later, are cancelled."""
        self._is_closed = True
        await self._check.close()
        await self._questions.close()
        for waiter in self._waiters:
            waiter.cancel()
        if self._turns:
            self._turns.cancel()
            await asyncio.gather(self._turns, return_exceptions=True)
        await self._worker.close()

    async def _reply(self, query: Query) -> Reply:
        try:
            return await self._question(query)
        except WorkerDiedError:
            pass  # it may have ended long ago, unnoticed: it gets its robot again
        try:
            return await self._question(query)
        except WorkerDiedError as error:
            return NoReply(str(error))

    async def _question(self, query: Query) -> Reply:
        await self._runs_end()
        if self._worker.needs_reopen:
            await self._next_run()
        return await self._worker.query(query)

    async def _runs_end(self) -> None:
        while self._turns is not None and not self._turns.done():
            await asyncio.wait({self._turns})

    async def _next_run(self) -> None:
        if self._is_closed:  # a run would start a process that is never ended
            raise asyncio.CancelledError
        waiter: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        self._waiters.append(waiter)
        if self._turns is None or self._turns.done():
            self._turns = asyncio.create_task(self._take_turns())
        await waiter

    async def _take_turns(self) -> None:
        while self._waiters:
            waiters, self._waiters = self._waiters, []
            in_gesture, self._in_gesture = self._in_gesture, False
            try:
                self._check_later(await self._run())
            except asyncio.CancelledError:
                for waiter in waiters:
                    waiter.cancel()
                raise
            except Exception as error:  # noqa: BLE001 - handed on to everyone who waits for it
                _settle(waiters, error)
            else:
                _settle(waiters, None)
            if in_gesture:
                self._gesture_ended_s = asyncio.get_running_loop().time()

    def _check_later(self, outcome: Outcome) -> None:
        """After a quiet while, compare the patched robot with a full run."""
        self._check.cancel()
        if isinstance(outcome, Expansion) and outcome.is_patch:
            self._check.trigger()

    def _begin_check(self) -> None:
        if self._turns is None or self._turns.done():
            self._turns = asyncio.create_task(self._check_patches())

    async def _check_patches(self) -> None:
        """Compare with a full run; later requests have the next turn."""
        try:
            await self._check_once()
        except Exception:  # noqa: BLE001 - those who wait for a turn must get it
            _log.exception("The check of what was patched failed.")
        if not self._waiters:
            gc.collect(1)  # garbage of the edits, while nobody waits
        await self._take_turns()

    async def _check_once(self) -> None:
        version = self._sources.spans.version
        outcome = await self._worker.verify()
        if self._worker.needs_reopen:
            await self._run()
        elif isinstance(outcome, Failure) or not outcome.is_patch:
            self._take_outcome(outcome, version)

    async def _run(self) -> Outcome:
        """Run with the changes since the last run, and take the outcome.

        A worker that has lost its robot, just now or earlier, gets everything once more, unnoticed.
        """
        version = self._sources.spans.version
        outcome = await self._run_changes()
        if isinstance(outcome, Failure) and outcome.problem.code in _GONE:
            version = self._sources.spans.version
            self._forget_changes()
            outcome = await self._worker.open(self._whole())
        if isinstance(outcome, Failure) and self.last.expansion is None:
            await self._run_saved()
        self._take_outcome(outcome, version)
        return outcome

    def _take_outcome(self, outcome: Outcome, version: int) -> None:
        self.last.take(outcome)
        self._take(outcome, version)

    async def _run_saved(self) -> None:
        """Take the files as saved: unsaved work of an earlier run gives no robot.

        With its arguments where they give one, else with those that the document was opened with.
        """
        since, arguments = self._sources.since_saved(), self._sources.arguments
        choices = [arguments] if since else []
        if arguments != self._opened_with:
            choices.append(self._opened_with)
        version = self._sources.spans.version
        self._sources.spans.note(since)  # first: what is edited meanwhile comes after it
        for choice in choices:
            outcome = await self._worker.open(replace(self._whole(), arguments=choice, overlay={}))
            self._open = True  # the worker does not hold the unsaved work
            if isinstance(outcome, Expansion):
                self._take_outcome(outcome, version)
                return

    async def _run_changes(self) -> Outcome:
        """Send what changed; more than one kind of change opens again."""
        edits, reload = tuple(self._edits), tuple(self._reload)
        arguments, is_whole = self._arguments_changed, self._open or self._worker.needs_reopen
        self._forget_changes()
        if is_whole or bool(edits) + bool(reload) + arguments != 1:
            return await self._worker.open(self._whole())
        if reload:
            overlay = self._sources.overlay()
            return await self._worker.reload(
                ReloadRequest(reload, {file: overlay[file] for file in reload if file in overlay})
            )
        if arguments:
            return await self._worker.set_arguments(ArgumentsRequest(self._sources.arguments))
        return await self._worker.edit(EditRequest(edits))

    def _forget_changes(self) -> None:
        """Forget changes that the request about to be sent contains."""
        self._edits, self._reload = [], set[str]()
        self._open = self._arguments_changed = False

    def _whole(self) -> OpenRequest:
        return OpenRequest(
            entry=self._target.path,
            arguments=self._sources.arguments,
            policy=self._target.policy,
            overlay=self._sources.overlay(),
            known=self._sources.spans.numbers,
        )


def _settle(waiters: list[asyncio.Future[None]], error: Exception | None) -> None:
    for waiter in waiters:
        if waiter.done():
            continue
        if error is None:
            waiter.set_result(None)
        else:
            waiter.set_exception(error)
