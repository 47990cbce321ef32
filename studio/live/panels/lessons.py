"""Demos of the course: listed, run as processes, driven by keys, their output kept by line."""

from __future__ import annotations

import asyncio
import codecs
import itertools
import signal
import sys
import time
from collections import deque
from contextlib import suppress
from itertools import islice
from typing import TYPE_CHECKING, Final

from studio.course.demos import LESSONS, Lesson, code_of, find_demo
from studio.course.processes import AFTER_SIGNAL_S, LEASHED
from studio.errors import CommandError
from studio.protocol.commands import Commands, Scope
from studio.protocol.lessons import (
    CodeFile,
    DemoCode,
    DemoOutput,
    Demos,
    DemoView,
    GetDemoCode,
    GetDemoOutput,
    GetDemos,
    PressKey,
    StartDemo,
    StopDemo,
)
from studio.ros.wire.settings import environment_for
from studio.system import python_command

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from typing import Literal

    from studio.live.connection.link import WireLink
    from studio.live.connection.ros_connection import RosConnection


LINES_MAX: Final = 200
LINE_MAX: Final = 2000
"""Characters; what is longer goes on as the next line."""


class PrintedLines:
    """The last lines that a process printed, by number; takes bytes as they come."""

    def __init__(self) -> None:
        self._lines: deque[str] = deque(maxlen=LINES_MAX)
        self._last = 0
        self._rest = ""
        self._decoder = codecs.getincrementaldecoder("utf-8")("replace")

    @property
    def last_text(self) -> str:
        """The last line that is not blank; empty: none came."""
        return next((line for line in reversed(self._lines) if line.strip()), "")

    def take(self, data: bytes) -> None:
        """Take what was printed."""
        *lines, rest = (self._rest + self._decoder.decode(data)).split("\n")
        for line in lines:
            self._keep(line.rstrip("\r"))
        while len(rest) >= LINE_MAX:
            self._keep(rest[:LINE_MAX])
            rest = rest[LINE_MAX:]
        self._rest = rest

    def end(self) -> None:
        """Take what stands without an end of line: nothing comes any more."""
        self.take(b"" if self._rest == "" else b"\n")

    def after(self, number: int) -> tuple[tuple[str, ...], int]:
        """Return the kept lines after one, and the number of the newest of all."""
        missing = max(0, self._last - number)
        begin = max(0, len(self._lines) - missing)
        return tuple(islice(self._lines, begin, None)), self._last

    def _keep(self, line: str) -> None:
        for start in range(0, max(1, len(line)), LINE_MAX):
            self._lines.append(line[start : start + LINE_MAX])
            self._last += 1


_CTRL_C: Final = signal.SIGTERM if sys.platform == "win32" else signal.SIGINT
"""Interrupts a node that waits for a service, too."""
_CHUNK: Final = 1 << 14
_REASON_MAX: Final = 300


