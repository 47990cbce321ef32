"""What was started out of the page: a launch file or a node, its processes and their output."""

from __future__ import annotations

import asyncio
import codecs
import itertools
import signal
import sys
import time
from contextlib import suppress
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Final, Literal, TypeAlias

import msgspec

from studio.errors import CommandError
from studio.launch.events import (
    Ended,
    EndProcess,
    LaunchCommand,
    LaunchEvent,
    Log,
    NotStarted,
    Output,
    ProcessExited,
    ProcessStarted,
    Restart,
    Shown,
    Stop,
    line_of,
    read_event,
)
from studio.launch.watchdog import GROUP_LIMITS, WATCH_EVERY_S, Watchdog
from studio.live.programs import leash
from studio.live.programs.output import ITSELF, RunLines
from studio.protocol.launching import NotStartedView, ProcessView, RunView, ShownView

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from studio.launch.watchdog import Limits
    from studio.live.programs.output import Stream

_CHUNK: Final = 1 << 16
_LINE_BYTES_MAX: Final = 1 << 20
"""Of one event; a longer line is none of the launch's."""
_STOP_S: Final = 8.0
"""A launch gives its processes Ctrl-C, then more; what has not ended by then is killed."""
_LISTED_MAX: Final = 1000
"""Processes, and things not started, that a page is told of."""
_NODE: Final = 0
"""The process number of a node that was started by itself."""

_LEVELS: Final[dict[str, Stream]] = {"warn": "warn", "error": "error"}

State: TypeAlias = Literal["starting", "running", "stopping", "ended"]


@dataclass(frozen=True, slots=True)
class Wanted:
    """What to run, found and allowed.

    Attributes:
        kind: A launch file, or a node.
        file: The launch file, or the node's code where that is known.
        folder: The package that it belongs to, whose files start it again when they are saved.
        command: The process; that of a launch speaks by `studio.launch.events`.
        words: As behind the command in ROS.
        line: How it is written in ROS.
    """

    kind: Literal["launch", "node"]
    file: str
    folder: Path
    command: tuple[str, ...]
    words: tuple[str, ...]
    line: str
    package: str = ""
    executable: str = ""
    environment: Mapping[str, str] = field(default_factory=dict[str, str])


@dataclass(frozen=True, slots=True)
class _Process:
    """What is known of one process."""

    id: int
    name: str
    node: str = ""
    state: Literal["running", "waiting", "ended"] = "running"
    code: int = 0
    starts: int = 1
    command: str = ""


