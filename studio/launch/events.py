"""What a running launch says to the one who started it, and hears from them: JSON lines.

Events go to stdout and commands come on stdin, one JSON object in a line; the end of stdin ends the
group. An `id` counts what this launch starts, or would start; `place` is the line (`file:line`) of
the launch file, as the plan has it. Texts of `output` are what a process wrote in a moment: whole
lines where they come whole, joined and bounded.
"""

from __future__ import annotations

from typing import TypeAlias

import msgspec

OUTPUT_CHARACTERS_MAX = 16_384
"""Of one `Output`."""


class ProcessStarted(msgspec.Struct, frozen=True, tag_field="event", tag="process_started"):
    """A process runs; `node` is the node's full name, empty where it is not known or none."""

    id: int
    name: str
    node: str
    pid: int
    command: tuple[str, ...]
    place: str = ""


class Output(msgspec.Struct, frozen=True, tag_field="event", tag="output"):
    """What a process wrote: to `stdout` or `stderr`; `dropped` characters of it were too many."""

    id: int
    stream: str
    text: str
    dropped: int = 0


class ProcessExited(msgspec.Struct, frozen=True, tag_field="event", tag="process_exited"):
    """A process ended; a negative code is a signal's. It starts again in `respawn_in_s`, or not."""

    id: int
    code: int
    respawn_in_s: float | None = None


class NotStarted(msgspec.Struct, frozen=True, tag_field="event", tag="not_started"):
    """A node or command that the launch file names, and why it does not run."""

    id: int
    name: str
    package: str
    executable: str
    reason: str
    place: str = ""


class Log(msgspec.Struct, frozen=True, tag_field="event", tag="log"):
    """A line of the launch itself; levels are `info`, `warn` and `error`."""

    level: str
    text: str


class Shown(msgspec.Struct, frozen=True, tag_field="event", tag="shown"):
    """The page is to show this: `rviz2`, with the config file of its `-d`, empty without one."""

    id: int
    what: str
    config: str


class Ended(msgspec.Struct, frozen=True, tag_field="event", tag="ended"):
    """The last event: all have ended."""

    code: int


class Stop(msgspec.Struct, frozen=True, tag_field="command", tag="stop"):
    """End all, as Ctrl-C does."""


class Restart(msgspec.Struct, frozen=True, tag_field="command", tag="restart"):
    """End a process and start it again, or start it again once it has ended."""

    id: int


class EndProcess(msgspec.Struct, frozen=True, tag_field="command", tag="end_process"):
    """End one process; it is not started again by itself."""

    id: int


LaunchEvent: TypeAlias = ProcessStarted | Output | ProcessExited | NotStarted | Log | Shown | Ended
LaunchCommand: TypeAlias = Stop | Restart | EndProcess

_EVENTS: msgspec.json.Decoder[LaunchEvent] = msgspec.json.Decoder(LaunchEvent)
_COMMANDS: msgspec.json.Decoder[LaunchCommand] = msgspec.json.Decoder(LaunchCommand)


def line_of(message: LaunchEvent | LaunchCommand) -> bytes:
    """Write one message as a line, its end included."""
    return msgspec.json.encode(message) + b"\n"


def read_event(line: bytes) -> LaunchEvent:
    """Read a line of stdout.

    Raises:
        msgspec.DecodeError: It is no event.
    """
    return _EVENTS.decode(line)


def read_command(line: bytes) -> LaunchCommand:
    """Read a line of stdin.

    Raises:
        msgspec.DecodeError: It is no command.
    """
    return _COMMANDS.decode(line)
