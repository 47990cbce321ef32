"""Runner: does what a launch file says; what it starts is one group that ends together."""

from __future__ import annotations

import asyncio
import contextlib
import itertools
import os
import signal
import threading
import time
from functools import partial
from typing import TYPE_CHECKING, Any, Final

from studio.errors import LaunchError, SubstitutionFailure
from studio.launch.command_lines import command_line
from studio.launch.command_output import CommandOutput
from studio.launch.events import EndProcess, Restart, Stop, read_command
from studio.launch.hosting import BaseHost, choice_fault, fault_at
from studio.launch.interrupts import Interrupts
from studio.launch.process import RunningProcess
from studio.launch.starting import beginning_of
from studio.launch.vocabulary import events
from studio.launch.vocabulary.handlers import entities_of
from studio.launch.watchdog import GROUP_LIMITS, WATCH_EVERY_S, Watchdog

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from studio.launch.plan import Where
    from studio.launch.prepared import Prepared
    from studio.launch.reporting import Reporter
    from studio.launch.starting import Beginning
    from studio.launch.vocabulary.actions import DeclareLaunchArgument, IncludeLaunchDescription
    from studio.launch.vocabulary.context import LaunchContext
    from studio.launch.vocabulary.requests import Later, Request
    from studio.launch.watchdog import Limits
    from studio.packages.index import PackageIndex

_AFTER_LIMIT_S: Final = 3.0
_LEFT_S: Final = 15.0
"""So long after the end was asked for is waited for a launch file that does not let go."""


