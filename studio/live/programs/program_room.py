"""Programs: all that the owner runs out of the page, in one place."""

from __future__ import annotations

import asyncio
import threading
from typing import TYPE_CHECKING, Final

from studio.live.programs import planning, run_room, workspaces
from studio.protocol.commands import Commands, Scope
from studio.system import python_command

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping
    from pathlib import Path

    from studio.launch.plan import Plan
    from studio.live.connection.ros_connection import RosConnection
    from studio.live.panels.changes import Changes
    from studio.packages.index import PackageIndex
    from studio.packages.run_folders import RunFolders
    from studio.settings import Settings


_STUDIO: Final = python_command("studio")


class Programs:
    """Builds the parts, and connects those that follow others' changes.

    Attributes:
        workspaces: What the opened folders hold.
        planning: What launch files would start.
        runs: What was started.
    """

    def __init__(
        self,
        settings: Settings,
        allowed: RunFolders,
        wire: RosConnection,
        opened: Callable[[], Iterable[Path]],
        changes: Changes,
    ) -> None:
        self._allowed, self._data_folder = allowed, settings.data_folder
        self.workspaces = workspaces.WorkspaceRoom(
            settings,
            allowed,
            opened,
            lambda: changes.changed("workspaces"),
            self._saved,
        )
        self.planning = planning.Planning(allowed, self)
        self.runs = run_room.ProgramRuns(allowed, self, wire, lambda: changes.changed("runs"))
        self.runs.on_again = self.workspaces.follow

    def _saved(self, files: set[Path]) -> None:
        self.runs.saved(files)

    async def index_at(self, folder: Path) -> PackageIndex:
        """Return the packages that files of a folder see."""
        return await self.workspaces.index_at(folder)

    def launch_command(self, file: Path, words: tuple[str, ...]) -> tuple[str, ...]:
        """Return the process that runs a launch file and speaks by `studio.launch.events`."""
        found = ("--package-path", str(self._allowed.folder_of(file)))
        found += ("--data-dir", str(self._data_folder))
        return (*_STUDIO, "launch", "--events", *found, str(file), *words)

    async def plan(self, file: Path, arguments: Mapping[str, str]) -> Plan:
        """Return what a launch file would start; a cancelled call ends the process.

        Raises:
            PackageError: The packages around it cannot be read.
        """
        index = await self.index_at(self._allowed.folder_of(file))
        given_up = threading.Event()
        work = asyncio.to_thread(_planned, file, arguments, index, given_up)
        try:
            return await asyncio.shield(asyncio.ensure_future(work))
        finally:
            given_up.set()

    async def let_go(self) -> None:
        """End all that runs: the connection that it shares is about to."""
        await self.runs.let_go()

    async def close(self) -> None:
        """End all."""
        await asyncio.gather(self.planning.close(), self.workspaces.close(), self.runs.close())


def _planned(
    file: Path, arguments: Mapping[str, str], index: PackageIndex, given_up: threading.Event
) -> Plan:
    from studio.launch.planning import plan_launch_file  # noqa: PLC0415 - takes its time

    return plan_launch_file(file, arguments, index, given_up=given_up)


COMMANDS: Final = Commands[Programs](Scope.STUDIO)
COMMANDS.include(workspaces.COMMANDS, lambda programs, _: programs.workspaces)
COMMANDS.include(planning.COMMANDS, lambda programs, _: programs.planning)
COMMANDS.include(run_room.COMMANDS, lambda programs, _: programs.runs)