class DemoRun:
    """One demo that runs as a process; used on the event loop, which it never blocks.

    Attributes:
        number: Counts all runs.
        printed: Its last output.
        zids: Sessions that its node was seen in; empty: it was not seen yet.
    """

    def __init__(
        self, lesson: Lesson, number: int, changed: Callable[[], object] = lambda: None
    ) -> None:
        self.lesson, self.number = lesson, number
        self._changed = changed
        self.printed = PrintedLines()
        self.zids: frozenset[str] = frozenset()
        self._process: asyncio.subprocess.Process | None = None
        self._spawned = asyncio.Event()
        self._life: asyncio.Task[None] | None = None
        self._is_stopping = False
        self._since_s = time.monotonic()
        self._code: int | None = None

    @property
    def is_over(self) -> bool:
        """Whether it has ended."""
        return self._code is not None

    @property
    def state(self) -> Literal["starting", "running", "stopping", "stopped", "ended"]:
        """The state as pages receive it."""
        if self.is_over:
            return "stopped" if self._is_stopping else "ended"
        if self._is_stopping:
            return "stopping"
        return "running" if self.zids else "starting"

    def view(self) -> DemoView:
        """Return the demo as pages receive it."""
        return DemoView(
            demo=self.lesson.demo,
            state=self.state,
            for_s=round(time.monotonic() - self._since_s, 1),
            code=self._code or 0,
            reason=self.printed.last_text[:_REASON_MAX] if self.is_over else "",
        )

    async def start(self, environment: Mapping[str, str]) -> None:
        """Start it.

        Raises:
            CommandError: The system lets no process begin.
        """
        self._life = asyncio.create_task(self._live(environment))
        await self._spawned.wait()
        if self._process is None:
            raise CommandError(f"{self.lesson.demo} was not started: {self.printed.last_text}")

    def see(self, zids: frozenset[str]) -> None:
        """Take the sessions in which its node is seen first; later ones belong to others."""
        if not self.is_over and not self.zids:
            self.zids = zids

    def press(self, key: str) -> None:
        """Press a key of it, if it still runs."""
        if self._process is not None and self._process.stdin is not None and not self.is_over:
            self._process.stdin.write(f"{key}\n".encode())

    async def stop(self) -> None:
        """Send Ctrl-C, then kill it if it does not end; return once it has ended."""
        await self._spawned.wait()
        if self._life is None or self._process is None or self.is_over:
            return
        self._is_stopping = True
        self._changed()
        with suppress(ProcessLookupError):
            self._process.send_signal(_CTRL_C)
        await asyncio.wait({self._life}, timeout=AFTER_SIGNAL_S)
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
            self._changed()
        self.printed.end()
        self._end(await self._process.wait())

    async def _spawn(self, environment: Mapping[str, str]) -> asyncio.subprocess.Process:
        demo = find_demo(self.lesson.demo)
        assert demo is not None
        return await asyncio.create_subprocess_exec(
            *python_command(LEASHED, demo.module, *self.lesson.arguments),
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
        self._changed()


RUNNING_MAX: Final = 10
"""Each is a process of some 80 MB."""


class CourseDemos:
    """Runs demos as processes that join the studio's ROS system, and end with its connection.

    `changed` is called when one of them changed or printed something; that its node came or went
    is a change of the graph.
    """

    def __init__(self, wire: RosConnection, changed: Callable[[], object] = lambda: None) -> None:
        self._wire, self._changed = wire, changed
        self._runs: dict[str, DemoRun] = {}
        """The last run of each demo."""
        self._numbers = itertools.count(1)
        self._sessions = _Sessions()
        self._closed = False

    async def demos(self, command: GetDemos) -> Demos:
        """Return the demos that run, also those started elsewhere."""
        elsewhere = await self._find_others()
        return Demos(
            request=command.request,
            demos=tuple(run.view() for run in self._runs.values()),
            elsewhere=elsewhere,
        )

    def output(self, command: GetDemoOutput) -> DemoOutput:
        """Return what a demo printed after the lines known; nothing if it was never started."""
        run = self._runs.get(_lesson(command.demo).demo)
        if run is None:
            return DemoOutput(request=command.request, run=0, lines=(), last=0)
        lines, last = run.printed.after(command.after if command.run == run.number else 0)
        return DemoOutput(request=command.request, run=run.number, lines=lines, last=last)

    async def code(self, command: GetDemoCode) -> DemoCode:
        """Return the source code of a demo.

        Raises:
            CommandError: It is none.
        """
        found = await asyncio.to_thread(code_of, _lesson(command.demo).demo)
        files = tuple(CodeFile(name=name, text=text) for name, text in found.items())
        return DemoCode(request=command.request, files=files)

    async def start(self, command: StartDemo) -> None:
        """Start a demo.

        Raises:
            CommandError: It is none, or runs already, or too many do, or there is no connection.
        """
        lesson = _lesson(command.demo)
        strangers = await self._find_others()
        link = self._connected()
        if lesson.demo in strangers:
            raise CommandError(
                f"A node {lesson.node} is there already, which was not started from here: "
                "end it where it was started, for two of one name are taken for one."
            )
        self._demand_room(lesson)
        run = self._runs[lesson.demo] = DemoRun(lesson, next(self._numbers), self._changed)
        self._changed()
        await run.start(environment_for(link.settings))

    async def stop(self, command: StopDemo) -> None:
        """End a demo, and return when it has ended.

        Raises:
            CommandError: It does not run, or was not started from a page.
        """
        await self._running_demo(command.demo).stop()

    def press(self, command: PressKey) -> None:
        """Press a key of a demo; errors as for `stop`."""
        run = self._running_demo(command.demo)
        if not run.lesson.has_keys:
            raise CommandError(f"{command.demo} is not driven by keys.")
        run.press(command.pressed)

    async def let_go(self) -> None:
        """End all: the connection that they share is about to."""
        await asyncio.gather(*(run.stop() for run in self._runs.values()))

    async def close(self) -> None:
        """End all, and start none any more."""
        self._closed = True
        await self.let_go()

    def _connected(self) -> WireLink:
        link = self._wire.current
        if self._closed or link is None:
            raise CommandError("Not connected to ROS 2: connect first.")
        if not link.is_connected:
            raise CommandError(
                f"The router at {link.endpoint} is gone: a demo would meet nobody until it is back."
            )
        return link

    def _demand_room(self, lesson: Lesson) -> None:
        running = [name for name, run in self._runs.items() if not run.is_over]
        if lesson.demo in running:
            raise CommandError(f"{lesson.demo} runs already.")
        if len(running) >= RUNNING_MAX:
            raise CommandError(f"{RUNNING_MAX} demos run already: stop one of them first.")

    def _running_demo(self, name: str) -> DemoRun:
        run = self._runs.get(_lesson(name).demo)
        if run is None or run.is_over:
            raise CommandError(f"{name} does not run, or was not started from a page.")
        return run

    async def _find_others(self) -> tuple[str, ...]:
        """Read the graph, and return the demos that others started."""
        link = self._wire.current
        there = await self._sessions.by_node(link) if link else {}
        for run in self._runs.values():
            run.see(there.get(run.lesson.node, frozenset()))
        return tuple(demo for demo in LESSONS if self._strangers(demo, there))

    def _strangers(self, demo: str, there: Mapping[str, frozenset[str]]) -> frozenset[str]:
        run = self._runs.get(demo)
        return there.get(LESSONS[demo].node, frozenset()) - (run.zids if run else frozenset())


def _lesson(name: str) -> Lesson:
    found = LESSONS.get(name)
    if found is None:
        raise CommandError(f"No demo is called {name[:100]}: the list in Lessons has them all.")
    return found


class _Sessions:
    """The session of each node by its full name; read again when the graph changed."""

    def __init__(self) -> None:
        self._of: tuple[str, int] | None = None
        self._by_node: dict[str, frozenset[str]] = {}

    async def by_node(self, link: WireLink) -> dict[str, frozenset[str]]:
        """Return the sessions of each node of a connection."""
        now = link.zid, link.graph.version
        if now != self._of:
            # With thousands of nodes this takes a while.
            self._by_node = await asyncio.to_thread(_sessions_by_node, link)
            self._of = now
        return self._by_node


def _sessions_by_node(link: WireLink) -> dict[str, frozenset[str]]:
    found: dict[str, set[str]] = {}
    for node in link.graph.nodes():
        found.setdefault(node.path, set()).add(node.zid)
    return {path: frozenset(zids) for path, zids in found.items()}


COMMANDS: Final = Commands[CourseDemos](Scope.ROS)
COMMANDS.viewer(GetDemos, lambda one, c, _: one.demos(c))
COMMANDS.viewer(GetDemoOutput, lambda one, c, _: one.output(c))
COMMANDS.viewer(GetDemoCode, lambda one, c, _: one.code(c))
COMMANDS.presenter(StartDemo, lambda one, c, _: one.start(c))
COMMANDS.presenter(StopDemo, lambda one, c, _: one.stop(c))
COMMANDS.controller(PressKey, lambda one, c, _: one.press(c))
