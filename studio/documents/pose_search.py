"""Poses that the files around a robot name: group states of SRDFs, and initial positions."""

from __future__ import annotations

import asyncio
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from studio.description.poses import (
    INITIAL_POSITIONS_LIMIT_BYTES,
    NamedPose,
    group_states,
    initial_positions,
)
from studio.description.values import Expansion, OpenRequest
from studio.errors import PackageError
from studio.packages.pose_files import pose_files

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable
    from pathlib import Path

    from studio.description.client import DescriptionWorker
    from studio.description.values import ReadPolicy
    from studio.documents.model import Model
    from studio.documents.runs import LastRun
    from studio.documents.sites import SiteTable
    from studio.documents.workspace import Workspace
    from studio.packages.roots import ServedRoots
    from studio.packages.workspace import Location


_POSE_LIMIT: Final = 300
_WORTH: Final = (b"group_state", b"include")
"""An SRDF without either states no pose, and is not run."""


@dataclass(frozen=True, slots=True)
class FoundPoses:
    """The poses found, and the files that were read for them."""

    group_states: tuple[NamedPose, ...] = ()
    initial: tuple[NamedPose, ...] = ()
    files: frozenset[str] = frozenset()
    folders: frozenset[str] = frozenset()
    """Folders in which more could be found."""


async def read_poses_around(
    location: Location,
    policy: ReadPolicy,
    arguments: dict[str, str],
    robot_name: str,
    take_worker: Callable[[], DescriptionWorker],
) -> FoundPoses:
    """Search for poses around the entry of a location.

    Args:
        location: Of the robot; it has an entry.
        policy: What its files may read.
        arguments: Of the robot, for the SRDFs, which name joints by the same prefixes.
        robot_name: An SRDF names the robot that it is of. Where one is of this robot, others are
            left out; else all may be.
        take_worker: Gives an xacro worker; asked for only when there is an SRDF to run.
    """
    assert location.entry is not None
    files = await asyncio.to_thread(pose_files, location.entry, location.index, location.served)
    initial = await asyncio.to_thread(_initial, files.initial, location.served)
    worth = [path for path in files.srdf if await asyncio.to_thread(_is_worth, path, location)]
    runs = await _expanded(worth, policy, arguments, take_worker) if worth else []
    named = [run for run in runs if run.robot_name == robot_name]
    states = [pose for run in named or runs for pose in group_states(run)]
    read = {str(path) for path in (*files.srdf, *files.initial)}
    read |= {file for run in runs for file in run.files}
    return FoundPoses(
        tuple(_once(states))[:_POSE_LIMIT],
        tuple(_once(initial))[:_POSE_LIMIT],
        frozenset(read),
        frozenset(map(str, files.folders)),
    )


async def _expanded(
    paths: Iterable[Path],
    policy: ReadPolicy,
    arguments: dict[str, str],
    take_worker: Callable[[], DescriptionWorker],
) -> list[Expansion]:
    """Run each; one that fails names no pose."""
    worker, runs = take_worker(), list[Expansion]()
    try:
        for path in paths:
            answer = await worker.open(OpenRequest(str(path), arguments, policy, {}))
            if isinstance(answer, Expansion):
                runs.append(answer)
    finally:
        await worker.close()
    return runs


def _is_worth(path: Path, location: Location) -> bool:
    try:
        data = location.served.read(path)
    except PackageError:
        return False
    return any(mark in data for mark in _WORTH)


def _initial(paths: Iterable[Path], served: ServedRoots) -> list[NamedPose]:
    found: list[NamedPose] = []
    for path in paths:
        try:
            data = served.read(path, INITIAL_POSITIONS_LIMIT_BYTES)
        except PackageError:
            continue
        if pose := initial_positions(str(path), data):
            found.append(pose)
    return found


def _once(poses: Iterable[NamedPose]) -> Iterable[NamedPose]:
    """Yield a pose that several copies of a file name, once."""
    seen: set[tuple[str, str, tuple[tuple[str, float], ...]]] = set()
    for pose in poses:
        key = (pose.name, pose.group, tuple(sorted(pose.positions.items())))
        if key not in seen:
            seen.add(key)
            yield pose


class PoseSearch:
    """Finds the poses around the robot of a document, again only when that could make a difference.

    Attributes:
        found: What was found last.

    Args:
        workspace: Where the files lie, and which arguments are passed.
        last_run: Nothing is searched before there is a robot.
        sites: What the arguments came to.
        model: The robot.
        take_worker: Gives an xacro worker.
    """

    def __init__(
        self,
        workspace: Workspace,
        last_run: LastRun,
        sites: SiteTable,
        model: Model,
        take_worker: Callable[[], DescriptionWorker],
    ) -> None:
        self._workspace, self._last_run, self._sites = workspace, last_run, sites
        self._model, self._take_worker = model, take_worker
        self.found = FoundPoses()
        self._made_from: object = None
        """Arguments, packages and robot that they were found with; None: search again."""

    def invalidate(self) -> None:
        """Read the files again at the next search: one of them changed."""
        self._made_from = None

    async def search(self) -> bool:
        """Read the files around the robot; whether that was done."""
        if self._last_run.expansion is None:
            return False
        # Also those without a value: an SRDF needs the same prefixes, and has no defaults.
        location, passed = self._workspace.location, self._workspace.sources.arguments
        arguments, name = self._sites.argument_values() | passed, self._model.robot.name
        made_from = (arguments, id(location.index), name)
        if made_from == self._made_from:
            return False
        self._made_from = made_from
        policy = self._workspace.policy
        self.found = await read_poses_around(location, policy, arguments, name, self._take_worker)
        return True
