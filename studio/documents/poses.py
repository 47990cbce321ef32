"""Named poses of a document: those found around it and those kept beside it, listed and applied."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Final, Literal, TypeAlias

from studio.debounce import Throttle
from studio.description.poses import POSE_LIMIT, NamedPose, read_poses, rounded, write_poses
from studio.documents.file_watch import FileWatch
from studio.documents.side_file import ItemKind, NamedItems
from studio.errors import CommandError
from studio.packages.pose_files import may_name_poses
from studio.protocol.commands import Commands, Scope
from studio.protocol.listeners import LastSent
from studio.protocol.robot import ApplyPose, DeletePose, Poses, PoseView, RenamePose, SavePose

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from studio.documents.model import Model
    from studio.documents.motion import Motion
    from studio.documents.pose_search import PoseSearch
    from studio.documents.workspace import Workspace
    from studio.protocol.listeners import Audience
    from studio.robot.kinematics import Kinematics


_PAUSE_S: Final = 0.2
"""Between two searches during edits."""
_NAMES_SHOWN: Final = 12
_SLACK: Final = 1e-6
"""rad or m by which a limit may be exceeded without a warning: files round."""
_SHELF: Final = ItemKind("pose", read_poses, write_poses)

_Kind: TypeAlias = Literal["own", "srdf", "initial"]


class NamedPoses:
    """Knows all poses that fit the robot, and carries out what is asked of them."""

    def __init__(
        self,
        workspace: Workspace,
        model: Model,
        motion: Motion,
        search: PoseSearch,
        audience: Audience,
    ) -> None:
        self._workspace, self._model, self._motion = workspace, model, motion
        self._search, self._audience = search, audience
        self._shelf = NamedItems(workspace.entry, workspace.served, _SHELF)
        self._sent = LastSent[Poses](audience)
        self._watch = FileWatch(self._changed_on_disk, may_name_poses)
        self._watch.watch({str(self._shelf.path)})
        self._throttle = Throttle(self._refresh, pause_s=_PAUSE_S)

    def events(self) -> Iterable[Poses]:
        """Yield the events for a new page."""
        yield self._list()

    def trigger(self) -> None:
        """Search soon, and not too often, while anybody listens: the robot may be another one."""
        if len(self._audience):
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
        positions = _known(pose, frozenset(self._model.kinematics.free))
        if not positions:
            raise CommandError(f'This robot has no joint that "{pose.name}" moves.')
        self._motion.glide(positions, command.duration_s)

    def save(self, command: SavePose) -> None:
        """Keep where the joints are.

        Raises:
            CommandError: The name is empty, too long or taken, or nothing moves.
            PosesFileError: The file as it is cannot be read.
            NotSavedError: It cannot be written.
        """
        model = self._model
        now = model.joints.by_name()
        positions = {name: rounded(now[name]) for name in model.kinematics.free}
        if not positions:
            title = self._workspace.title
            raise CommandError(f"{title} has no joint that moves: there is no pose to keep.")
        self._shelf.refresh()
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
        self._send()

    async def _changed_on_disk(self, files: set[str]) -> None:
        if files - {str(self._shelf.path)}:
            self._search.invalidate()
        self._shelf.refresh()
        self.trigger()

    async def _refresh(self) -> None:
        if await self._search.search():
            found = self._search.found
            self._watch.watch({str(self._shelf.path), *found.files}, found.folders)
            self._shelf.refresh()
        self._send()

    def _fitting(self) -> Iterator[tuple[_Kind, NamedPose]]:
        """Yield the user's own poses, and of those found in files the ones for this robot."""
        for pose in self._shelf.items:
            yield "own", pose
        movable = frozenset(self._model.kinematics.movable)
        for pose in self._search.found.group_states:
            if _means(pose, movable):
                yield "srdf", pose
        for pose in self._search.found.initial:
            if _means(pose, movable):
                yield "initial", pose

    def _keyed(self) -> Iterator[tuple[str, NamedPose]]:
        return ((_key(kind, pose), pose) for kind, pose in self._fitting())

    def _list(self) -> Poses:
        views, shelf = _Views(self._model.kinematics), self._shelf
        return Poses(
            poses=tuple(views.view(kind, pose) for kind, pose in self._fitting()),
            path=str(shelf.path),
            only_here=shelf.only_here,
            trouble=shelf.trouble,
        )

    def _send(self) -> None:
        self._sent.send(self._list())


COMMANDS: Final = Commands[NamedPoses](Scope.DOCUMENT)
COMMANDS.controller(ApplyPose, lambda poses, c, _: poses.apply(c))
COMMANDS.controller(SavePose, lambda poses, c, _: poses.save(c))
COMMANDS.controller(RenamePose, lambda poses, c, _: poses.rename(c))
COMMANDS.controller(DeletePose, lambda poses, c, _: poses.delete(c))


def _key(kind: _Kind, pose: NamedPose) -> str:
    return f"own:{pose.name}" if kind == "own" else f"{kind}:{pose.file}:{pose.group}:{pose.name}"


def _means(pose: NamedPose, movable: frozenset[str]) -> bool:
    """Whether a pose is one of this robot: it has at least half of the joints."""
    known = sum(name in movable for name in pose.positions)
    return known > 0 and 2 * known >= len(pose.positions)


def _known(pose: NamedPose, free: frozenset[str]) -> dict[str, float]:
    return {name: value for name, value in pose.positions.items() if name in free}


class _Views:
    """Makes the views of the poses of one robot."""

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
