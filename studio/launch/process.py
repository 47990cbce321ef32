"""RunningProcess: one process of a launch, from its start to its last end."""

from __future__ import annotations

import asyncio
import codecs
import contextlib
import os
import signal
import time
from typing import TYPE_CHECKING, Any, Final

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.launch.prepared import ForkedProcess, Prepared
    from studio.launch.reporting import Reporter
    from studio.launch.vocabulary.requests import Request

_CHUNK_BYTES: Final = 1 << 16
_LINE_MAX: Final = 1 << 14
"""Letters of a line that has no end; it is said in parts."""
_RATE: Final = 400_000
"""Letters a second of one process that are passed on to the page; more of them are dropped."""
_KILL_PATIENCE_S: Final = 2.0


class RunningProcess:
    """Starts a process, passes on what it writes, ends it, and starts it again where it is to be.

    Args:
        number: Its id.
        name: As in `[talker-1]`.
        request: What asked for it.
        command: Its words.
        environment: All of its environment.
        reporter: Who is told.
        happened: Called with the kind of what happened (`started`, `exited`, `io`) and its data.
        over: Called when it has ended for good.
        prepared: Makes those that it can make.
    """

    def __init__(
        self,
        number: int,
        name: str,
        request: Request,
        command: list[str],
        environment: dict[str, str],
        reporter: Reporter,
        happened: Callable[[RunningProcess, str, dict[str, Any]], None],
        over: Callable[[RunningProcess], None],
        prepared: Prepared | None = None,
    ) -> None:
        self.number, self.name, self.request, self.command = number, name, request, command
        self._environment, self._reporter = environment, reporter
        self._happened, self._over = happened, over
        self._prepared = prepared
        self._process: asyncio.subprocess.Process | ForkedProcess | None = None
        self._asked = self._restarts = False
        self.is_alive = False
        """Whether it runs, or waits to be started again."""
        self._ending: asyncio.Task[None] | None = None
        self._wake = asyncio.Event()
        self._starts = 0
        self._budget, self._filled_s = float(_RATE), time.monotonic()

    @property
    def pid(self) -> int:
        """Of the process that runs, or ran last; 0 before."""
        return self._process.pid if self._process is not None else 0

    @property
    def is_running(self) -> bool:
        """Whether it runs now."""
        return self._process is not None and self._process.returncode is None

    async def live(self) -> None:
        """Run it, again and again where it is to be, until it has ended for good."""
        self.is_alive = True
        self._asked = self._asked and self._starts == 0
        try:
            while True:
                code = await self._once()
                if code is None or not await self._is_again():
                    return
        finally:
            self.is_alive = False
            self._over(self)

    def end(self) -> None:
        """End it, first as Ctrl-C does, and not start it again."""
        self._asked, self._restarts = True, False
        self._wake.set()
        self._begin_ending()

    def restart(self) -> None:
        """End it and start it again."""
        self._restarts = True
        self._wake.set()
        self._begin_ending()

    def send(self, number: int) -> None:
        """Send a signal to it and to what it started."""
        if self.is_running:
            with contextlib.suppress(ProcessLookupError, PermissionError):
                os.killpg(self.pid, number)

    def _begin_ending(self) -> None:
        if self.is_running and (self._ending is None or self._ending.done()):
            self._ending = asyncio.ensure_future(self._end())

    async def _end(self) -> None:
        steps = (
            (signal.SIGINT, self.request.sigterm_timeout_s, "SIGTERM"),
            (signal.SIGTERM, self.request.sigkill_timeout_s, "SIGKILL"),
            (signal.SIGKILL, _KILL_PATIENCE_S, ""),
        )
        process = self._process
        for number, patience_s, then in steps:
            if process is None or process.returncode is not None:
                return
            self.send(number)
            with contextlib.suppress(TimeoutError):
                await asyncio.wait_for(asyncio.shield(self._exited.wait()), patience_s)
                return
            if then:
                text = (
                    f"process[{self.name}] failed to terminate '{patience_s:g}' seconds after "
                    f"receiving '{signal.Signals(number).name}', escalating to '{then}'"
                )
                self._reporter.process_log("error", self.name, text)

    async def _once(self) -> int | None:
        """Run it once; returns its exit code, None where it cannot be started."""
        self._exited = asyncio.Event()
        self._wake.clear()
        if self._asked:
            return None
        try:
            process = await self._begun()
        except (OSError, ValueError) as error:
            reason = getattr(error, "strerror", None) or str(error)
            self._reporter.not_started(self.number, self.request, f"{self.command[0]}: {reason}")
            return None
        self._process = process
        self._starts += 1
        self._restarts = False
        self._reporter.started(self.number, self.name, self.request, process.pid, self.command)
        self._happened(self, "started", {})
        if self._asked:
            self._begin_ending()
        assert process.stdout is not None
        assert process.stderr is not None
        readers = [
            asyncio.ensure_future(self._read(process.stdout, "stdout")),
            asyncio.ensure_future(self._read(process.stderr, "stderr")),
        ]
        code = await process.wait()
        # What it left behind may hold its pipes open.
        _, late = await asyncio.wait(readers, timeout=0.5)
        if late:
            with contextlib.suppress(ProcessLookupError, PermissionError):
                os.killpg(process.pid, signal.SIGKILL)
            _, late = await asyncio.wait(late, timeout=0.5)
            for one in late:
                one.cancel()
        self._exited.set()
        respawn_in_s = self._respawn_in_s()
        self._reporter.exited(
            self.number, self.name, process.pid, code, self.command, respawn_in_s, asked=self._asked
        )
        self._happened(self, "exited", {"returncode": code})
        return code

    async def _begun(self) -> asyncio.subprocess.Process | ForkedProcess:
        cwd = self.request.cwd or None
        if self._prepared is not None:
            forked = await self._prepared.start(self.command, self._environment, cwd)
            if forked is not None:
                return forked
        return await asyncio.create_subprocess_exec(
            *self.command,
            stdin=asyncio.subprocess.DEVNULL,
            stdout=asyncio.subprocess.PIPE,
            stderr=asyncio.subprocess.PIPE,
            env=self._environment,
            cwd=cwd,
            # A terminal's Ctrl-C reaches its whole group: each would get it twice.
            start_new_session=True,
        )

    def _respawn_in_s(self) -> float | None:
        if self._restarts:
            return 0.0
        request = self.request
        left = request.retries < 0 or self._starts <= request.retries
        return request.respawn_delay_s if request.respawn and left and not self._asked else None

    async def _is_again(self) -> bool:
        """Wait until it is to be started again; False: it is not."""
        delay_s = self._respawn_in_s()
        if delay_s is None:
            return False
        if delay_s > 0:
            with contextlib.suppress(TimeoutError):
                await asyncio.wait_for(self._wake.wait(), delay_s)
        return not self._asked

    async def _read(self, stream: asyncio.StreamReader, name: str) -> None:
        decoder = codecs.getincrementaldecoder("utf-8")("replace")
        rest = ""
        while data := await stream.read(_CHUNK_BYTES):
            self._happened(self, "io", {"text": data, "fd": 1 if name == "stdout" else 2})
            text = rest + decoder.decode(data)
            end = text.rfind("\n") + 1
            if len(text) - end > _LINE_MAX:
                end = len(text)
            text, rest = text[:end], text[end:]
            self._pass_on(name, text)
        rest += decoder.decode(b"", final=True)
        self._pass_on(name, rest)

    def _pass_on(self, stream: str, text: str) -> None:
        """Say what was written; to the page only as much as it can take."""
        if not text:
            return
        drop = getattr(self._reporter, "drop", None)
        if drop is not None:
            now_s = time.monotonic()
            self._budget = min(_RATE, self._budget + (now_s - self._filled_s) * _RATE)
            self._filled_s = now_s
            if len(text) > self._budget:
                kept = text[: int(self._budget)]
                drop(self.number, len(text) - len(kept))
                text = kept
            self._budget -= len(text)
        if text:
            self._reporter.output(self.number, self.name, self.request, stream, text)
