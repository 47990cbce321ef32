"""Events: what happens while a launch runs."""

from __future__ import annotations

import signal
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable


class Event:
    """Something that happens."""

    name = "launch.Event"


class Shutdown(Event):
    """The launch ends."""

    name = "launch.events.Shutdown"

    def __init__(
        self, *, reason: str = "reason not given", due_to_sigint: bool = False, **_: Any
    ) -> None:
        self.reason, self.due_to_sigint = reason, due_to_sigint


class ExecutionComplete(Event):
    """An action is done."""

    name = "launch.events.ExecutionComplete"

    def __init__(self, *, action: Any) -> None:
        self.action = action


class IncludeLaunchDescription(Event):
    """A launch description is included."""

    name = "launch.events.IncludeLaunchDescription"

    def __init__(self, launch_description: Any) -> None:
        self.launch_description = launch_description


class TimerEvent(Event):
    """A timer has run down."""

    name = "launch.events.TimerEvent"

    def __init__(self, *, timer_action: Any) -> None:
        self.timer_action = timer_action


class RunningProcessEvent(Event):
    """Something of a process."""

    name = "launch.events.process.RunningProcessEvent"

    def __init__(
        self,
        *,
        action: Any,
        name: str = "",
        cmd: list[str] | None = None,
        cwd: str | None = None,
        env: dict[str, str] | None = None,
        pid: int = 0,
        **_: Any,
    ) -> None:
        self.action, self.process_name, self.pid = action, name, pid
        self.cmd, self.cwd, self.env = cmd or [], cwd, env

    @property
    def execute_process_action(self) -> Any:
        return self.action


class ProcessStarted(RunningProcessEvent):
    """A process runs."""

    name = "launch.events.process.ProcessStarted"


class ProcessExited(RunningProcessEvent):
    """A process has ended."""

    name = "launch.events.process.ProcessExited"

    def __init__(self, *, returncode: int, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.returncode = returncode


class ProcessIO(RunningProcessEvent):
    """A process wrote something; `text` is bytes."""

    name = "launch.events.process.ProcessIO"

    def __init__(self, *, text: bytes, fd: int, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.text, self.fd = text, fd

    @property
    def from_stdin(self) -> bool:
        return self.fd == 0

    @property
    def from_stdout(self) -> bool:
        return self.fd == 1

    @property
    def from_stderr(self) -> bool:
        return self.fd == 2


class ProcessStdout(ProcessIO):
    """A process wrote to stdout."""


class ProcessStderr(ProcessIO):
    """A process wrote to stderr."""


class ProcessTargetedEvent(Event):
    """Asks something of the processes of which a function is true."""

    name = "launch.events.process.ProcessTargetedEvent"

    def __init__(self, *, process_matcher: Callable[[Any], bool]) -> None:
        self.process_matcher = process_matcher


class SignalProcess(ProcessTargetedEvent):
    """Sends a signal."""

    name = "launch.events.process.SignalProcess"

    def __init__(self, *, signal_number: Any, process_matcher: Callable[[Any], bool]) -> None:
        super().__init__(process_matcher=process_matcher)
        self.signal = (
            signal.Signals[signal_number]
            if isinstance(signal_number, str)
            else signal.Signals(signal_number)
        )
        self.signal_name = self.signal.name


class ShutdownProcess(ProcessTargetedEvent):
    """Ends processes as Ctrl-C does."""

    name = "launch.events.process.ShutdownProcess"


class ProcessStdin(ProcessTargetedEvent):
    """Writes to processes; not supported."""

    def __init__(self, *, text: bytes, process_matcher: Callable[[Any], bool], **_: Any) -> None:
        super().__init__(process_matcher=process_matcher)
        self.text = text


def matches_action(action: Any) -> Callable[[Any], bool]:
    """Return a function that is true of one action."""
    return lambda other: other is action


def matches_pid(pid: int) -> Callable[[Any], bool]:
    """Return a function that is true of the action whose process has that number."""
    return lambda action: (getattr(action, "process_details", None) or {}).get("pid") == pid


def matches_name(name: str) -> Callable[[Any], bool]:
    """Return a function that is true of actions whose process has that name."""
    return lambda action: (getattr(action, "process_details", None) or {}).get("name") == name


def matches_executable(name: str) -> Callable[[Any], bool]:
    """Return a function that is true of actions that run that executable."""
    return lambda action: (
        (getattr(action, "process_details", None) or {}).get("cmd", [""])[0].endswith(name)
    )


def matches_node_name(node_name: str) -> Callable[[Any], bool]:
    """Return a function that is true of the node of that full name."""
    wanted = node_name if node_name.startswith("/") else f"/{node_name}"
    return lambda action: getattr(action, "node_name", "") == wanted


class ChangeState(Event):
    """Asks lifecycle nodes for a transition, by its id of lifecycle_msgs."""

    name = "launch_ros.events.lifecycle.ChangeState"

    def __init__(
        self, *, lifecycle_node_matcher: Callable[[Any], bool], transition_id: int
    ) -> None:
        self.lifecycle_node_matcher, self.transition_id = lifecycle_node_matcher, transition_id


class StateTransition(Event):
    """A lifecycle node went from a state to another."""

    name = "launch_ros.events.lifecycle.StateTransition"

    def __init__(
        self, *, action: Any, msg: Any = None, transition: str = "", start: str = "", goal: str = ""
    ) -> None:
        self.action, self.msg = action, msg
        self.transition, self.start_state, self.goal_state = transition, start, goal