class Runner(BaseHost):
    """Starts what is visited. `load` visits, `run` lives until the group has ended.

    Args:
        index: The packages.
        asking: The launch file, or the folder, from which packages are looked for.
        environment: What nodes get beside this process's own environment: the way to the router.
        reporter: Who is told.
        limits: What the group may have.
        prepared: Makes nodes in Python, where it can.
    """

    def __init__(
        self,
        index: PackageIndex,
        asking: Path,
        environment: Mapping[str, str],
        reporter: Reporter,
        limits: Limits = GROUP_LIMITS,
        prepared: Prepared | None = None,
    ) -> None:
        super().__init__(index, asking)
        self._own = dict(environment)
        self._reporter, self._prepared = reporter, prepared
        self._watchdog = Watchdog(os.getpid(), limits, with_leader=False)
        self._over = threading.Event()
        self.loop = asyncio.new_event_loop()
        self._numbers = itertools.count(1)
        self._names: dict[str, int] = {}
        self._processes: dict[int, RunningProcess] = {}
        self._tasks: set[asyncio.Task[Any]] = set()
        self._waiting: list[RunningProcess] = []
        self._handlers: dict[int, tuple[Later, LaunchContext]] = {}
        self._timers: dict[int, asyncio.TimerHandle] = {}
        self._handles = itertools.count(1)
        self._loop_runs = False
        self._shuts_down = False
        self._changed = asyncio.Event()
        self._code = 0
        self._shown = 0
        self._stays = False
        self._lifecycle: Any = None
        self._commands = CommandOutput(index, asking)
        self._interrupts: Interrupts | None = None
        self._left_out: set[tuple[str, str]] = set()
        self._declared: set[str] = set()
        self._contexts: dict[int, LaunchContext] = {}

    # The life of the group.

    def load(self, source: Any, given: Mapping[str, str], context: LaunchContext) -> None:
        """Visit a source: processes are made, and started by `run`.

        Raises:
            LaunchFileError: The launch file cannot be read, or fails.
        """
        context.asyncio_loop = self.loop
        context.launch_configurations.update(given)
        try:
            path, description = self.read_include(source, context)
            self.walk_included(path, description, context)
        except Exception as error:
            raise fault_at(error, None) from error
        known = ", ".join(sorted(self._declared)) or "none"
        for name in sorted(set(given) - self._declared):
            self._reporter.log("warn", f"{name} is no argument of {path}: it has {known}")

    def run(self) -> int:
        """Run until all have ended; returns the exit code."""
        asyncio.set_event_loop(self.loop)
        try:
            self.loop.run_until_complete(self._live())
        finally:
            self._over.set()
            self._watchdog.kill()
            self.loop.close()
            if self._interrupts is not None:
                self._interrupts.close()
            if self._lifecycle is not None:
                self._lifecycle.close()
        self._reporter.ended(self._code)
        return self._code

    def shut_down(self, reason: str, *, failed: bool = False) -> None:
        """End the group, once; handlers of the end come first."""
        if failed:
            self._code = 1
        if self._shuts_down:
            return
        self._shuts_down = True
        for timer in self._timers.values():
            timer.cancel()
        self._timers.clear()
        # What a handler of the end starts is done to its end.
        running = list(self._processes.values())
        self._dispatch(events.Shutdown(reason=reason))
        for one in running:
            one.end()
        for task in self._tasks:
            if task.get_name() == "coroutine":
                task.cancel()
        self._changed.set()

    async def _live(self) -> None:
        self._loop_runs = True
        if self._interrupts is not None:
            self._interrupts.begin()
        waiting, self._waiting = self._waiting, []
        for one in waiting:
            self._begin(one)
        while self._is_busy():
            self._changed.clear()
            await self._changed.wait()

    def _is_busy(self) -> bool:
        """Whether something runs or is going to; what the page shows holds the launch open."""
        if any(not task.done() for task in self._tasks):
            return True
        return not self._shuts_down and (bool(self._timers) or (self._stays and self._shown > 0))

    def guard(self, commands: int | None) -> None:
        """Watch the group, and hear commands: on threads, for a launch file may not let go.

        Args:
            commands: A descriptor on which commands come, and whose end ends the group.
        """
        self._stays = commands is not None
        self._interrupts = Interrupts(self._heard, self._give_up)
        threading.Thread(target=self._watch, daemon=True).start()
        if commands is not None:
            threading.Thread(target=self._hear, args=(commands,), daemon=True).start()

    def _watch(self) -> None:
        while not self._over.wait(WATCH_EVERY_S):
            reason = self._watchdog.exceeded()
            if reason:
                self._reporter.log("error", f"the launch is ended: {reason}")
                self._call(partial(self.shut_down, reason, failed=True))
                self._watchdog.kill()
                if not self._over.wait(_AFTER_LIMIT_S):
                    os._exit(1)
                return

    def _heard(self, number: int) -> None:
        """Take a signal, on its own thread."""
        self._commands.end()
        self._call(self._interrupted, number)

    def _give_up(self) -> None:
        """Leave at once: the launch file's own code holds the loop."""
        self._reporter.log(
            "error", "the launch file does not let go: all that it started is killed"
        )
        self._watchdog.kill()
        os._exit(1)

    def _interrupted(self, number: int) -> None:
        if self._interrupts is not None:
            self._interrupts.taken()
        if self._shuts_down:
            if number == signal.SIGINT:
                text = "user interrupted with ctrl-c (SIGINT) again, ignoring..."
                self._reporter.log("warn", text)
            for one in list(self._processes.values()):
                one.end()
            return
        if number == signal.SIGINT:
            self._reporter.log("warn", "user interrupted with ctrl-c (SIGINT)")
            self.shut_down("ctrl-c (SIGINT)")
        else:
            self.shut_down(signal.Signals(number).name)

    def _hear(self, descriptor: int) -> None:
        """Take commands in a thread of its own, until they end, and the group with them."""
        rest = b""
        with contextlib.suppress(OSError):
            while data := os.read(descriptor, 1 << 16):
                *lines, rest = (rest + data).split(b"\n")
                rest = rest[-(1 << 16) :]
                for line in lines:
                    self._call(self._obey, line)
        self._commands.end()
        self._call(self.shut_down, "the one who started it is gone")
        time.sleep(_LEFT_S)
        self._watchdog.kill()
        os._exit(1)

    def _call(self, function: Any, *arguments: Any) -> None:
        with contextlib.suppress(RuntimeError):  # the loop has just been closed
            self.loop.call_soon_threadsafe(function, *arguments)

    def _obey(self, line: bytes) -> None:
        try:
            command = read_command(line)
        except ValueError as error:
            if line.strip():
                self._reporter.log("error", f"a command was not understood ({error})")
            return
        if isinstance(command, Stop):
            self.shut_down("it was stopped")
            return
        process = self._processes.get(command.id)
        if process is None:
            self._reporter.log("error", f"nothing of this launch has the id {command.id}")
        elif isinstance(command, EndProcess):
            process.end()
        elif isinstance(command, Restart) and not self._shuts_down:  # pyright: ignore[reportUnnecessaryIsInstance]
            self._start_again(process)

    def _start_again(self, process: RunningProcess) -> None:
        if process.is_alive:
            process.restart()
        else:
            self._begin(process)

    def _begin(self, process: RunningProcess) -> None:
        self._spawn(process.live(), "process")

    def _spawn(self, coroutine: Any, name: str) -> None:
        task = self.loop.create_task(coroutine, name=name)
        self._tasks.add(task)
        task.add_done_callback(self._finished)

    def _finished(self, task: asyncio.Task[Any]) -> None:
        self._tasks.discard(task)
        self._changed.set()
        if not task.cancelled() and (error := task.exception()) is not None:
            self._trouble(error)

    def _trouble(self, error: BaseException) -> None:
        fault = fault_at(error, None) if isinstance(error, Exception) else LaunchError(str(error))
        self._reporter.log("error", str(fault))
        self.shut_down("an action failed", failed=True)

    # What happens.

    def visit(self, entity: Any, context: LaunchContext) -> None:
        """Visit one, then what it gives.

        Raises:
            LaunchFileError: It fails; the line is that of the launch file.
        """
        try:
            super().visit(entity, context)
        except Exception as error:
            raise fault_at(error, entity) from error

    def _happened(self, process: RunningProcess, kind: str, data: dict[str, Any]) -> None:
        request = process.request
        action = request.action
        if kind == "io" and not any(
            later.kind in ("on_io", "other") for later, _ in self._handlers.values()
        ):
            return
        common: dict[str, Any] = {
            "action": action,
            "name": process.name,
            "cmd": process.command,
            "cwd": request.cwd or None,
            "env": None,
            "pid": process.pid,
        }
        if kind == "started":
            action.process_details = dict(common)
            self._dispatch(events.ProcessStarted(**common))
        elif kind == "io":
            self._dispatch(events.ProcessIO(**common, **data))
        else:
            action.return_code = data["returncode"]
            event = events.ProcessExited(**common, **data)
            if request.on_exit is not None and not self._shuts_down:
                self._do(request.on_exit, event, self._contexts[process.number], request)
            self._dispatch(event)
            self._dispatch(events.ExecutionComplete(action=action))
        self._changed.set()

    def _dispatch(self, event: Any) -> None:
        for handle, (later, context) in list(self._handlers.items()):
            if self._shuts_down and later.kind in ("on_start", "timer"):
                continue
            try:
                matches = later.matches is not None and later.matches(event)
            except Exception as error:  # noqa: BLE001 - a function of the launch file
                self._trouble(fault_at(error, later))
                continue
            if matches:
                if later.once:
                    self._handlers.pop(handle, None)
                self._do(later.entities, event, context, later)

    def _do(
        self, entities: Any, event: Any, context: LaunchContext, asked: Later | Request
    ) -> None:
        context.locals.event = event
        try:
            self.walk(entities_of(entities, event, context), context)
        except Exception as error:  # noqa: BLE001 - actions of the launch file
            self._trouble(fault_at(error, asked))

    # What actions ask for.

    def declare(self, argument: DeclareLaunchArgument, context: LaunchContext) -> None:
        """Give an argument its value.

        Raises:
            LaunchError: It has none, or one that is no choice.
        """
        self._declared.add(argument.name)
        value = self.value_of_argument(argument, context)
        if value is None:
            choices = f", one of {', '.join(argument.choices)}" if argument.choices else ""
            raise LaunchError(
                f"the argument {argument.name} has no value and no default: give "
                f"{argument.name}:=...{choices}"
            )
        if fault := choice_fault(argument, value):
            raise LaunchError(fault)
        context.launch_configurations[argument.name] = value

    def start(self, request: Request, context: LaunchContext) -> None:
        """Make a process of a request, or say why none is made."""
        number = next(self._numbers)
        if self._shuts_down and request.kind != "process":
            if isinstance(getattr(context.locals, "event", None), events.Shutdown):
                self._reporter.not_started(number, request, "the launch ends")
            return
        beginning = beginning_of(self.index, request)
        if beginning.fault:
            self._code = 1
            self.failed(beginning.fault, request.where)
        if not beginning.start.starts:
            self._reporter.not_started(number, request, beginning.start.text)
            return
        if beginning.start.kind == "page" and self._reporter.shows_rviz:
            self._shown += 1
            self._reporter.shown(number, request, beginning.config)
            return
        self._contexts[number] = context.snapshot()
        words = self._words(request, beginning)
        environment = {**os.environ, **self._own, **beginning.environment, **request.environment}
        process = RunningProcess(
            number,
            self._numbered(request),
            request,
            words,
            environment,
            self._reporter,
            self._happened,
            lambda _: self._changed.set(),
            self._prepared,
        )
        self._processes[number] = process
        if request.kind == "lifecycle":
            self._follow_lifecycle(request)
        if self._loop_runs:
            self._begin(process)
        else:
            self._waiting.append(process)

    @staticmethod
    def _words(request: Request, beginning: Beginning) -> list[str]:
        if beginning.start.kind == "page":
            config = ["-d", beginning.config] if beginning.config else []
            return [*request.prefix, *beginning.command, *config]
        if beginning.start.kind == "command" and request.kind != "process":
            return [*request.prefix, *beginning.command, *request.arguments]
        return command_line(request, beginning.command)

    def _numbered(self, request: Request) -> str:
        """Return a name as ROS gives it: that given or the executable's, with a shared number."""
        name = request.label or request.executable or request.name
        self._names[""] = self._names.get("", 0) + 1
        return f"{name}-{self._names['']}"

    def later(self, later: Later, context: LaunchContext) -> int:
        """Keep what is to be done later; gives its handle."""
        handle = next(self._handles)
        kept = context.snapshot()
        if later.period_s is None:
            self._handlers[handle] = (later, kept)
        elif not self._shuts_down:
            self._timers[handle] = self.loop.call_later(
                later.period_s, self._ring, handle, later, kept
            )
        return handle

    def _ring(self, handle: int, later: Later, context: LaunchContext) -> None:
        self._timers.pop(handle, None)
        self._do(later.entities, events.TimerEvent(timer_action=None), context, later)
        self._changed.set()

    def forget(self, handle: Any) -> None:
        """Do it no more."""
        self._handlers.pop(handle, None)
        if (timer := self._timers.pop(handle, None)) is not None:
            timer.cancel()
        self._changed.set()

    def emit(self, event: Any, context: LaunchContext) -> None:
        """Have an event happen, once the loop comes to it."""
        del context
        self.loop.call_soon(self._take, event)

    def _take(self, event: Any) -> None:
        if isinstance(event, events.Shutdown):
            self._reporter.log("info", f"the launch ends: {event.reason}")
            self.shut_down(event.reason)
            return
        if isinstance(event, events.ProcessTargetedEvent):
            self._signal(event)
        elif isinstance(event, events.ChangeState):
            self._change_state(event)
        self._dispatch(event)

    def _signal(self, event: events.ProcessTargetedEvent) -> None:
        for one in list(self._processes.values()):
            if not event.process_matcher(one.request.action):
                continue
            if isinstance(event, events.SignalProcess):
                one.send(event.signal)
            elif isinstance(event, events.ShutdownProcess):
                one.end()

    def _change_state(self, event: events.ChangeState) -> None:
        for one in list(self._processes.values()):
            request = one.request
            if request.kind == "lifecycle" and event.lifecycle_node_matcher(request.action):
                self._follow_lifecycle(request)
                name = request.full_name
                change = self._lifecycle.change(name, event.transition_id)
                self._spawn(asyncio.to_thread(change), "lifecycle")

    def _follow_lifecycle(self, request: Request) -> None:
        from studio.launch.lifecycle import LifecycleNodes  # noqa: PLC0415 - few launches need it

        if self._lifecycle is None:
            self._lifecycle = LifecycleNodes(
                self._own, lambda text: self._call(self._reporter.log, "error", text)
            )

        def moved(transition: str, start: str, goal: str) -> None:
            event = events.StateTransition(
                action=request.action, transition=transition, start=start, goal=goal
            )
            self._call(self._dispatch, event)

        self._lifecycle.follow(request.full_name, moved)

    def include(
        self, source: IncludeLaunchDescription, given: dict[str, str], context: LaunchContext
    ) -> None:
        """Read another launch file and visit what it describes."""
        context.launch_configurations.update(given)
        path, description = self.read_include(source.launch_description_source, context)
        self.walk_included(path, description, context)

    def log(self, level: str, text: str, where: Where) -> None:
        """Say a line of the launch file."""
        del where
        self._reporter.process_log(level, "launch.user", text)

    def output_of(self, line: str, on_stderr: str, where: Where) -> str:
        """Run a command and return what it prints.

        Raises:
            SubstitutionFailure: It cannot be run, fails, or prints to stderr where it must not.
        """
        del where
        printed, errors = self._commands.of(line)
        self._judge_errors(line, on_stderr, errors)
        return printed

    def _judge_errors(self, line: str, on_stderr: str, errors: str) -> None:
        if not errors or on_stderr in ("ignore", "capture"):
            return
        if on_stderr == "warn":
            self._reporter.log("warn", errors)
            return
        raise SubstitutionFailure(
            f"executed command showed stderr output. Command: {line}: {errors}"
        )

    def unsupported(self, name: str, sentence: str, where: Where) -> None:
        """Say what is left out, once for each line."""
        if (name, str(where)) not in self._left_out:
            self._left_out.add((name, str(where)))
            self._reporter.log("warn", f"{sentence} ({where})" if where.file else sentence)

    def failed(self, sentence: str, where: Where) -> None:
        """Say what is not right, and go on."""
        self._reporter.log("error", f"{where}: {sentence}")
