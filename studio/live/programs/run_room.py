"""Launch files and nodes that the owner starts out of the page; they end with the studio."""

from __future__ import annotations

import asyncio
import itertools
import shlex
from dataclasses import replace
from typing import TYPE_CHECKING, Final, Protocol

from studio.errors import CommandError, NotRunnableError, StudioError
from studio.live.programs.runs import Run, Wanted
from studio.packages.roots import is_below, package_folder_of
from studio.protocol.commands import Commands, Limits, Scope
from studio.protocol.launching import (
    EndProcess,
    ForgetRun,
    GetRunOutput,
    GetRuns,
    OutputLine,
    RestartProcess,
    RunAgainOnSave,
    RunOutput,
    Runs,
    RunStarted,
    StartLaunch,
    StartNode,
    StartRunAgain,
    StopRun,
)
from studio.ros.wire.settings import environment_for

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping
    from pathlib import Path

    from studio.live.connection.ros_connection import RosConnection
    from studio.packages.index import PackageIndex
    from studio.packages.run_folders import RunFolders
    from studio.programs.program import Program

RUNNING_MAX: Final = 20
KEPT_MAX: Final = 50
"""Runs in the list; the oldest that have ended are forgotten."""
_STARTS: Final = Limits(per_second=5)
_HOW_TO: Final = "start the studio with --allow-run FOLDER, the folder of a workspace"


class Found(Protocol):
    """Where packages are found."""

    async def index_at(self, folder: Path) -> PackageIndex:
        """Return the packages that files of a folder see."""
        ...

    def launch_command(self, file: Path, words: tuple[str, ...]) -> tuple[str, ...]:
        """Return the process that runs a launch file and speaks by `studio.launch.events`."""
        ...


