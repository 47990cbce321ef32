"""What all documents share: the mesh library, the workers, and the settings."""

from __future__ import annotations

import asyncio
import contextlib
from typing import TYPE_CHECKING

from studio.description.client import DescriptionWorker
from studio.robot.meshes import MeshLibrary
from studio.robot.pool import mesh_pool
from studio.robot.validation import UrdfValidator

if TYPE_CHECKING:
    from studio.settings import Settings


class Services:
    """Built once by the engine, on its loop."""

    def __init__(self, settings: Settings) -> None:
        self.settings = settings
        self._pool = mesh_pool()
        self.meshes = MeshLibrary(settings.data_folder / "meshes", self._pool)
        self.validator = UrdfValidator()
        self._warming: asyncio.Task[None] | None = None

    async def start(self) -> None:
        """Warm the mesh workers in the background."""
        self._warming = asyncio.create_task(self._pool.warm())

    def description_worker(self) -> DescriptionWorker:
        """A worker of one document's own."""
        return DescriptionWorker()

    async def close(self) -> None:
        """End all workers."""
        if self._warming:
            self._warming.cancel()
            with contextlib.suppress(asyncio.CancelledError):
                await self._warming
        await asyncio.gather(self._pool.close(), self.validator.close())
