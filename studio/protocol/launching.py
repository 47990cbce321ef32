"""Messages about launch files and nodes that run out of the page, and their output.

All are the presenter's alone, and refused but for files of the folders that `--allow-run` named.
"""

from __future__ import annotations

from typing import Annotated, Literal, TypeAlias

from pydantic import Field, StringConstraints

from studio.protocol.launch_plans import FilePath, LaunchArguments, Word
from studio.protocol.message import Command, Event, Message

_WORDS_MAX = 100
Name: TypeAlias = Annotated[str, StringConstraints(min_length=1, max_length=200)]


class StartLaunch(Command):
    """Run a launch file."""

    type: Literal["start_launch"] = "start_launch"
    file: FilePath
    arguments: LaunchArguments = Field(default_factory=dict)


class StartNode(Command):
    """Run an executable of a package; `arguments` as behind `ros2 run PACKAGE EXECUTABLE`."""

    type: Literal["start_node"] = "start_node"
    package: Name
    executable: Name
    arguments: Annotated[tuple[Word, ...], Field(max_length=_WORDS_MAX)] = ()


class RunStarted(Event):
    """Answer to `start_launch` and `start_node`."""

    type: Literal["run_started"] = "run_started"
    request: int
    run: int


class StopRun(Command):
    """End a run, as Ctrl-C does; answered when it has ended."""

    type: Literal["stop_run"] = "stop_run"
    run: int


class StartRunAgain(Command):
    """Start a run again with the same arguments; one that goes on is ended first."""

    type: Literal["start_run_again"] = "start_run_again"
    run: int


class RestartProcess(Command):
    """End one process of a launch and start it again, or start it again once it has ended."""

    type: Literal["restart_process"] = "restart_process"
    run: int
    process: int


class EndProcess(Command):
    """End one process of a launch; it is not started again by itself."""

    type: Literal["end_process"] = "end_process"
    run: int
    process: int


class RunAgainOnSave(Command):
    """Start what runs of a package again whenever a file of that package was saved; or no more."""

    type: Literal["run_again_on_save"] = "run_again_on_save"
    run: int
    on: bool


class ForgetRun(Command):
    """Take a run that has ended out of the list."""

    type: Literal["forget_run"] = "forget_run"
    run: int


class GetRuns(Command):
    """Ask for all runs; `changed` of the subject `runs` says when to ask again."""

    type: Literal["get_runs"] = "get_runs"


class ProcessView(Message):
    """One process of a run."""

    id: int
    """As in the plan of its launch file; 0 for a node that was started by itself."""
    name: str
    node: str
    """Full name of its node; empty: not known."""
    state: Literal["running", "waiting", "ended"]
    """`waiting`: it ended, and starts again soon."""
    code: int
    """Its last exit code; negative: a signal's."""
    starts: int
    """How often it was started so far."""
    command: str


class NotStartedView(Message):
    """What a launch file names and does not run here."""

    id: int
    name: str
    package: str
    executable: str
    reason: str


class ShownView(Message):
    """What the page is to show of a launch: `rviz2` with the file of its `-d`."""

    id: int
    what: str
    config: str


class RunView(Message):
    """A launch file or node that was started out of the page."""

    run: int
    kind: Literal["launch", "node"]
    file: str
    """The launch file, or the file of the node's code where that is known."""
    package: str
    executable: str
    """Of a node; empty for a launch."""
    arguments: tuple[str, ...]
    """As behind the command."""
    line: str
    """How it is written in ROS, as `ros2 launch PACKAGE FILE name:=value`."""
    state: Literal["starting", "running", "stopping", "ended"]
    for_s: float
    """Since it was started, or since it ended."""
    code: int
    trouble: str
    """Why it ended, where that is known; else empty."""
    again_on_save: bool
    again: int
    """How often it was started again because a file was saved."""
    processes: tuple[ProcessView, ...]
    not_started: tuple[NotStartedView, ...]
    shown: tuple[ShownView, ...]


class Runs(Event):
    """Answer to `get_runs`, the newest first."""

    type: Literal["runs"] = "runs"
    request: int
    runs: tuple[RunView, ...]


class GetRunOutput(Command):
    """Ask for the lines of a run after one that is known; 0: for all that are kept."""

    type: Literal["get_run_output"] = "get_run_output"
    run: int
    after: int = Field(default=0, ge=0)


class OutputLine(Message):
    """A line that a process printed, or that the launch itself has to say."""

    number: int
    """Counts the lines of a run from 1."""
    process: int
    """-1: the launch itself."""
    stream: Literal["stdout", "stderr", "info", "warn", "error"]
    text: str


class RunOutput(Event):
    """Answer to `get_run_output`; when `last` is more than its last line, there is more to ask."""

    type: Literal["run_output"] = "run_output"
    request: int
    run: int
    lines: tuple[OutputLine, ...]
    last: int
    """Number of the newest line of all."""
    dropped: int
    """Lines that were too many to keep, since the start."""
