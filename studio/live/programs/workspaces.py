"""The packages of the opened folders, read again when their files change, and what is added."""

from __future__ import annotations

import asyncio
import os
from pathlib import Path
from typing import TYPE_CHECKING, Final

from studio.debounce import Throttle
from studio.errors import CommandError, NotRunnableError
from studio.live.programs.package_edits import PackageEdits
from studio.live.programs.watching import FolderWatch
from studio.packages.edits.package_edit import PackageEdit
from studio.packages.roots import is_below
from studio.packages.workspace import open_location
from studio.protocol.commands import Commands, Scope
from studio.protocol.workspaces import (
    AddToPackage,
    CreatePackage,
    GetWorkspaces,
    MendPackage,
    PackageEdited,
    UndoPackageEdit,
    Workspaces,
    WorkspaceView,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from studio.live.programs.inspecting import Inspected
    from studio.packages.index import PackageIndex
    from studio.packages.run_folders import RunFolders
    from studio.settings import Settings

_PAUSE_S: Final = 0.5
"""Between two readings of all packages."""
_SOURCE: Final = "src"


class WorkspaceRoom:
    """Knows what the folders hold; used on the event loop, reading is done in threads.

    Args:
        settings: Where other packages are.
        allowed: Decides what may be changed.
        opened: The folders that are open besides the allowed ones.
        changed: Called when it was read again.
        saved: Called with files that were written.
    """

    def __init__(
        self,
        settings: Settings,
        allowed: RunFolders,
        opened: Callable[[], Iterable[Path]],
        changed: Callable[[], object],
        saved: Callable[[set[Path]], object],
    ) -> None:
        self._settings, self._allowed = settings, allowed
        self._opened, self._changed, self._saved = opened, changed, saved
        self._edits = PackageEdits()
        self._read: dict[Path, Inspected] = {}
        self._indexes: dict[Path, PackageIndex] = {}
        self._reading = Throttle(self._read_all, pause_s=_PAUSE_S)
        self._is_read = False
        self._watch = FolderWatch(self._files_changed)

    @property
    def roots(self) -> tuple[Path, ...]:
        """The folders whose packages are looked at: none lies in another one."""
        data = Path(os.path.realpath(self._settings.data_folder))
        opened = [one for one in self._opened() if not is_below(one, data) and one.is_dir()]
        wanted = dict.fromkeys((*self._allowed.folders, *opened))
        return tuple(
            one for one in wanted if not any(one != two and is_below(one, two) for two in wanted)
        )

    def follow(self) -> None:
        """Watch the folders from now on."""
        self._watch.watch(self.roots)

    def workspaces(self, command: GetWorkspaces) -> Workspaces:
        """Return what the folders hold, as far as it was read."""
        roots = self.roots
        missing = [one for one in roots if one not in self._read]
        self.follow()
        if missing or not self._is_read:
            self._reading.trigger()
        views = (self._view(self._read[one]) for one in roots if one in self._read)
        return Workspaces(
            request=command.request,
            run_folders=tuple(map(str, self._allowed.folders)),
            workspaces=tuple(views),
            is_reading=bool(missing),
        )

    def folders_now(self) -> tuple[Inspected, ...]:
        """Return what the folders hold, as far as it was read; they are read from now on."""
        roots = self.roots
        self.follow()
        if not self._is_read or any(one not in self._read for one in roots):
            self._reading.trigger()
        return tuple(self._read[one] for one in roots if one in self._read)

    async def index_at(self, folder: Path) -> PackageIndex:
        """Return the packages that files of a folder see."""
        if folder not in self._indexes:
            settings = self._settings
            location = await asyncio.to_thread(
                open_location,
                folder,
                settings.package_paths,
                settings.data_folder,
                dict(os.environ),
            )
            self._indexes[folder] = location.index.without(self._allowed.is_received)
            self.follow()
        return self._indexes[folder]

    async def create(self, command: CreatePackage) -> PackageEdited:
        """Make a package.

        Raises:
            NotRunnableError: Its folder is none of `--allow-run`.
            NotMadeError: Something forbids it.
        """
        folder = self._allowed.resolve(command.folder)
        source = folder / _SOURCE
        if source.is_dir() and not (folder / "package.xml").is_file():
            folder = source
        edit = await asyncio.to_thread(_edit_of, folder, command)
        return await self.make(folder, edit, command.request)

    async def add(self, command: AddToPackage) -> PackageEdited:
        """Add a message, service, action, node or launch file to a package.

        Raises:
            NotRunnableError: The package lies in no folder of `--allow-run`.
            NotMadeError: Something forbids it.
        """
        folder = self._allowed.resolve(command.package)
        edit = await asyncio.to_thread(_edit_of, folder, command)
        return await self.make(folder, edit, command.request)

    async def mend(self, command: MendPackage) -> PackageEdited:
        """Make the edit of a finding's fix.

        Raises:
            CommandError: It is no longer found, or no edit mends it.
            NotRunnableError: A file lies in no folder of `--allow-run`.
        """
        for inspected in self._read.values():
            for one in inspected.problems:
                fix = one.fix
                is_meant = (one.code, one.sentence) == (command.code, command.sentence)
                if is_meant and fix is not None and fix.label == command.label:
                    edit = PackageEdit(fix.label, "", fix.new_files, fix.edits)
                    for file in {new.file for new in fix.edits}:
                        self._allowed.resolve(file)
                    return await self.make(inspected.workspace.root, edit, command.request)
        raise CommandError("This is no longer found: look at the list again.")

    async def make(self, folder: Path, edit: PackageEdit, request: int = 0) -> PackageEdited:
        """Write an edit of a package; errors as `add`."""
        self._allowed.resolve(folder)
        number, files = await asyncio.to_thread(self._edits.write, folder, edit)
        self._indexes.clear()
        self._reading.trigger()
        return PackageEdited(
            request=request,
            edit=number,
            label=edit.label,
            opened=edit.opened,
            files=tuple(map(str, files)),
            by_hand=edit.by_hand,
        )

    async def undo(self, command: UndoPackageEdit) -> None:
        """Take an edit back.

        Raises:
            CommandError: It is not known any more, or a file was changed since.
        """
        if not self._allowed.is_on:
            raise NotRunnableError("A package", "start the studio with --allow-run FOLDER")
        await asyncio.to_thread(self._edits.undo, command.edit)
        self._reading.trigger()

    async def close(self) -> None:
        """Watch and read nothing any more."""
        await asyncio.gather(self._watch.close(), self._reading.close())

    def _files_changed(self, files: set[Path]) -> None:
        self._indexes.clear()
        self._saved(files)
        if self._is_read:
            self._reading.trigger()

    async def _read_all(self) -> None:
        roots = self.roots
        read = {one: await asyncio.to_thread(_inspected, one) for one in roots}
        is_other = read != self._read
        self._read, self._is_read = read, True
        if is_other:
            self._changed()

    def _view(self, inspected: Inspected) -> WorkspaceView:
        view = WorkspaceView.model_validate(inspected.workspace, from_attributes=True)
        packages = (
            one.model_copy(update={"may_run": self._allowed.allows(one.folder)})
            for one in view.packages
        )
        return view.model_copy(update={"packages": tuple(packages), "problems": inspected.problems})


def _inspected(root: Path) -> Inspected:
    from studio.live.programs.inspecting import inspect  # noqa: PLC0415 - takes its time

    return inspect(root)


def _edit_of(folder: Path, command: CreatePackage | AddToPackage) -> PackageEdit:
    """Return the edit that makes a package in a folder, or adds something to that of a folder."""
    from studio.live.programs.making import (  # noqa: PLC0415 - takes its time
        edit_of_addition,
        edit_of_new,
    )

    if isinstance(command, CreatePackage):
        return edit_of_new(folder, command)
    return edit_of_addition(folder, command)


COMMANDS: Final = Commands[WorkspaceRoom](Scope.STUDIO)
COMMANDS.presenter(GetWorkspaces, lambda one, c, _: one.workspaces(c))
COMMANDS.presenter(CreatePackage, lambda one, c, _: one.create(c))
COMMANDS.presenter(AddToPackage, lambda one, c, _: one.add(c))
COMMANDS.presenter(MendPackage, lambda one, c, _: one.mend(c))
COMMANDS.presenter(UndoPackageEdit, lambda one, c, _: one.undo(c))
