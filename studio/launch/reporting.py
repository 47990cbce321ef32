"""Says what a running launch does: as `ros2 launch` prints it, or as events for the page."""

from __future__ import annotations

import errno
import os
import sys
from typing import TYPE_CHECKING, Protocol

from studio.launch.events import (
    OUTPUT_CHARACTERS_MAX,
    Ended,
    Log,
    NotStarted,
    Output,
    ProcessExited,
    ProcessStarted,
    Shown,
    line_of,
)

if TYPE_CHECKING:
    from studio.launch.events import LaunchEvent
    from studio.launch.vocabulary.requests import Request

_LEVELS = {"info": "INFO", "warn": "WARNING", "error": "ERROR", "debug": "DEBUG"}


class Reporter(Protocol):
    """Who is told."""

    shows_rviz: bool
    """Whether rviz2 is shown by the one who is told, instead of being started."""

    def started(
        self, number: int, name: str, request: Request, pid: int, command: list[str]
    ) -> None:
        """A process runs."""

    def output(self, number: int, name: str, request: Request, stream: str, text: str) -> None:
        """A process wrote whole lines, or a part of a long one."""

    def exited(
        self,
        number: int,
        name: str,
        pid: int,
        code: int,
        command: list[str],
        respawn_in_s: float | None,
        *,
        asked: bool,
    ) -> None:
        """A process has ended; `asked`: it was told to."""

    def not_started(self, number: int, request: Request, reason: str) -> None:
        """A node or command does not run."""

    def shown(self, number: int, request: Request, config: str) -> None:
        """Rviz2 is to be shown."""

    def log(self, level: str, text: str) -> None:
        """A line of the launch itself."""

    def process_log(self, level: str, name: str, text: str) -> None:
        """A line about a process."""

    def ended(self, code: int) -> None:
        """All is over."""


class Lines:
    """Prints as `ros2 launch` does."""

    shows_rviz = False

    def __init__(self, *, shows_all: bool = False) -> None:
        """`shows_all`: also what ROS writes to log files only."""
        self._shows_all = shows_all

    def started(
        self, number: int, name: str, request: Request, pid: int, command: list[str]
    ) -> None:
        """Print that a process runs."""
        del number, request, command
        self.process_log("info", name, f"process started with pid [{pid}]")

    def output(self, number: int, name: str, request: Request, stream: str, text: str) -> None:
        """Print lines with the name before each; of `log` only those of stderr, as ROS does."""
        del number
        is_logged = request.output in ("log", "own_log") and not self._shows_all
        if stream == "stdout" and is_logged:
            return
        self._put("".join(f"[{name}] {line}\n" for line in text.splitlines()))

    def exited(
        self,
        number: int,
        name: str,
        pid: int,
        code: int,
        command: list[str],
        respawn_in_s: float | None,
        *,
        asked: bool,
    ) -> None:
        """Print how a process ended."""
        del number, respawn_in_s, asked
        if code == 0:
            self.process_log("info", name, f"process has finished cleanly [pid {pid}]")
            return
        text = f"process has died [pid {pid}, exit code {code}, cmd '{' '.join(command)}']."
        self.process_log("error", name, text)

    def not_started(self, number: int, request: Request, reason: str) -> None:
        """Print what does not run."""
        del number
        what = " ".join(request.command) or f"{request.package} {request.executable}".strip()
        self.log("warn", f"{what} is not started: {reason}")

    def shown(self, number: int, request: Request, config: str) -> None:
        """Do nothing: it is started."""

    def log(self, level: str, text: str) -> None:
        """Print a line of the launch itself."""
        self.process_log(level, "launch", text)

    def process_log(self, level: str, name: str, text: str) -> None:
        """Print a line about a process."""
        self._put(f"[{_LEVELS.get(level, level.upper())}] [{name}]: {text}\n")

    def ended(self, code: int) -> None:
        """Do nothing: the prompt of the shell says so."""

    def _put(self, text: str) -> None:
        try:
            sys.stdout.write(text)
            sys.stdout.flush()
        except OSError as error:
            if error.errno not in (errno.EPIPE, errno.EIO):
                raise
            # `| head` has ended, and Ctrl-C still ends the launch; or the terminal has closed.
            with open(os.devnull, "w") as nothing:  # noqa: PTH123
                os.dup2(nothing.fileno(), sys.stdout.fileno())


class Events:
    """Writes events to a descriptor."""

    shows_rviz = True

    def __init__(self, descriptor: int) -> None:
        self._descriptor = descriptor
        self._dropped: dict[int, int] = {}

    def started(
        self, number: int, name: str, request: Request, pid: int, command: list[str]
    ) -> None:
        """Send that a process runs."""
        place = str(request.where)
        self._send(ProcessStarted(number, name, request.full_name, pid, tuple(command), place))

    def output(self, number: int, name: str, request: Request, stream: str, text: str) -> None:
        """Send what a process wrote, in parts."""
        del name, request
        for begin in range(0, len(text), OUTPUT_CHARACTERS_MAX):
            part = text[begin : begin + OUTPUT_CHARACTERS_MAX]
            self._send(Output(number, stream, part, self._dropped.pop(number, 0)))

    def drop(self, number: int, characters: int) -> None:
        """Count what was not sent; the next output says it."""
        self._dropped[number] = self._dropped.get(number, 0) + characters

    def exited(
        self,
        number: int,
        name: str,
        pid: int,
        code: int,
        command: list[str],
        respawn_in_s: float | None,
        *,
        asked: bool,
    ) -> None:
        """Send how a process ended."""
        del name, pid, command, asked
        self._send(ProcessExited(number, code, respawn_in_s))

    def not_started(self, number: int, request: Request, reason: str) -> None:
        """Send what does not run."""
        executable = request.executable or " ".join(request.command)
        place = str(request.where)
        self._send(NotStarted(number, request.name, request.package, executable, reason, place))

    def shown(self, number: int, request: Request, config: str) -> None:
        """Send what the page is to show."""
        self._send(Shown(number, request.executable, config))

    def log(self, level: str, text: str) -> None:
        """Send a line of the launch itself."""
        self._send(Log(level, text[:OUTPUT_CHARACTERS_MAX]))

    def process_log(self, level: str, name: str, text: str) -> None:
        """Send a line about a process."""
        self.log(level, f"{name}: {text}")

    def ended(self, code: int) -> None:
        """Send that all is over."""
        self._send(Ended(code))

    def _send(self, event: LaunchEvent) -> None:
        data = line_of(event)
        while data:
            data = data[os.write(self._descriptor, data) :]
