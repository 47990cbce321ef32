"""Planning: what a launch file would start, asked out of the page; one question per person."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Final, Protocol

from studio.errors import CommandError
from studio.protocol.commands import Commands, Limits, Scope
from studio.protocol.launch_plans import CancelPlan, LaunchPlan, PlanLaunch

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from studio.launch.plan import Plan
    from studio.packages.run_folders import RunFolders
    from studio.protocol.listeners import Listener

_PLANS: Final = Limits(per_second=10)


class Planner(Protocol):
    """Plans a launch file in a process of its own, within bounds of time and memory."""

    async def plan(self, file: Path, arguments: Mapping[str, str]) -> Plan:
        """Return the plan; a cancelled call ends the process.

        Raises:
            StudioError: It cannot be planned at all.
        """
        ...


class Planning:
    """Answers `plan_launch`; the newest question of a person ends the one before."""

    def __init__(self, allowed: RunFolders, planner: Planner) -> None:
        self._allowed, self._planner = allowed, planner
        self._asked: dict[str, asyncio.Task[Plan]] = {}

    @property
    def is_busy(self) -> bool:
        """Whether something is planned now."""
        return bool(self._asked)

    async def plan(self, command: PlanLaunch, asker: Listener) -> LaunchPlan:
        """Return what a launch file would start.

        Raises:
            NotRunnableError: It may not be planned, for that runs it.
            CommandError: The question was given up.
        """
        file = self._allowed.resolve(command.file)
        self._give_up(asker.person)
        task = asyncio.create_task(self._planner.plan(file, command.arguments))
        self._asked[asker.person] = task
        try:
            # Whoever asked may leave; what is planned is given up by a command, or by a newer one.
            await asyncio.wait({task})
        finally:
            task.cancel()
            if self._asked.get(asker.person) is task:
                del self._asked[asker.person]
        if task.cancelled():
            raise CommandError("The planning was given up.")
        return LaunchPlan(request=command.request, plan=task.result())

    def cancel(self, _: CancelPlan, asker: Listener) -> None:
        """Give up what a person asked."""
        self._give_up(asker.person)

    async def close(self) -> None:
        """Give up all."""
        tasks = tuple(self._asked.values())
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)

    def _give_up(self, person: str) -> None:
        if task := self._asked.get(person):
            task.cancel()


COMMANDS: Final = Commands[Planning](Scope.STUDIO)
COMMANDS.presenter(PlanLaunch, lambda one, c, who: one.plan(c, who), limits=_PLANS)
COMMANDS.presenter(CancelPlan, lambda one, c, who: one.cancel(c, who))
