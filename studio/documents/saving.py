"""The files of a document on disk: saved, copied, reloaded, merged with what others write."""

from __future__ import annotations

import asyncio
import hashlib
from pathlib import Path
from typing import TYPE_CHECKING, Final

from studio.description.editing.line_diff import file_diff
from studio.description.editing.saving import hindrance, write_copy
from studio.description.editing.sources import FileChange
from studio.description.editing.undo import Change
from studio.errors import CommandError, EditError, NotSavedError
from studio.files import sweep
from studio.problems import Fix, Place, Problem, Severity
from studio.protocol.saving import Changes, Collisions, CollisionView, DiskMerged, FileChanges
from studio.protocol.texts import hunk_views

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from studio.description.editing.merging import Merge
    from studio.description.editing.merging import Place as MergePlace
    from studio.description.editing.sources import DiskNews
    from studio.description.values import Edit
    from studio.documents.document import Document
    from studio.protocol.saving import GetChanges, GetCollisions, ResolveCollisions, SaveCopy


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


def changed_on_disk(file: str) -> Problem:
    """Somebody else wrote a file in the very places that have unsaved edits here."""
    sentence = (
        "This file was changed on disk where it has unsaved edits: "
        "choose whose text stands (undo brings the other back)."
    )
    fix = Fix("Compare and choose", "resolve_collisions", file)
    return Problem(Severity.WARNING, "changed-on-disk", sentence, Place(file), fix=fix)


def file_gone(file: str) -> Problem:
    """A file was deleted, or can no longer be read."""
    sentence = "This file can no longer be read from disk; its last text is kept here."
    return Problem(Severity.WARNING, "file-gone", sentence, Place(file))


def not_watched(reason: str) -> Problem:
    """The system has no watch left, or no file handle for one."""
    sentence = (
        f"The system does not watch the files of this robot ({reason.rstrip('. ')}), so what other "
        "programs write is seen only every two seconds: close programs that watch many files, or "
        "raise fs.inotify.max_user_instances."
    )
    return Problem(Severity.WARNING, "not-watched", sentence)


def save_cut(written: Sequence[str], missed: Sequence[str]) -> Problem:
    """The studio was ended in the middle of a save: some files are new, others are not."""
    sentence = (
        f"The studio was ended while it saved: {_names(written)} was written, {_names(missed)} was "
        "not, so the files may not fit each other. The edits are here: save them again."
    )
    return Problem(Severity.WARNING, "save-cut-off", sentence, Place(missed[0]))


def _names(files: Sequence[str]) -> str:
    return ", ".join(Path(one).name for one in files)


_SHOWN: Final = 50
"""Collisions of one file that are shown; of more than that nobody reads every one."""
_SHOWN_BYTES: Final = 4000


class DiskDesk:
    """Looks at changed files, tells what came of it, and answers where both sides collide."""

    def __init__(self, document: Document) -> None:
        self._document = document
        self._sources, self._board = document.sources, document.board
        self._gone: set[str] = set()

    def look(self, files: Iterable[str]) -> tuple[Edit, ...]:
        """Take over what changed on disk where it can be; the edits that did it, in order."""
        found = {file: self._sources.refresh(file) for file in files}
        self._gone -= found.keys()
        self._gone |= {file for file, news in found.items() if news.what is FileChange.GONE}
        self._tell(found)
        return tuple(edit for news in found.values() for edit in news.edits)

    def resolve(self, command: ResolveCollisions) -> tuple[Edit, ...]:
        """Let one side win where both collide; the edits that did it, in order.

        Raises:
            EditError: They do not collide, or elsewhere than where it was looked.
        """
        file = self._name(command.file)
        if command.state and command.state != _state(self._sources.collisions(file)):
            raise EditError(f"{command.file} was changed meanwhile: compare it again.")
        edits = self._sources.resolve(file, command.keep, command.each)
        self.tell_problems()
        return edits

    def answer(self, command: GetCollisions) -> Collisions:
        """Where a file's unsaved edits collide with what changed on disk.

        Raises:
            EditError: They do not.
        """
        file = self._name(command.file)
        merged = self._sources.collisions(file)
        views = tuple(_view(merged, place) for place in merged.collisions[:_SHOWN])
        count = len(merged.collisions)
        return Collisions(
            request=command.request, file=file, places=views, count=count, state=_state(merged)
        )

    def tell_problems(self) -> None:
        """Tell which files are gone, and which wait for a choice."""
        gone = [file_gone(file) for file in sorted(self._gone)]
        waiting = [changed_on_disk(file) for file in sorted(self._sources.conflicts)]
        self._board.find("disk", (*gone, *waiting))

    def tell_watch(self, trouble: str) -> None:
        """Say that the system does not watch the files, and why; empty: that it does."""
        self._board.find("watch", [not_watched(trouble)] if trouble else ())

    def _tell(self, found: dict[str, DiskNews]) -> None:
        self.tell_problems()
        for file, news in found.items():
            if news.what is FileChange.MERGED:
                self._board.audience.tell(DiskMerged(file=file, kept=news.kept))

    def _name(self, file: str) -> str:
        return str(self._document.location.served.resolve(file))


def _state(merged: Merge) -> str:
    """Other collisions, another name."""
    return hashlib.sha256(repr(merged.collisions).encode()).hexdigest()[:20]


def _view(merged: Merge, place: MergePlace) -> CollisionView:
    """A collision in whole lines, so that one sees what stands around it."""
    base = merged.base
    start = base.rfind(b"\n", 0, place.start) + 1
    end = base.find(b"\n", place.end)
    before = base[start : place.start]
    after = base[place.end : len(base) if end < 0 else end]
    return CollisionView(
        line=base.count(b"\n", 0, start) + 1,
        base=_text(before + base[place.start : place.end] + after),
        mine=_text(before + place.mine + after),
        theirs=_text(before + place.theirs + after),
    )


def _text(data: bytes) -> str:
    shown = data[:_SHOWN_BYTES].decode("utf-8", "replace").replace("\r", "")
    return shown if len(data) <= _SHOWN_BYTES else f"{shown} …"
