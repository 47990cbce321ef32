"""Shared by all documents: the mesh library, the workers, and the settings."""

from __future__ import annotations

import asyncio
from importlib import import_module
from typing import TYPE_CHECKING, Final, TypeAlias

from studio.description.client import DescriptionWorker
from studio.live.connection.ros_connection import RosConnection
from studio.live.displays.plugins import Plugins
from studio.live.time.rewinding import Rewinding
from studio.packages.run_folders import RunFolders
from studio.robot.meshes.library import MeshLibrary
from studio.robot.worker_client import UrdfValidator, mesh_pool

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable, Coroutine

    from studio.settings import Settings

    Opened: TypeAlias = Callable[[float], Awaitable[None]]

USED_LATER: Final = (
    *("studio.live.displays.drawing_room", "studio.live.displays.robot_models"),
    "studio.live.displays.marker_servers",
    *("studio.displays.robot_model", "studio.scene.picked_rows"),
    *("studio.live.displays.catalogue_views", "studio.live.displays.topic_views"),
    "studio.live.displays.plugin_display",
    *("studio.rviz.config", "studio.live.connection.followed_joints"),
    *("studio.live.panels.goal_work", "studio.live.panels.parameter_work"),
    *("studio.live.panels.publication_work", "studio.live.panels.requests"),
    "studio.live.panels.tool_work",
    "studio.documents.lessons.graph_checks",
    *("studio.live.doctor.asking", "studio.live.doctor.examination", "studio.live.doctor.report"),
    "studio.live.doctor.watching",
    *("studio.live.programs.making", "studio.launch.planning", "studio.programs.finding"),
    *("studio.ros.node.raw_subscription", "studio.ros.lifecycle.client"),
    *(
        "studio.bags.cutting",
        "studio.bags.metadata",
        "studio.bags.opening",
        "studio.bags.series",
        "studio.nodes.bag_recorder",
    ),
    *("studio.ros.messages", "studio.ros.graph.graph", "studio.ros.types.convert"),
)
"""With what they import, all that functions of the loop import when they are first called."""


class Services:
    """Built once by the engine, on its loop."""

    def __init__(self, settings: Settings) -> None:
        self.settings = settings
        self.quiet_s = 0.4
        """Without a run or a mesh, before a document is checked: no edit ever waits for it."""
        self.patience_s = 5.0
        """Background work starts after the last mesh of an opening, or after this time."""
        self._pool = mesh_pool()
        self.meshes = MeshLibrary(settings.data_folder / "meshes", self._pool)
        self.validator = UrdfValidator()
        self.wire = RosConnection(settings.wire, settings.rewind_bytes)
        self.rewinding = Rewinding(self.wire.past)
        self.run_folders = RunFolders(settings.run_folders, settings.data_folder)
        self.plugins = Plugins(settings.display_folders)
        self.on_time_switch: Callable[[str], object] = lambda _: None
        """Told the id of a document that shows another time from now on."""
        self.on_moment: Callable[[str], object] = lambda _: None
        """Told the id of a document that shows another moment of its recording."""
        self._spare = DescriptionWorker()
        self._keeps_warm = False
        """Whether processes are started before they are needed."""
        self._warming: set[asyncio.Task[None]] = set()

    async def start(self) -> None:
        """Warm the workers in the background, and a spare one after each that is taken."""
        self._keeps_warm = True
        self.plugins.start()
        self._warm(self._spare.warm())
        self._warm(self._pool.warm())

    async def import_rest(self, opened: Opened) -> None:
        """Import what an opening does without, in a thread: at its first use it stalls the loop.

        Args:
            opened: Waits for an opening, for so many seconds at most.
        """
        await opened(self.patience_s)
        await asyncio.to_thread(_import_rest)

    def description_worker(self, opened: Opened | None = None) -> DescriptionWorker:
        """Return a worker of one document's own, warm where one was spare; the next spare is made.

        Args:
            opened: Waits for an opening, for so many seconds at most; the next spare starts then.
        """
        taken, self._spare = self._spare, DescriptionWorker()
        if self._keeps_warm:
            self._warm(self._warm_spare(self._spare, opened))
        return taken

    async def _warm_spare(self, spare: DescriptionWorker, opened: Opened | None) -> None:
        if opened is not None:
            await opened(self.patience_s)
        if spare is self._spare:  # else it was taken, and perhaps ended, meanwhile
            await spare.warm()

    def _warm(self, work: Coroutine[None, None, None]) -> None:
        task = asyncio.create_task(work)
        self._warming.add(task)
        task.add_done_callback(self._warming.discard)

    async def close(self) -> None:
        """End all workers."""
        self.rewinding.close()
        warming = tuple(self._warming)
        for task in warming:
            task.cancel()
        await asyncio.gather(*warming, return_exceptions=True)
        workers = (self._pool.close(), self._spare.close(), self.validator.close())
        await asyncio.gather(*workers, self.wire.close(), self.plugins.close())


def _import_rest() -> None:
    for name in USED_LATER:
        import_module(name)
