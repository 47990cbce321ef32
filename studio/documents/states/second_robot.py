"""A second robot beside the one that is edited: another state of the same files, worked out."""

from __future__ import annotations

import asyncio
from dataclasses import dataclass
from typing import TYPE_CHECKING

from studio.description.values import Expansion, OpenRequest, SiteKind
from studio.robot.assembly import assembled
from studio.robot.kinematics import Kinematics
from studio.robot.values import Robot

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from studio.description.client import DescriptionWorker
    from studio.description.values import Site
    from studio.documents.document import Document
    from studio.documents.edit_loop import Target
    from studio.documents.states.recipes import Recipe


@dataclass(frozen=True, slots=True, eq=False)
class SecondRobot:
    """What a recipe came to. A recipe that cannot be run has a robot without links."""

    recipe: Recipe
    robot: Robot
    kinematics: Kinematics
    arguments: Mapping[str, str]
    """What each argument came to, passed or not."""
    files: tuple[str, ...] = ()
    """Every file that was read."""
    fault: str = ""
    """Why there is no robot, a sentence."""


class SecondRobots:
    """Runs recipes in a worker of its own, one after the other; the document's is not disturbed.

    Args:
        take_worker: Gives a worker; asked for at the first run.
        target: What is run, and what it may read.
    """

    def __init__(
        self, take_worker: Callable[[], DescriptionWorker], target: Callable[[], Target]
    ) -> None:
        self._take_worker, self._target = take_worker, target
        self._worker: DescriptionWorker | None = None

    async def made(self, recipe: Recipe, overlay: Mapping[str, bytes]) -> SecondRobot:
        """Run a recipe; whatever goes wrong is in the answer."""
        if self._worker is None:
            self._worker = self._take_worker()
        target = self._target()
        request = OpenRequest(target.entry, recipe.arguments, target.policy, dict(overlay))
        answer = await self._worker.open(request)
        if isinstance(answer, Expansion):
            return await asyncio.to_thread(_assembled, recipe, answer)
        robot = Robot("")
        return SecondRobot(recipe, robot, Kinematics(robot), {}, answer.files, str(answer.problem))

    async def close(self) -> None:
        """End the worker; the next run takes another."""
        worker, self._worker = self._worker, None
        if worker is not None:
            await worker.close()


def present_robot(document: Document, recipe: Recipe) -> SecondRobot:
    """The robot that is edited, as the last good run made it."""
    model = document.model
    values = argument_values(document.board.book.sites.values())
    fault = "The robot as it is now does not run: its last good state is compared."
    return SecondRobot(
        recipe,
        model.robot,
        model.kinematics,
        values,
        document.files_read,
        fault if document.failed else "",
    )


def argument_values(sites: Iterable[Site]) -> dict[str, str]:
    """What each argument came to in a run; of several declarations the first counts."""
    found: dict[str, str] = {}
    for site in sites:
        if site.kind is SiteKind.ARG:
            found.setdefault(site.name, site.value or site.text)
    return found


def _assembled(recipe: Recipe, expansion: Expansion) -> SecondRobot:
    robot, fault = assembled(expansion)
    values = argument_values(expansion.changed_sites)
    return SecondRobot(recipe, robot, Kinematics(robot), values, expansion.files, fault)
