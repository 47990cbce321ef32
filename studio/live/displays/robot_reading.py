"""RobotReader: descriptions of other robots, worked out by a worker as a document's own is."""

from __future__ import annotations

import asyncio
import os
from typing import TYPE_CHECKING, Final, NamedTuple, Protocol

from studio.description.values import Expansion, OpenRequest, ReadPolicy
from studio.files import Stamp, stamp_of
from studio.robot.assembly import assembled
from studio.robot.values import Robot

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping
    from pathlib import Path

    from studio.description.client import DescriptionWorker

_NAME: Final = "robot_description"


class RobotFiles(Protocol):
    """Finds the files of robots."""

    @property
    def policy(self) -> ReadPolicy:
        """The files that a description may read."""
        ...

    def resolve_uri(self, uri: str) -> Path:
        """Return the file of a URI; reads the disk, thread-safe.

        Raises:
            PackageError: It names no file that may be read.
        """
        ...


class DescribedRobot(NamedTuple):
    """A robot, and what is wrong with its description; one that cannot be read has no links.

    `stamps` is of all files that were read, as they were when their reading began.
    """

    robot: Robot
    fault: str
    stamps: Mapping[str, Stamp | None] = {}


def stamps_of(paths: Iterable[str]) -> dict[str, Stamp | None]:
    """Return by which signs a change of files is noticed; None: it is not there."""
    return {path: stamp_of(path) for path in paths}


class RobotReader:
    """Reads descriptions, one at a time; a text received from ROS may read no file.

    Args:
        take_worker: Returns a worker; called for the first description.
        files: Finds descriptions in files, and says what they may read.
        nowhere: An empty folder, the base of texts, so that relative paths find nothing.
    """

    def __init__(
        self, take_worker: Callable[[], DescriptionWorker], files: RobotFiles, nowhere: Path
    ) -> None:
        self._take_worker, self._files, self._nowhere = take_worker, files, nowhere.resolve()
        self._worker: DescriptionWorker | None = None
        self._turn = asyncio.Lock()

    async def read_text(self, text: str) -> DescribedRobot:
        """Return the robot that a text describes; what is wrong with it is in the answer."""
        entry = str(self._nowhere / _NAME)
        policy = ReadPolicy((str(self._nowhere),), {}, {})
        texts = {entry: text.encode("utf-8", "replace")}
        robot, fault, _ = await self._read(OpenRequest(entry, {}, policy, texts))
        return DescribedRobot(robot, fault.replace(f"{self._nowhere}{os.sep}", ""))

    async def read_file(self, uri: str) -> DescribedRobot:
        """Return the robot of a file; what is wrong with its text is in the answer.

        Raises:
            PackageError: The URI names no file that may be read.
        """
        path = await asyncio.to_thread(self._files.resolve_uri, uri)
        entry = await asyncio.to_thread(stamps_of, (str(path),))
        robot, fault, files = await self._read(OpenRequest(str(path), {}, self._files.policy, {}))
        return DescribedRobot(robot, fault, await asyncio.to_thread(stamps_of, files) | entry)

    async def close(self) -> None:
        """End the worker."""
        worker, self._worker = self._worker, None
        if worker is not None:
            await worker.close()

    async def _read(self, request: OpenRequest) -> tuple[Robot, str, tuple[str, ...]]:
        """Return the robot, what is wrong with it, and the files that were read."""
        async with self._turn:
            if self._worker is None:
                self._worker = self._take_worker()
            answer = await self._worker.open(request)
            if isinstance(answer, Expansion):
                return *await asyncio.to_thread(assembled, answer), answer.files
            return Robot(""), str(answer.problem), answer.files