class ProgramRuns:
    """Starts, stops and lists them; used on the event loop.

    Args:
        allowed: Decides what may be run.
        found: Finds packages and commands.
        wire: The ROS system that they join.
        changed: Called when one changed or printed something.
    """

    def __init__(
        self,
        allowed: RunFolders,
        found: Found,
        wire: RosConnection,
        changed: Callable[[], object] = lambda: None,
    ) -> None:
        self._allowed, self._found, self._wire, self._changed = allowed, found, wire, changed
        self.on_again: Callable[[], None] = lambda: None
        """Called when what is to be started again on save becomes other runs."""
        self._runs: dict[int, Run] = {}
        self._numbers = itertools.count(1)
        self._again: set[asyncio.Task[None]] = set()
        self._closed = False

    @property
    def again_folders(self) -> frozenset[Path]:
        """The packages whose saved files start something again."""
        return frozenset(run.wanted.folder for run in self._runs.values() if run.again_on_save)

    def runs(self, command: GetRuns) -> Runs:
        """Return all runs, the newest first."""
        views = (run.view() for run in reversed(self._runs.values()))
        return Runs(request=command.request, runs=tuple(views))

    def output(self, command: GetRunOutput) -> RunOutput:
        """Return what a run printed after the lines known.

        Raises:
            CommandError: There is no such run.
        """
        lines = self._run(command.run).lines
        return RunOutput(
            request=command.request,
            run=command.run,
            lines=tuple(
                OutputLine(number=one.number, process=one.process, stream=one.stream, text=one.text)
                for one in lines.after(command.after)
            ),
            last=lines.last,
            dropped=lines.dropped,
        )

    async def start_launch(self, command: StartLaunch) -> RunStarted:
        """Run a launch file.

        Raises:
            NotRunnableError: It may not be run.
            CommandError: It cannot be started, or there is no connection.
        """
        file = self._allowed.resolve(command.file)
        words = tuple(f"{name}:={value}" for name, value in command.arguments.items())
        folder = package_folder_of(file)
        package = "" if folder is None else folder.name
        named = ("ros2", "launch", *([package, file.name] if package else [str(file)]), *words)
        wanted = Wanted(
            "launch",
            str(file),
            folder or file.parent,
            self._found.launch_command(file, words),
            words,
            shlex.join(named),
            package,
        )
        return RunStarted(request=command.request, run=await self._start(wanted))

    async def start_node(self, command: StartNode) -> RunStarted:
        """Run an executable of a package.

        Raises:
            ProgramError: There is none, or it would not start in ROS 2 either.
            NotRunnableError: It may not be run.
            CommandError: It cannot be started, or there is no connection.
        """
        program, folder = await self._program(command.package, command.executable)
        named = ("ros2", "run", command.package, command.executable, *command.arguments)
        wanted = Wanted(
            "node",
            str(program.file or ""),
            folder,
            (*program.command, *command.arguments),
            command.arguments,
            shlex.join(named),
            command.package,
            command.executable,
            program.environment,
        )
        return RunStarted(request=command.request, run=await self._start(wanted))

    async def stop(self, command: StopRun) -> None:
        """End a run; returns when it has ended."""
        await self._run(command.run).stop()

    async def start_again(self, command: StartRunAgain) -> None:
        """Start a run again, from what its files say now; errors as those of its first start."""
        run = self._run(command.run)
        self._demand_room(run)
        run.wanted = await self._renewed(run.wanted)
        await run.start(self._environment())

    def restart_process(self, command: RestartProcess) -> None:
        """Start one process of a launch again."""
        self._run(command.run).restart_process(command.process)

    def end_process(self, command: EndProcess) -> None:
        """End one process of a launch."""
        self._run(command.run).end_process(command.process)

    def again_on_save(self, command: RunAgainOnSave) -> None:
        """Start a run again whenever a file of its package is saved, or no more."""
        self._run(command.run).again_on_save = command.on
        self._changed()
        self.on_again()

    def forget(self, command: ForgetRun) -> None:
        """Take a run out of the list.

        Raises:
            CommandError: It goes on.
        """
        if not self._run(command.run).is_over:
            raise CommandError(f"Run {command.run} goes on: stop it first.")
        del self._runs[command.run]
        self._changed()
        self.on_again()

    def saved(self, files: Iterable[Path]) -> None:
        """Start again what is to be when one of these files is saved."""
        folders = {one for one in self.again_folders if any(is_below(file, one) for file in files)}
        for run in self._runs.values():
            if run.again_on_save and run.wanted.folder in folders:
                task = asyncio.create_task(self._start_saved(run))
                self._again.add(task)
                task.add_done_callback(self._again.discard)

    async def let_go(self) -> None:
        """End all: the connection that they share is about to."""
        await asyncio.gather(*(run.stop() for run in self._runs.values()))

    async def close(self) -> None:
        """End all, and start none any more."""
        self._closed = True
        for task in tuple(self._again):
            task.cancel()
        await asyncio.gather(*self._again, return_exceptions=True)
        await asyncio.gather(*(run.close() for run in self._runs.values()))

    async def _start_saved(self, run: Run) -> None:
        try:
            run.wanted = await self._renewed(run.wanted)
            await run.start_again(self._environment())
        except StudioError as error:  # what runs goes on, and its output says why
            run.lines.say("error", f"Not started again: {error}")
            self._changed()

    async def _start(self, wanted: Wanted) -> int:
        environment = self._environment()
        self._demand_room()
        run = Run(wanted, next(self._numbers), self._changed)
        self._runs[run.number] = run
        over = [one.number for one in self._runs.values() if one.is_over and one is not run]
        for number in over[: max(0, len(self._runs) - KEPT_MAX)]:
            del self._runs[number]
        try:
            await run.start(environment)
        except CommandError:
            self._changed()
            raise
        return run.number

    async def _renewed(self, wanted: Wanted) -> Wanted:
        """Return the same with its command found anew: an entry point may be another by now."""
        if wanted.kind == "launch":
            self._allowed.resolve(wanted.file)
            return wanted
        program, folder = await self._program(wanted.package, wanted.executable)
        return replace(
            wanted,
            file=str(program.file or ""),
            folder=folder,
            command=(*program.command, *wanted.words),
            environment=program.environment,
        )

    async def _program(self, package: str, executable: str) -> tuple[Program, Path]:
        """Find an executable that may be run, and the package folder that it belongs to."""
        if not self._allowed.is_on:
            raise NotRunnableError(f"{package} {executable}", _HOW_TO)
        from studio.programs.finding import find_program  # noqa: PLC0415 - takes its time

        index, folder = await self._package(package)
        program = await asyncio.to_thread(find_program, index, package, executable)
        if program.kind == "studio":
            return program, self._allowed.folders[0]
        if program.kind == "command":
            raise CommandError(
                f"{package} {executable} is a command of the studio itself, and no node: "
                "the page does what it does."
            )
        if folder is None or program.kind == "installed":
            where = f"it lies in no such folder: {_HOW_TO}"
            raise NotRunnableError(f"{package} {executable}", where)
        folder = self._allowed.resolve(folder)
        if program.file is not None:
            self._allowed.resolve(program.file)
        return program, folder

    async def _package(self, package: str) -> tuple[PackageIndex, Path | None]:
        """Return the packages of the first allowed folder that has one of that name."""
        from studio.programs.finding import workspace_folder  # noqa: PLC0415 - takes its time

        indexes = [await self._found.index_at(one) for one in self._allowed.folders]
        for index in indexes:
            if (folder := workspace_folder(index, package)) is not None:
                return index, folder
        return indexes[0], None

    def _run(self, number: int) -> Run:
        run = self._runs.get(number)
        if run is None:
            raise CommandError(f"There is no run {number} any more: look at the list again.")
        return run

    def _demand_room(self, but: Run | None = None) -> None:
        running = [one for one in self._runs.values() if not one.is_over and one is not but]
        if len(running) >= RUNNING_MAX:
            raise CommandError(f"{RUNNING_MAX} launches and nodes run already: stop one first.")

    def _environment(self) -> Mapping[str, str]:
        """Return the environment in which a process joins the studio's ROS system.

        Raises:
            CommandError: The studio is in none.
        """
        link = self._wire.current
        if self._closed or link is None:
            raise CommandError("Not connected to ROS 2: connect first.")
        if not link.is_connected:
            raise CommandError(
                f"The router at {link.endpoint} is gone: a node would meet nobody until it is back."
            )
        return environment_for(link.settings)


COMMANDS: Final = Commands[ProgramRuns](Scope.STUDIO)
COMMANDS.presenter(GetRuns, lambda one, c, _: one.runs(c))
COMMANDS.presenter(GetRunOutput, lambda one, c, _: one.output(c))
COMMANDS.presenter(StartLaunch, lambda one, c, _: one.start_launch(c), limits=_STARTS)
COMMANDS.presenter(StartNode, lambda one, c, _: one.start_node(c), limits=_STARTS)
COMMANDS.presenter(StopRun, lambda one, c, _: one.stop(c))
COMMANDS.presenter(StartRunAgain, lambda one, c, _: one.start_again(c), limits=_STARTS)
COMMANDS.presenter(RestartProcess, lambda one, c, _: one.restart_process(c))
COMMANDS.presenter(EndProcess, lambda one, c, _: one.end_process(c))
COMMANDS.presenter(RunAgainOnSave, lambda one, c, _: one.again_on_save(c))
COMMANDS.presenter(ForgetRun, lambda one, c, _: one.forget(c))
