"""What saving would write, and copies of what cannot be saved where it lies."""

from __future__ import annotations

import asyncio
from pathlib import Path
from typing import TYPE_CHECKING

from studio.description.editing.line_diff import file_diff
from studio.description.editing.saving import hindrance, write_copy
from studio.description.editing.undo import Change
from studio.errors import CommandError, NotSavedError
from studio.files import sweep
from studio.protocol.saving import Changes, FileChanges
from studio.protocol.texts import hunk_views

if TYPE_CHECKING:
    from studio.documents.document import Document
    from studio.protocol.saving import GetChanges, ResolveCollisions, SaveCopy


class SaveDesk:
    """Answers what is unsaved; `Document.save` writes it."""

    def __init__(self, document: Document) -> None:
        self._document = document

    async def changes(self, command: GetChanges) -> Changes:
        """Every file with unsaved edits, and how they read."""
        sources, served = self._document.sources, self._document.location.served
        texts = [(file, sources.saved(file), sources.text(file)) for file in sources.unsaved_files]

        def compared() -> tuple[FileChanges, ...]:
            found = (
                (file, file_diff(saved, now), hindrance(file, saved, served.resolve, self._may))
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
        """Remove what a killed studio left beside the files, once it is known which these are."""
        document = self._document
        await document.opened()
        served = document.location.served
        files = (document.path, *document.sources.files)

        def sweep_folders() -> None:
            sweep({Path(one).parent for one in files if served.may_write(one)})

        await asyncio.to_thread(sweep_folders)

    async def resolve(self, command: ResolveCollisions) -> None:
        """Choose whose text stands where edits collide with a change on disk.

        Raises:
            EditError: They do not collide, or elsewhere than where it was looked.
        """
        edits = self._document.disk.resolve(command)
        self._document.board.book.doubt_all()
        await self._document.follow(Change("", edits))

    async def reload(self) -> None:
        """Take the disk's text of every file; undo brings unsaved edits back."""
        sources, board = self._document.sources, self._document.board
        edits = [edit for file in sources.files if (edit := sources.reload(file))]
        board.find("disk", ())
        board.book.doubt_all()
        await self._document.follow(Change("", tuple(edits)))

    def save_copy(self, command: SaveCopy) -> None:
        """Write a file's text as it is edited to a path that is free.

        Raises:
            CommandError: The path is no whole path, or the file is none of this document.
            PackageError: It leads out of the opened folders.
            NotSavedError: It may not or cannot be written.
        """
        served, sources = self._document.location.served, self._document.sources
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
        write_copy(target, sources.text(file))

    def _may(self, path: Path) -> bool:
        return self._document.location.served.may_write(path)
