"""RobotReader: descriptions of other robots, worked out by a worker as a document's own is."""

from __future__ import annotations

import asyncio
import os
from dataclasses import replace
from typing import TYPE_CHECKING, Final

from studio.description.values import ReadPolicy
from studio.documents.edit_loop import Target
from studio.documents.states.recipes import Recipe
from studio.documents.states.second_robot import SecondRobots

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from studio.description.client import DescriptionWorker
    from studio.documents.states.second_robot import SecondRobot

_NAME: Final = "robot_description"


class RobotReader:
    """Reads one after the other; a text that came on the wire reads no file at all.

    Args:
        take_worker: Gives a worker; asked for at the first description.
        nowhere: A folder where nothing is: texts stand there, and look for all else in vain.
    """

    def __init__(self, take_worker: Callable[[], DescriptionWorker], nowhere: Path) -> None:
        self._nowhere = nowhere.resolve()
        self._target = Target("", ReadPolicy((), {}, {}))
        self._robots = SecondRobots(take_worker, lambda: self._target)
        self._turn = asyncio.Lock()

    async def read_text(self, text: str) -> SecondRobot:
        """The robot that a text describes; what is wrong with it is in the answer."""
        entry = str(self._nowhere / _NAME)
        target = Target(entry, ReadPolicy((str(self._nowhere),), {}, {}))
        second = await self._read(target, {entry: text.encode("utf-8", "replace")})
        return replace(second, fault=second.fault.replace(f"{self._nowhere}{os.sep}", ""))

    async def read_file(self, target: Target) -> SecondRobot:
        """The robot of a file, read under the rules of its target."""
        return await self._read(target, {})

    async def close(self) -> None:
        """End the worker."""
        await self._robots.close()

    async def _read(self, target: Target, texts: dict[str, bytes]) -> SecondRobot:
        async with self._turn:
            self._target = target
            return await self._robots.made(Recipe({}), texts)