class Run:
    """One launch file or node that was started; used on the event loop, which it never blocks.

    Args:
        limits: What a node may have with all that it starts; a launch watches itself.

    Attributes:
        number: Counts all runs of this studio.
        wanted: What runs.
        lines: Its last output.
        again_on_save: Whether it is started again when a file of its package is saved.
    """

    def __init__(
        self,
        wanted: Wanted,
        number: int,
        changed: Callable[[], object],
        limits: Limits = GROUP_LIMITS,
    ) -> None:
        self.wanted, self.number, self._changed = wanted, number, changed
        self._limits = limits
        self.lines = RunLines()
        self.again_on_save = False
        self._again = 0
        self._processes: dict[int, _Process] = {}
        self._not_started: dict[int, NotStartedView] = {}
        self._shown: dict[int, ShownView] = {}
        self._process: asyncio.subprocess.Process | None = None
        self._life: asyncio.Task[None] | None = None
        self._state: State = "ended"
        self._code = 0
        self._trouble = self._limit = ""
        self._since_s = time.monotonic()
        self._turn = asyncio.Lock()

    @property
    def is_over(self) -> bool:
        """Whether nothing of it runs."""
        return self._state == "ended"

    def view(self) -> RunView:
        """Return it as pages receive it."""
        wanted = self.wanted
        listed = itertools.islice(self._processes.values(), _LISTED_MAX)
        return RunView(
            run=self.number,
            kind=wanted.kind,
            file=wanted.file,
            package=wanted.package,
            executable=wanted.executable,
            arguments=wanted.words,
            line=wanted.line,
            state=self._state,
            for_s=round(time.monotonic() - self._since_s, 1),
            code=self._code,
            trouble=self._trouble,
            again_on_save=self.again_on_save,
            again=self._again,
            processes=tuple(
                ProcessView.model_validate(one, from_attributes=True) for one in listed
            ),
            not_started=tuple(itertools.islice(self._not_started.values(), _LISTED_MAX)),
            shown=tuple(self._shown.values()),
        )

    async def start(self, environment: Mapping[str, str]) -> None:
        """Start it, or start it again: what runs is ended first.

        Raises:
            CommandError: The system lets no process begin.
        """
        async with self._turn:
            await self._end()
            await self._begin(environment)

    async def start_again(self, environment: Mapping[str, str]) -> None:
        """Start it again because a file was saved; a run that was ended stays ended.

        Raises:
            CommandError: The system lets no process begin.
        """
        async with self._turn:
            if self._state == "stopping" or not self.again_on_save:
                return
            await self._end()
            self._again += 1
            self.lines.say("info", "A file of its package was saved: it is started again.")
            await self._begin(environment)

    async def stop(self) -> None:
        """End it as Ctrl-C does, and return when it has ended."""
        async with self._turn:
            await self._end()

    async def close(self) -> None:
        """End it, for the studio ends."""
        self.again_on_save = False
        await self.stop()

    def restart_process(self, process: int) -> None:
        """Start one process of a launch again.

        Raises:
            CommandError: There is none of that number, or nothing runs.
        """
        self._tell(process, Restart(process))

    def end_process(self, process: int) -> None:
        """End one process of a launch; errors as `restart_process`."""
        self._tell(process, EndProcess(process))

    def _tell(self, process: int, command: LaunchCommand) -> None:
        if self.wanted.kind != "launch" or process not in self._processes:
            raise CommandError(f"Run {self.number} has no process {process}: choose one of its.")
        if self.is_over or self._process is None or self._process.stdin is None:
            raise CommandError("The launch has ended: start it again.")
        self._process.stdin.write(line_of(command))

    async def _begin(self, environment: Mapping[str, str]) -> None:
        self._processes.clear()
        self._not_started.clear()
        self._shown.clear()
        self._code, self._trouble, self._limit = 0, "", ""
        self._since_s = time.monotonic()
        self._state = "starting"
        self._changed()
        wanted = self.wanted
        is_launch = wanted.kind == "launch"
        command = wanted.command if is_launch else _leashed(wanted.command)
        try:
            process = await asyncio.create_subprocess_exec(
                *command,
                env={**environment, **wanted.environment},
                cwd=wanted.folder,
                stdin=asyncio.subprocess.PIPE,
                stdout=asyncio.subprocess.PIPE,
                stderr=asyncio.subprocess.PIPE,
                limit=_LINE_BYTES_MAX,
                # Ctrl-C in the terminal of the studio is the studio's: it ends its runs by itself.
                start_new_session=True,
            )
        except OSError as error:
            self._over(1, f"{error.strerror or type(error).__name__}: {command[0]}")
            raise CommandError(f"{wanted.line} was not started: {self._trouble}.") from error
        self._process = process
        self._life = asyncio.create_task(self._live(process))

    async def _live(self, process: asyncio.subprocess.Process) -> None:
        if self.wanted.kind == "launch":
            await asyncio.gather(self._read_events(process), self._read_errors(process))
        else:
            name = self.wanted.executable or Path(self.wanted.file).name
            self._put(_Process(_NODE, name, command=self.wanted.line))
            self._state = "running"
            self._changed()
            assert process.stdout is not None
            assert process.stderr is not None
            watch = asyncio.create_task(self._watch(process.pid))
            try:
                await asyncio.gather(
                    self._read_text(process.stdout, _NODE, "stdout"),
                    self._read_text(process.stderr, _NODE, "stderr"),
                )
                await process.wait()
            finally:
                watch.cancel()
        code = await process.wait()
        self.lines.end()
        for one in tuple(self._processes.values()):
            if one.state != "ended":
                self._put(replace(one, state="ended", code=code))
        self._over(code, self._why(code))

    async def _watch(self, leader: int) -> None:
        """End a node that has more than it may, and say so."""
        watchdog = Watchdog(leader, self._limits)
        reason = ""
        while not reason:
            await asyncio.sleep(WATCH_EVERY_S)
            reason = await asyncio.to_thread(watchdog.exceeded)
        self._limit = f"the node is ended: {reason}"
        self.lines.say("error", self._limit, _NODE)
        self._changed()
        await asyncio.to_thread(watchdog.kill)

    def _why(self, code: int) -> str:
        """Return why it ended, as far as its last words tell."""
        if code == 0 or self._state == "stopping":
            return ""
        if self._limit:
            return self._limit
        process = ITSELF if self.wanted.kind == "launch" else _NODE
        return self.lines.last_text(process)[:300]

    def _over(self, code: int, trouble: str) -> None:
        self._code, self._trouble = code, trouble
        self._state = "ended"
        self._since_s = time.monotonic()
        self._changed()

    async def _end(self) -> None:
        process, life = self._process, self._life
        if process is None or life is None or self.is_over:
            return
        self._state = "stopping"
        self._changed()
        assert process.stdin is not None
        if self.wanted.kind == "launch":
            with suppress(OSError):
                process.stdin.write(line_of(Stop()))
        process.stdin.close()
        await asyncio.wait({life}, timeout=_STOP_S)
        with suppress(ProcessLookupError):
            process.send_signal(signal.SIGTERM if sys.platform == "win32" else signal.SIGKILL)
        await asyncio.wait({life}, timeout=_STOP_S)
        self._process = self._life = None

    async def _read_text(self, stream: asyncio.StreamReader, process: int, kind: Stream) -> None:
        decoder = codecs.getincrementaldecoder("utf-8")("replace")
        while chunk := await stream.read(_CHUNK):
            self.lines.take(process, kind, decoder.decode(chunk))
            self._changed()

    async def _read_errors(self, process: asyncio.subprocess.Process) -> None:
        assert process.stderr is not None
        await self._read_text(process.stderr, ITSELF, "stderr")

    async def _read_events(self, process: asyncio.subprocess.Process) -> None:
        assert process.stdout is not None
        while True:
            try:
                line = await process.stdout.readline()
            except ValueError:  # longer than the limit; the rest of it is read as lines of its own
                continue
            if not line:
                return
            try:
                event = read_event(line)
            except msgspec.DecodeError:  # a plug-in printed it
                self.lines.take(ITSELF, "stdout", line.decode(errors="replace"))
            else:
                self._take(event)
            self._changed()

    def _take(self, event: LaunchEvent) -> None:
        if self._state == "starting":
            self._state = "running"
        match event:
            case ProcessStarted():
                self._take_start(event)
            case Output():
                self._take_output(event)
            case ProcessExited():
                self._take_exit(event)
            case NotStarted():
                self._not_started[event.id] = NotStartedView(
                    id=event.id,
                    name=event.name,
                    package=event.package,
                    executable=event.executable,
                    reason=event.reason,
                )
            case Log():
                self.lines.say(_LEVELS.get(event.level, "info"), event.text)
            case Shown():
                self._shown[event.id] = ShownView(id=event.id, what=event.what, config=event.config)
            case Ended():
                pass  # its code is that of the process

    def _take_start(self, event: ProcessStarted) -> None:
        before = self._processes.get(event.id)
        starts = before.starts + 1 if before else 1
        line = " ".join(event.command)
        self._put(_Process(event.id, event.name, event.node, starts=starts, command=line))

    def _take_output(self, event: Output) -> None:
        self.lines.take(event.id, "stderr" if event.stream == "stderr" else "stdout", event.text)
        if event.dropped:
            sentence = f"{event.dropped} characters more were too many, and left out."
            self.lines.say("warn", sentence, event.id)

    def _take_exit(self, event: ProcessExited) -> None:
        self.lines.end(event.id)
        known = self._processes.get(event.id)
        if known is not None:
            state = "ended" if event.respawn_in_s is None else "waiting"
            self._put(replace(known, state=state, code=event.code))

    def _put(self, process: _Process) -> None:
        self._processes[process.id] = process


def _leashed(command: tuple[str, ...]) -> tuple[str, ...]:
    """Return a command that ends with this process, however that ends."""
    return (sys.executable, "-I", "-S", str(Path(leash.__file__)), *command)
