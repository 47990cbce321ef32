"""What all documents share: the mesh library, the workers, and the settings."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

from studio.description.client import DescriptionWorker
from studio.engine.wire.desk import WireDesk
from studio.robot.meshes import MeshLibrary
from studio.robot.pool import mesh_pool
from studio.robot.validation import UrdfValidator

if TYPE_CHECKING:
    from collections.abc import Coroutine

    from studio.settings import Settings


class Services:
    """Built once by the engine, on its loop."""

    def __init__(self, settings: Settings) -> None:
        self.settings = settings
        self.quiet_s = 0.4
        """Without a run or a mesh, before a document is checked: no edit ever waits for it."""
        self._pool = mesh_pool()
        self.meshes = MeshLibrary(settings.data_folder / "meshes", self._pool)
        self.validator = UrdfValidator()
        self.wire = WireDesk(settings.wire)
        self._spare = DescriptionWorker()
        self._warming: set[asyncio.Task[None]] = set()

    async def start(self) -> None:
        """Warm the workers in the background."""
        self._warm(self._spare.warm())
        self._warm(self._pool.warm())

    def description_worker(self) -> DescriptionWorker:
        """A worker of one document's own, warm where one was spare; the next spare is started."""
        taken, self._spare = self._spare, DescriptionWorker()
        self._warm(self._spare.warm())
        return taken

    def _warm(self, work: Coroutine[None, None, None]) -> None:
        task = asyncio.create_task(work)
        self._warming.add(task)
        task.add_done_callback(self._warming.discard)

    async def close(self) -> None:
        """End all workers."""
        warming = tuple(self._warming)
        for task in warming:
            task.cancel()
        await asyncio.gather(*warming, return_exceptions=True)
        workers = (self._pool.close(), self._spare.close(), self.validator.close())
        await asyncio.gather(*workers, self.wire.close())
