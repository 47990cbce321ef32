"""Named poses of a document: found in files around it, kept beside it, and applied."""

from __future__ import annotations

import asyncio
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final, Literal, TypeAlias

from studio.debounce import Throttle
from studio.description.poses import (
    INITIAL_POSITIONS_LIMIT_BYTES,
    POSE_LIMIT,
    NamedPose,
    group_states,
    initial_positions,
    read_poses,
    rounded,
    write_poses,
)
from studio.description.values import Expansion, OpenRequest
from studio.documents.file_watch import FileWatch
from studio.documents.side_file import ItemKind, NamedItems
from studio.documents.variants.second_robot import argument_values
from studio.errors import CommandError, PackageError
from studio.packages.pose_files import may_name_poses, pose_files
from studio.protocol.listeners import LastTold
from studio.protocol.robot import Poses, PoseView

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sequence
    from pathlib import Path

    from studio.description.client import DescriptionWorker
    from studio.documents.document import Document
    from studio.documents.runs import Target
    from studio.documents.services import Services
    from studio.packages.roots import ServedRoots
    from studio.packages.workspace import Location
    from studio.protocol.robot import ApplyPose, DeletePose, RenamePose, SavePose
    from studio.robot.kinematics import Kinematics


_POSE_LIMIT: Final = 300
_WORTH: Final = (b"group_state", b"include")
"""An SRDF without either states no pose, and is not run."""


@dataclass(frozen=True, slots=True)
class FoundPoses:
    """What was found, and the files that were read for it."""

    group_states: tuple[NamedPose, ...] = ()
    initial: tuple[NamedPose, ...] = ()
    files: frozenset[str] = frozenset()
    folders: frozenset[str] = frozenset()
    """Where others would be found."""


async def read_poses_around(
    location: Location,
    target: Target,
    arguments: dict[str, str],
    robot_name: str,
    take_worker: Callable[[], DescriptionWorker],
) -> FoundPoses:
    """Look for poses around the entry of a location.

    Args:
        location: Of the robot; it has an entry.
        target: What its files may read.
        arguments: Of the robot, for the SRDFs, which name joints by the same prefixes.
        robot_name: An SRDF names the robot that it is of. Where one is of this robot, others are
            left out; else all may be.
        take_worker: Gives an xacro worker; asked for only when there is an SRDF to run.
    """
    assert location.entry is not None
    files = await asyncio.to_thread(pose_files, location.entry, location.index, location.served)
    initial = await asyncio.to_thread(_initial, files.initial, location.served)
    worth = [path for path in files.srdf if await asyncio.to_thread(_is_worth, path, location)]
    runs = await _expanded(worth, target, arguments, take_worker) if worth else []
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
    target: Target,
    arguments: dict[str, str],
    take_worker: Callable[[], DescriptionWorker],
) -> list[Expansion]:
    """Run each; one that fails names no pose."""
    worker, runs = take_worker(), list[Expansion]()
    try:
        for path in paths:
            answer = await worker.open(OpenRequest(str(path), arguments, target.policy, {}))
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
    return any(word in data for word in _WORTH)


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
    """A pose that several copies of a file name, once."""
    seen: set[tuple[str, str, tuple[tuple[str, float], ...]]] = set()
    for pose in poses:
        key = (pose.name, pose.group, tuple(sorted(pose.positions.items())))
        if key not in seen:
            seen.add(key)
            yield pose


_PAUSE_S: Final = 0.2
"""Between two looks while somebody edits."""
_NAMES_SHOWN: Final = 12
_SLACK: Final = 1e-6
"""rad or m by which a limit may be passed without a word: files round."""
_SHELF: Final = ItemKind("pose", read_poses, write_poses)

_Kind: TypeAlias = Literal["own", "srdf", "initial"]


