"""DemoRun: a demo as a process of its own, from its start to its end."""

from __future__ import annotations

import asyncio
import signal
import sys
import time
from contextlib import suppress
from typing import TYPE_CHECKING, Final

from studio.errors import CommandError
from studio.live.panels.printed import PrintedLines
from studio.nodes.demos.starting import LEASHED, WHEN_TOLD_S
from studio.nodes.demos.table import find_demo
from studio.protocol.lessons import DemoView

if TYPE_CHECKING:
    from collections.abc import Mapping
    from typing import Literal

    from studio.nodes.demos.chapters import Lesson

_CTRL_C: Final = signal.SIGTERM if sys.platform == "win32" else signal.SIGINT
"""Interrupts a node that waits for a service, too."""
_CHUNK: Final = 1 << 14
_REASON_MAX: Final = 300


class DemoRun:
    """All on the loop, which it never holds up.

    Attributes:
        number: Of this run among all.
        printed: The last that it printed.
        zids: Of the sessions that its node was seen in; empty: it was not seen yet.
    """

    def __init__(self, lesson: Lesson, number: int) -> None:
        self.lesson, self.number = lesson, number
        self.printed = PrintedLines()
        self.zids: frozenset[str] = frozenset()
        self._process: asyncio.subprocess.Process | None = None
        self._spawned = asyncio.Event()
        self._life: asyncio.Task[None] | None = None
        self._is_told = False
        self._since_s = time.monotonic()
        self._code: int | None = None

    @property
    def is_over(self) -> bool:
        """Whether it has ended."""
        return self._code is not None

    @property
    def state(self) -> Literal["starting", "running", "stopping", "stopped", "ended"]:
        """How it fares, as pages are told."""
        if self.is_over:
            return "stopped" if self._is_told else "ended"
        if self._is_told:
            return "stopping"
        return "running" if self.zids else "starting"

    def view(self) -> DemoView:
        """Tell how it fares."""
        return DemoView(
            demo=self.lesson.demo,
            state=self.state,
            for_s=round(time.monotonic() - self._since_s, 1),
            code=self._code or 0,
            reason=self.printed.last_words[:_REASON_MAX] if self.is_over else "",
        )

    async def start(self, environment: Mapping[str, str]) -> None:
        """Start it.

        Raises:
            CommandError: The system lets no process begin.
        """
        self._life = asyncio.create_task(self._live(environment))
        await self._spawned.wait()
        if self._process is None:
            raise CommandError(f"{self.lesson.demo} was not started: {self.printed.last_words}")

    def see(self, zids: frozenset[str]) -> None:
        """Its node is there, in these sessions; what comes later is somebody else's."""
        if not self.is_over and not self.zids:
            self.zids = zids

    def press(self, key: str) -> None:
        """Press a key of it; one that has ended hears none."""
        if self._process is not None and self._process.stdin is not None and not self.is_over:
            self._process.stdin.write(f"{key}\n".encode())

    async def stop(self) -> None:
        """Tell it to end, and make it when it does not; returns once it has ended."""
        await self._spawned.wait()
        if self._life is None or self._process is None or self.is_over:
            return
        self._is_told = True
        with suppress(ProcessLookupError):
            self._process.send_signal(_CTRL_C)
        await asyncio.wait({self._life}, timeout=WHEN_TOLD_S)
        with suppress(ProcessLookupError):
            self._process.kill()
        await self._life

    async def _live(self, environment: Mapping[str, str]) -> None:
        try:
            self._process = await self._spawn(environment)
        except OSError as error:
            self.printed.take(f"{error}\n".encode())
            self._end(1)
            return
        finally:
            self._spawned.set()
        assert self._process.stdout is not None
        while chunk := await self._process.stdout.read(_CHUNK):
            self.printed.take(chunk)
        self.printed.end()
        self._end(await self._process.wait())

    async def _spawn(self, environment: Mapping[str, str]) -> asyncio.subprocess.Process:
        demo = find_demo(self.lesson.demo)
        assert demo is not None
        return await asyncio.create_subprocess_exec(
            *(sys.executable, "-P", "-m", LEASHED, demo.module, *self.lesson.words),
            env=environment,
            stdin=asyncio.subprocess.PIPE,
            stdout=asyncio.subprocess.PIPE,
            stderr=asyncio.subprocess.STDOUT,
            # Ctrl-C in the terminal of the studio is the studio's: it ends its demos by itself.
            start_new_session=True,
        )

    def _end(self, code: int) -> None:
        self._code = code
        self._since_s = time.monotonic()
