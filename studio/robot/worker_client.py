"""The studio's side of the robot worker: its processes, validation."""

from __future__ import annotations

from studio.errors import WorkerError
from studio.problems import Problem, Severity
from studio.robot.requests import CODEC, CheckAnswer, CheckRequest
from studio.settings import mesh_worker_count
from studio.workers import Worker, WorkerPool

_MODULE = "studio.robot.worker"
_TIMEOUT_S = 20.0


def robot_worker(name: str) -> Worker:
    """Return a worker process that starts at its first request."""
    return Worker(name, _MODULE, CODEC)


def mesh_pool(size: int | None = None) -> WorkerPool:
    """Return the processes that read meshes, one less than the cores if no size is given.

    Up to two more while slow meshes keep others waiting.
    """
    size = size or mesh_worker_count()
    return WorkerPool(size, lambda number: robot_worker(f"mesh {number}"), most=size + 2)


class UrdfValidator:
    """Runs yourdfpy in a worker of its own, so that no mesh waits for its slow import."""

    def __init__(self, worker: Worker | None = None) -> None:
        self._worker = worker or robot_worker("validation")

    async def check(self, urdf_text: str) -> CheckAnswer:
        """Return names and problems as yourdfpy sees them; a failed worker is a problem, too."""
        try:
            return await self._worker.ask(CheckRequest(urdf_text), CheckAnswer, _TIMEOUT_S)
        except WorkerError as error:
            problem = Problem(Severity.WARNING, "not-validated", f"Not validated: {error}")
            return CheckAnswer((), (), "", (problem,))

    async def validate(self, urdf_text: str) -> list[Problem]:
        """Return only the problems."""
        return list((await self.check(urdf_text)).problems)

    async def close(self) -> None:
        """Stop the worker."""
        await self._worker.close()