class NamedPoses:
    """Knows all poses that fit the robot, and carries out what is asked of them."""

    def __init__(self, document: Document, services: Services) -> None:
        self._document, self._services = document, services
        self._shelf = NamedItems(document.entry, document.location.served, _SHELF)
        self._found = FoundPoses()
        self._made_from: object = None
        """Arguments, packages and robot that they were looked for with; None: look anew."""
        self._told = LastTold[Poses](document.board.audience)
        self._watch = FileWatch(self._changed_on_disk, may_name_poses)
        self._watch.watch({str(self._shelf.path)})
        self._throttle = Throttle(self._look, pause_s=_PAUSE_S)

    def events(self) -> Iterable[Poses]:
        """What a newcomer is told."""
        yield self._list()

    def doubt(self) -> None:
        """The robot may be another one: look soon, and not too often, while anybody listens."""
        if len(self._document.board.audience):
            self._throttle.trigger()

    async def close(self) -> None:
        """End what runs for it."""
        await self._throttle.close()
        await self._watch.close()

    def apply(self, command: ApplyPose) -> None:
        """Move the joints to a pose, as far as their limits let them.

        Raises:
            CommandError: There is no such pose, or the robot has none of its joints.
        """
        pose = dict(self._keyed()).get(command.key)
        if pose is None:
            raise CommandError("This pose is not there any more: choose another.")
        positions = _known(pose, frozenset(self._document.model.kinematics.free))
        if not positions:
            raise CommandError(f'This robot has no joint that "{pose.name}" moves.')
        self._document.motion.glide(positions, command.duration_s)

    def save(self, command: SavePose) -> None:
        """Keep where the joints are.

        Raises:
            CommandError: The name is empty, too long or taken, or nothing moves.
            PosesFileError: The file as it is cannot be read.
            NotSavedError: It cannot be written.
        """
        model = self._document.model
        now = model.joints.by_name()
        positions = {name: rounded(now[name]) for name in model.kinematics.free}
        if not positions:
            title = self._document.title
            raise CommandError(f"{title} has no joint that moves: there is no pose to keep.")
        self._shelf.look()
        names = [pose.name for pose in self._shelf.items]
        if command.replace and command.name in names:
            made = NamedPose(command.name, positions)
            self._put(made if one.name == made.name else one for one in self._shelf.items)
            return
        made = NamedPose(self._shelf.free_name(command.name), positions)
        if len(names) >= POSE_LIMIT:
            raise CommandError(f"There are {POSE_LIMIT} poses: delete one first.")
        self._put((*self._shelf.items, made))

    def rename(self, command: RenamePose) -> None:
        """Give one's own pose another name; errors as for `save`."""
        known = self._shelf.find(command.name)
        if command.new_name.strip() == known.name:
            return
        renamed = replace(known, name=self._shelf.free_name(command.new_name))
        self._put(renamed if one is known else one for one in self._shelf.items)

    def delete(self, command: DeletePose) -> None:
        """Forget one's own pose; errors as for `save`."""
        known = self._shelf.find(command.name)
        self._put(one for one in self._shelf.items if one is not known)

    def _put(self, poses: Iterable[NamedPose]) -> None:
        self._shelf.put(tuple(poses))
        self._tell()

    async def _changed_on_disk(self, files: set[str]) -> None:
        if files - {str(self._shelf.path)}:
            self._made_from = None
        self._shelf.look()
        self.doubt()

    async def _look(self) -> None:
        await self._find()
        self._tell()

    async def _find(self) -> None:
        """Read the files around the robot, unless nothing changed that could make a difference."""
        document = self._document
        if document.expansion is None:
            return
        # Also those that nobody passed: an SRDF asks for the same prefixes, and has no defaults.
        values = argument_values(document.board.book.sites.values())
        arguments, name = values | document.sources.arguments, document.model.robot.name
        made_from = (arguments, id(document.location.index), name)
        if made_from == self._made_from:
            return
        self._made_from = made_from
        self._found = await read_poses_around(
            document.location,
            document.target,
            arguments,
            name,
            self._services.description_worker,
        )
        files, folders = {str(self._shelf.path), *self._found.files}, self._found.folders
        self._watch.watch(files, folders)
        self._shelf.look()

    def _fitting(self) -> Iterator[tuple[_Kind, NamedPose]]:
        """One's own, all of them; of those that were found the ones that mean this robot."""
        for pose in self._shelf.items:
            yield "own", pose
        movable = frozenset(self._document.model.kinematics.movable)
        for pose in self._found.group_states:
            if _means(pose, movable):
                yield "srdf", pose
        for pose in self._found.initial:
            if _means(pose, movable):
                yield "initial", pose

    def _keyed(self) -> Iterator[tuple[str, NamedPose]]:
        return ((_key(kind, pose), pose) for kind, pose in self._fitting())

    def _list(self) -> Poses:
        views, shelf = _Views(self._document.model.kinematics), self._shelf
        return Poses(
            poses=tuple(views.view(kind, pose) for kind, pose in self._fitting()),
            path=str(shelf.path),
            only_here=shelf.only_here,
            trouble=shelf.trouble,
        )

    def _tell(self) -> None:
        self._told.tell(self._list())


def _key(kind: _Kind, pose: NamedPose) -> str:
    return f"own:{pose.name}" if kind == "own" else f"{kind}:{pose.file}:{pose.group}:{pose.name}"


def _means(pose: NamedPose, movable: frozenset[str]) -> bool:
    """Whether a pose is one of this robot: it has at least half of the joints."""
    known = sum(name in movable for name in pose.positions)
    return known > 0 and 2 * known >= len(pose.positions)


def _known(pose: NamedPose, free: frozenset[str]) -> dict[str, float]:
    return {name: value for name, value in pose.positions.items() if name in free}


class _Views:
    """Makes what the page is told of poses of one robot."""

    def __init__(self, kinematics: Kinematics) -> None:
        self._kinematics = kinematics
        self._free = frozenset(kinematics.free)
        self._movable = frozenset(kinematics.movable)

    def view(self, kind: _Kind, pose: NamedPose) -> PoseView:
        known = _known(pose, self._free)
        strangers = [name for name in pose.positions if name not in self._movable]
        strangers += pose.unread
        return PoseView(
            key=_key(kind, pose),
            name=pose.name,
            group=pose.group,
            kind=kind,
            file=pose.file,
            line=pose.line,
            positions=known,
            unknown=_shown(strangers),
            unknown_count=len(strangers),
            beyond=_shown([name for name, value in known.items() if self._stops(name, value)]),
        )

    def _stops(self, joint: str, position: float) -> bool:
        """Whether its limits do not let a joint go there."""
        return abs(self._kinematics.clamp(joint, position) - position) > _SLACK


def _shown(names: Sequence[str]) -> tuple[str, ...]:
    return tuple(names[:_NAMES_SHOWN])
