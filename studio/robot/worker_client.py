"""The studio's side of the robot worker: its requests and answers, its processes, validation."""

from __future__ import annotations

from dataclasses import dataclass

from studio.errors import WorkerError
from studio.problems import Problem, Severity
from studio.settings import mesh_worker_count
from studio.workers import Codec, Worker, WorkerPool

_MODULE = "studio.robot.worker"
_TIMEOUT_S = 20.0


@dataclass(frozen=True, slots=True)
class MeshRequest:
    """Read a mesh and put it into the cache."""

    path: str
    roots: tuple[str, ...]
    cache_folder: str
    shape: str = ""
    """For an image: the primitive that it is put on; empty for a mesh file."""


@dataclass(frozen=True, slots=True)
class MeshAnswer:
    """The mesh as `pack_mesh` packs it; empty when it is in the cache under `name`."""

    name: str
    blob: bytes


@dataclass(frozen=True, slots=True)
class MeshFault:
    """Why a mesh cannot be shown; `kind` is the class name of the error."""

    kind: str
    subject: str
    reason: str


@dataclass(frozen=True, slots=True)
class CheckRequest:
    """Parse and validate an expanded URDF."""

    urdf: str


@dataclass(frozen=True, slots=True)
class CheckAnswer:
    """What yourdfpy makes of a URDF; the names are empty when it cannot read it at all."""

    links: tuple[str, ...]
    actuated_joints: tuple[str, ...]
    base_link: str
    problems: tuple[Problem, ...]


def robot_codec() -> Codec:
    """The codec of both ends of the robot worker's pipe."""
    return Codec(MeshRequest, MeshAnswer, MeshFault, CheckRequest, CheckAnswer)


def robot_worker(name: str) -> Worker:
    """Return a worker process that starts at its first request."""
    return Worker(name, _MODULE, robot_codec())


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
