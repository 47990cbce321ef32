"""Starts robot workers: `python -m studio.robot.worker`."""

from __future__ import annotations

from studio.robot.requests import robot_codec
from studio.settings import mesh_worker_count
from studio.workers import Worker, WorkerPool

_MODULE = "studio.robot.worker"


def robot_worker(name: str) -> Worker:
    """One worker process, started at its first request."""
    return Worker(name, _MODULE, robot_codec())


def mesh_pool(size: int | None = None) -> WorkerPool:
    """The processes that read meshes, one less than the cores if no size is given.

    Up to two more while slow meshes keep others waiting.
    """
    size = size or mesh_worker_count()
    return WorkerPool(size, lambda number: robot_worker(f"mesh {number}"), most=size + 2)
