"""The studio's end of one xacro worker: every call answers an Expansion or a Failure."""

from __future__ import annotations

import asyncio
from pathlib import Path
from typing import TYPE_CHECKING

from studio.description.expressions.bounds import reading_time_s
from studio.description.requests import CODEC, REPLIES, SHARED
from studio.description.values import (
    ArgumentsRequest,
    EditRequest,
    Expansion,
    Failure,
    NoReply,
    OpenRequest,
    ReloadRequest,
    VerifyRequest,
)
from studio.errors import WorkerDiedError, WorkerTimeoutError
from studio.problems import Place, Problem, Severity
from studio.settings import EXPANSION_TIMEOUT_S
from studio.workers import Worker

if TYPE_CHECKING:
    from studio.description.requests import Query, Reply
    from studio.description.session import Answer, Request


class DescriptionWorker:
    """One document's worker process, started at the first `open`.

    When the process dies or does not answer in time the call returns a Failure and
    `needs_reopen` is set: the texts in the worker are gone, so `open` must be called with the
    unsaved ones before anything else.
    """

    def __init__(self, timeout_s: float = EXPANSION_TIMEOUT_S, *, is_shared: bool = False) -> None:
        """Make one with this limit of time; a shared one has less memory, and others go first."""
        more = (SHARED,) if is_shared else ()
        self._worker = Worker(
            "xacro", "studio.description.worker", CODEC, *more, others_first=is_shared
        )
        self._timeout_s = timeout_s
        self._entry = ""
        self._files: tuple[str, ...] = ()
        self._reading_s = 0.0
        """Time that these files add to a run."""
        self.needs_reopen = True
        self._questions: set[asyncio.Task[Reply]] = set()

    @property
    def pid(self) -> int | None:
        """Process id while it runs."""
        return self._worker.pid

    async def warm(self) -> None:
        """Start the process without asking it anything."""
        await self._worker.warm()

    async def open(self, request: OpenRequest) -> Answer:
        """Start on a file; everything is in the answer."""
        self._entry = request.entry
        self.needs_reopen = False
        async with self._worker.turn():
            self._read((request.entry,))
            return await self._exchange(request, starts=True)

    async def edit(self, request: EditRequest) -> Answer:
        """Change texts and run; what changed is in the answer."""
        return await self._ask(request)

    async def set_arguments(self, request: ArgumentsRequest) -> Answer:
        """Run with other arguments."""
        return await self._ask(request)

    async def reload(self, request: ReloadRequest) -> Answer:
        """Run with texts that changed on disk."""
        return await self._ask(request)

    async def verify(self) -> Answer:
        """Run in full and correct what patches made otherwise, if anything."""
        return await self._ask(VerifyRequest())

    async def query(self, query: Query) -> Reply:
        """Ask about the last good run, after the running request.

        The caller may be cancelled: the process answers all the same, and keeps its robot.

        Raises:
            WorkerDiedError: The process ended, perhaps long ago, and with it its robot.
        """
        question = asyncio.create_task(self._question(query))
        self._questions.add(question)
        question.add_done_callback(self._questions.discard)
        return await asyncio.shield(question)

    async def close(self) -> None:
        """End the process; safe to call twice. Whoever waits for a reply is cancelled."""
        self.needs_reopen = True
        for question in self._questions:
            question.cancel()  # else one that waits its turn would start a process again
        await self._worker.close()

    async def _question(self, query: Query) -> Reply:
        try:
            async with self._worker.turn():
                if self.needs_reopen:
                    return NoReply("The robot is not open: open it again.")
                reply = await self._worker.ask_now(query, object, self._run_time_s, starts=False)
        except WorkerTimeoutError as error:
            self.needs_reopen = True
            return NoReply(str(error))
        except WorkerDiedError:
            self.needs_reopen = True
            raise
        if not isinstance(reply, REPLIES):
            self.needs_reopen = True
            return NoReply("The worker gave a reply of the wrong kind.")
        return reply

    async def _ask(self, request: Request) -> Answer:
        async with self._worker.turn():
            # `open` started the process: another one would know nothing of this robot.
            return await self._exchange(request, starts=False)

    @property
    def _run_time_s(self) -> float:
        return self._timeout_s + self._reading_s

    def _read(self, files: tuple[str, ...]) -> None:
        """Note the files of a run: long ones get more time."""
        if files != self._files:
            self._files = files
            self._reading_s = reading_time_s(sum(map(_size_bytes, files)))

    async def _exchange(self, request: Request, *, starts: bool) -> Answer:
        if self.needs_reopen:
            return self._failure("no-session", "The robot is not open: open it again.")
        try:
            answer = await self._worker.ask_now(request, object, self._run_time_s, starts=starts)
        except WorkerTimeoutError as error:
            self.needs_reopen = True
            sentence = f"The expansion took longer than {error.timeout_s:g} s and was ended."
            return self._failure("worker-timeout", sentence)
        except WorkerDiedError as error:
            self.needs_reopen = True
            sentence = f"The expansion ended its process (exit code {error.exit_code})."
            return self._failure("worker-died", sentence)
        if not isinstance(answer, Expansion | Failure):
            self.needs_reopen = True
            return self._failure("worker-died", "The worker gave an answer of the wrong kind.")
        self._read(answer.files)
        return answer

    def _failure(self, code: str, sentence: str) -> Failure:
        place = Place(self._entry) if self._entry else None
        return Failure(Problem(Severity.ERROR, code, sentence, place), self._files)


def _size_bytes(file: str) -> int:
    try:
        return Path(file).stat().st_size
    except (OSError, ValueError):
        return 0
