"""A second opinion on an expanded URDF, asked for beside the drawing and never waited for by it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.errors import WorkerError
from studio.problems import Problem, Severity
from studio.robot.pool import robot_worker
from studio.robot.requests import CheckAnswer, CheckRequest

if TYPE_CHECKING:
    from studio.workers import Worker

_TIMEOUT_S = 20.0


class UrdfValidator:
    """Asks yourdfpy in a worker of its own, so that no mesh waits for its slow import."""

    def __init__(self, worker: Worker | None = None) -> None:
        self._worker = worker or robot_worker("validation")

    async def check(self, urdf_text: str) -> CheckAnswer:
        """Names and problems as yourdfpy sees them; a worker that falls is a problem too."""
        try:
            return await self._worker.ask(CheckRequest(urdf_text), CheckAnswer, _TIMEOUT_S)
        except WorkerError as error:
            problem = Problem(Severity.WARNING, "not-validated", f"Not validated: {error}")
            return CheckAnswer((), (), "", (problem,))

    async def validate(self, urdf_text: str) -> list[Problem]:
        """Only the problems."""
        return list((await self.check(urdf_text)).problems)

    async def close(self) -> None:
        """End the worker."""
        await self._worker.close()
