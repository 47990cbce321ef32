"""Has the robot of a document checked whenever it was left alone for a moment."""

from __future__ import annotations

import asyncio
import logging
from dataclasses import replace
from typing import TYPE_CHECKING

from studio.documents.checks.mesh_checks import HiddenMeshes, NearMeshes
from studio.errors import PackageError
from studio.robot.checks.finding import CheckedRobot
from studio.robot.checks.robot_checks import check_robot
from studio.robot.values import Mesh

if TYPE_CHECKING:
    from studio.documents.document import Document
    from studio.documents.meshes import Meshes
    from studio.documents.services import Services
    from studio.problems import Problem
    from studio.robot.measures import Bounds

_log = logging.getLogger(__name__)


class RobotChecks:
    """Tells the document's board what is wrong with its robot; the looking is done in a thread."""

    def __init__(self, document: Document, services: Services, meshes: Meshes) -> None:
        self._document, self._meshes = document, meshes
        self._hidden = HiddenMeshes(document, services.meshes)
        self._quiet_s, self._patience_s = services.quiet_s, services.patience_s
        self._looking: asyncio.Task[None] | None = None

    def doubt(self) -> None:
        """Something may be other than it was: look when it has been quiet for a while."""
        if self._looking is not None:
            self._looking.cancel()
        self._looking = asyncio.create_task(self._look_later())

    async def settled(self) -> None:
        """Wait until the robot as it is now has been looked at."""
        while self._looking is not None and not self._looking.done():
            await asyncio.wait({self._looking})

    async def close(self) -> None:
        """Look no more."""
        if self._looking is not None:
            self._looking.cancel()
            await asyncio.gather(self._looking, return_exceptions=True)

    async def _look_later(self) -> None:
        await self._document.opened(self._patience_s)
        await asyncio.sleep(self._quiet_s)
        try:
            await self._look()
            if await self._hidden.look(self._hidden_uris()):
                await self._look()
        except Exception:  # noqa: BLE001 - the checks of one robot may not end those of the next
            _log.exception("The checks of %s failed.", self._document.path)

    async def _look(self) -> None:
        if self._document.failed:
            return  # the texts are ahead of the robot
        snapshot = self._snapshot()
        found = await asyncio.to_thread(check_robot, snapshot)
        hidden, shown = self._of_hidden_meshes(), self._meshes.problems
        near = await asyncio.to_thread(self._near(snapshot).mended, hidden | shown)
        self._meshes.tell_nearer({shown[uri]: near[uri] for uri in near if uri in shown})
        of_hidden = [near.get(uri, one) for uri, one in hidden.items()]
        self._document.board.find("checks", (*found, *of_hidden))

    def _near(self, snapshot: CheckedRobot) -> NearMeshes:
        document = self._document
        named = document.model.mesh_uris() | self._hidden_uris()
        return NearMeshes(document.location, document.entry, snapshot.source, named)

    def _snapshot(self) -> CheckedRobot:
        """The robot and all that is known around it, as values that no edit changes."""
        document, model = self._document, self._document.model
        parts = {part.key: part for part in model.assembly.parts()}
        shown = ((uri, model.scene.mesh(uri)) for uri in model.mesh_uris())
        bounds: dict[str, Bounds] = {
            **self._hidden.bounds,
            **{uri: mesh.bounds_m for uri, mesh in shown if mesh is not None},
        }
        texts = {file: self._text(file) for file in document.files_read}
        return CheckedRobot(model.robot, parts.get, bounds.get, texts.get)

    def _text(self, file: str) -> bytes | None:
        try:
            return self._document.sources.text(file)
        except PackageError:
            return None

    def _hidden_uris(self) -> frozenset[str]:
        """Meshes of collisions that the scene has not loaded."""
        model = self._document.model
        return frozenset(
            one.geometry.uri
            for link in model.robot.links.values()
            for one in link.collisions
            if isinstance(one.geometry, Mesh) and model.scene.mesh(one.geometry.uri) is None
        )

    def _of_hidden_meshes(self) -> dict[str, Problem]:
        users = self._document.model.mesh_users()
        return {
            uri: replace(problem, place=part.place, parts=(part.key,))
            if (part := users.get(uri))
            else problem
            for uri, problem in self._hidden.problems.items()
        }
