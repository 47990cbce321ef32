"""Checks the robot of a document when it has not changed for a moment."""

from __future__ import annotations

import asyncio
import logging
from typing import TYPE_CHECKING

from studio.debounce import Debouncer
from studio.errors import PackageError
from studio.robot.checks.finding import CheckedRobot
from studio.robot.checks.robot_checks import check_robot

if TYPE_CHECKING:
    from studio.documents.checks.mesh_checks import MeshChecks
    from studio.documents.checks.pace import Pace
    from studio.documents.findings import Findings
    from studio.documents.model import Model
    from studio.documents.runs import LastRun
    from studio.documents.workspace import Workspace

_log = logging.getLogger(__name__)


class RobotChecks:
    """Finds what is wrong with the robot of the last good run; the work is done in a thread."""

    def __init__(
        self,
        workspace: Workspace,
        last_run: LastRun,
        model: Model,
        meshes: MeshChecks,
        findings: Findings,
        pace: Pace,
    ) -> None:
        self._workspace, self._last_run, self._model = workspace, last_run, model
        self._meshes, self._findings = meshes, findings
        self._checking = Debouncer(self._check_all, pace.quiet_s, pace.opened)

    def trigger(self) -> None:
        """Check the robot when it has been quiet for a while."""
        self._checking.trigger()

    @property
    def is_settled(self) -> bool:
        """Whether the robot as it is now was checked."""
        return self._checking.is_settled

    async def settled(self) -> None:
        """Wait until the robot as it is now has been checked."""
        await self._checking.settled()

    async def close(self) -> None:
        """Check no more."""
        await self._checking.close()

    async def _check_all(self) -> None:
        try:
            await self._check()
            if await self._meshes.read_hidden():
                await self._check()
        except Exception:  # noqa: BLE001 - the checks of one robot may not end those of the next
            _log.exception("The checks of %s failed.", self._workspace.path)

    async def _check(self) -> None:
        if self._last_run.failed:
            return  # the texts are ahead of the robot
        snapshot = self._snapshot()
        found = await asyncio.to_thread(check_robot, snapshot)
        of_meshes = await self._meshes.check(snapshot.source)
        self._findings.replace("checks", (*found, *of_meshes))

    def _snapshot(self) -> CheckedRobot:
        """Return the robot and all that is known around it, as values that no edit changes."""
        model = self._model
        parts = {part.key: part for part in model.assembly.parts()}
        texts = {file: self._text(file) for file in self._last_run.files}
        return CheckedRobot(model.robot, parts.get, self._meshes.bounds().get, texts.get)

    def _text(self, file: str) -> bytes | None:
        try:
            return self._workspace.sources.text(file)
        except PackageError:
            return None
