"""The files of a document as it saves them: what would be written, all or some, and copies."""

from __future__ import annotations

import asyncio
from pathlib import Path
from typing import TYPE_CHECKING, Final

from studio.description.editing.line_diff import file_diff
from studio.description.editing.saving import hindrance, write_copy
from studio.errors import CommandError, NotSavedError
from studio.files import sweep
from studio.packages.run_folders import is_program
from studio.protocol.commands import Commands, OnCopies, Scope
from studio.protocol.roles import Role
from studio.protocol.saving import Changes, FileChanges, GetChanges, Save, SaveCopy, Saved
from studio.protocol.texts import hunk_views

if TYPE_CHECKING:
    from collections.abc import Collection

    from studio.documents.disk_sync import DiskSync
    from studio.documents.drafts import Drafts
    from studio.documents.edits import Edits
    from studio.documents.workspace import Workspace
    from studio.protocol.listeners import Audience


class Saving:
    """Writes the files of a document, and answers what would be written."""

    def __init__(
        self,
        workspace: Workspace,
        disk: DiskSync,
        edits: Edits,
        drafts: Drafts,
        audience: Audience,
    ) -> None:
        self._workspace, self._sources = workspace, workspace.sources
        self._disk, self._edits, self._drafts = disk, edits, drafts
        self._audience = audience

    async def save(self, files: Collection[str] | None = None, role: Role = Role.PRESENTER) -> None:
        """Write these changed files, or all; nobody but a presenter writes programs.

        Raises:
            NotSavedError: One may not or cannot be written.
            NotAllowedError: One is named that is a program, by somebody else.
        """
        if role is not Role.PRESENTER:
            unsaved = self._sources.unsaved_files
            self._workspace.check_role(files or (), role)
            files = [one for one in files or unsaved if not is_program(one)]
        await self._disk.changed(set(self._sources.unsaved_files))
        with self._drafts.saving(files):
            written = self._sources.save(files)
        self._edits.disk_changed()
        self._audience.send(Saved(files=written))

    async def changes(self, command: GetChanges) -> Changes:
        """Return every file with unsaved edits, and how they read."""
        sources, served = self._sources, self._workspace.served
        texts = [(file, sources.saved(file), sources.text(file)) for file in sources.unsaved_files]

        def compared() -> tuple[FileChanges, ...]:
            found = (
                (
                    file,
                    file_diff(saved, now),
                    hindrance(file, saved, served.resolve, self._workspace.may_write),
                )
                for file, saved, now in texts
            )
            return tuple(
                FileChanges(
                    file=file,
                    added=diff.added,
                    removed=diff.removed,
                    hunks=hunk_views(diff),
                    left_out=diff.left_out,
                    hindrance=reason,
                )
                for file, diff, reason in found
            )

        files = await asyncio.to_thread(compared)
        folder = next((one for one in served.writable if one.is_dir()), None)
        copies = str(folder) if folder else ""
        return Changes(request=command.request, files=files, copies=copies)

    async def sweep(self) -> None:
        """Remove what a killed studio left beside the files."""
        served = self._workspace.served
        files = (self._workspace.path, *self._sources.files)

        def sweep_folders() -> None:
            sweep({Path(one).parent for one in files if served.may_write(one)})

        await asyncio.to_thread(sweep_folders)

    def save_copy(self, command: SaveCopy) -> None:
        """Write a file's text as it is edited to a path that is free.

        Raises:
            CommandError: The path is no whole path, or the file is none of this document.
            PackageError: It leads out of the opened folders.
            NotSavedError: It may not or cannot be written.
        """
        served, sources = self._workspace.served, self._sources
        if not Path(command.path).is_absolute():
            raise CommandError(f"{command.path!r} is no whole path: name it from the root on.")
        file = str(served.resolve(command.file))
        if file not in sources.files:
            raise CommandError(f"{command.file} is no file of this document: choose one of them.")
        target = served.resolve(command.path)
        if not target.parent.is_dir():
            raise NotSavedError(command.path, "there is no such folder; name one that is there")
        if not served.may_write(target):
            raise NotSavedError(command.path, "its folder may only be read; name another")
        if not self._workspace.may_program(target):
            raise NotSavedError(command.path, "that would be a program; name another")
        write_copy(target, sources.text(file))


COMMANDS: Final = Commands[Saving](Scope.DOCUMENT)
COMMANDS.controller(GetChanges, lambda saving, c, _: saving.changes(c))
COMMANDS.controller(
    Save,
    lambda saving, c, who: saving.save(c.files, who.role),
    on_copies=OnCopies.REFUSED,
    reviews=True,
)
COMMANDS.presenter(SaveCopy, lambda saving, c, _: saving.save_copy(c))
