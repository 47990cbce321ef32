"""Drafts: unsaved edits outlive the process, and are restored when the file is opened."""

from __future__ import annotations

import asyncio
from contextlib import contextmanager, suppress
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Final

from studio.documents.draft_files import Draft, draft_file
from studio.errors import DraftError, PackageError
from studio.problems import Place, Problem, Severity
from studio.protocol.commands import Commands, Scope
from studio.protocol.saving import DiscardRestored, Restored

if TYPE_CHECKING:
    from collections.abc import Collection, Generator, Iterable, Sequence

    from studio.description.editing.undo import KeptSources
    from studio.documents.disk_sync import DiskSync
    from studio.documents.draft_files import DraftFile
    from studio.documents.findings import Findings
    from studio.documents.workspace import Workspace
    from studio.protocol.listeners import Audience


_WRITE_AFTER_S: Final = 0.3
"""Between two drafts; the first edit after a pause is written at once."""
_WRITE_LARGE_AFTER_S: Final = 3.0
_LARGE_BYTES: Final = 1 << 20
_LIMIT_BYTES: Final = 64 << 20
_STEPS_KEPT: Final = 300


class Drafts:
    """Keeps the draft of one document, in the background.

    Args:
        workspace: The texts to keep.
        disk: Reads the files of a restored draft, and all of them when it is discarded.
        findings: Takes why a draft is not kept, and which save was interrupted.
        audience: Is sent what was restored.
        data_folder: The folder of the drafts.
    """

    def __init__(
        self,
        workspace: Workspace,
        disk: DiskSync,
        findings: Findings,
        audience: Audience,
        data_folder: Path,
    ) -> None:
        self._workspace, self._sources, self._disk = workspace, workspace.sources, disk
        self._findings, self._audience, self._data_folder = findings, audience, data_folder
        self._opened_with = self._sources.arguments
        self._file: DraftFile | None = None
        self._written: KeptSources | None = None
        self._restored = Restored(at="", files=())
        self._writing: asyncio.Task[None] | None = None
        self._is_noted = self._is_forgotten = False
        self._ended = asyncio.Event()

    def events(self) -> Iterable[Restored]:
        """Yield the events for a new page."""
        if self._restored.at:
            yield self._restored

    def restore(self) -> None:
        """Before the first run: take up what an earlier run of the studio left unsaved."""
        try:
            self._file = draft_file(self._data_folder, self._workspace.entry)
            draft = self._file.read()
        except DraftError as error:
            self._complain(error)
            return
        self._report_cut_save(self._file)
        if draft is not None and draft.entry == self._workspace.path:
            self._take(draft)

    def note(self) -> None:
        """Something may have changed: write it down soon, and not too often."""
        self._end_notice()
        self._write_soon()

    def _write_soon(self) -> None:
        self._is_noted = True
        if self._file is not None and (self._writing is None or self._writing.done()):
            self._writing = asyncio.create_task(self._write_while_noted())

    @contextmanager
    def saving(self, files: Collection[str] | None) -> Generator[None]:
        """Enclose writing these changed files, or all: a kill inside is reported later."""
        sources = self._sources
        chosen = [one for one in sources.unsaved_files if files is None or one in files]
        if self._file is None:
            yield
            return
        journal = self._file.journal
        if len(chosen) > 1:
            journal.begin((one, sources.saved(one), sources.text(one)) for one in chosen)
        try:
            yield
        finally:
            journal.end()
        self._findings.replace("saving", ())

    def forget(self) -> None:
        """The document is closed for good: nothing of it is to come back."""
        self._is_forgotten = True

    async def close(self) -> None:
        """Write what is not written yet, and leave the draft to the next run."""
        self._ended.set()
        self._write_soon()  # what no run has shown is kept, too
        if self._writing:
            await self._writing
        if self._file is None:
            return
        if self._is_forgotten:
            self._file.remove()
            self._file.journal.end()
        self._file.close()

    async def discard(self) -> None:
        """Discard what was restored: the files as on disk; undo takes it back."""
        self._restored = Restored(at="", files=())
        self._audience.send(self._restored)
        await self._disk.discard(self._opened_with)

    def _take(self, draft: Draft) -> None:
        served = self._workspace.served
        kept, sources = draft.kept, self._sources
        texts = tuple(one for one in kept.texts if served.serves(one.file))
        if texts != kept.texts:  # other folders are open than were then
            kept = replace(kept, texts=texts, done=(), undone=())
        if draft.opened_with != self._opened_with:  # arguments given now come first
            kept = replace(kept, arguments=self._opened_with)
        if draft.confined is not None:
            self._workspace.confine(draft.confined)
        sources.put(kept)
        self._disk.refresh([one.file for one in texts])
        if sources.unsaved_files or sources.arguments != self._opened_with:
            self._restored = Restored(at=draft.at, files=sources.unsaved_files)
            self._audience.send(self._restored)

    def _end_notice(self) -> None:
        """Remove the notice of what was restored, once it is saved or discarded."""
        if not self._restored.at:
            return
        sources = self._sources
        if not (sources.unsaved_files or sources.arguments != self._opened_with):
            self._restored = Restored(at="", files=())
            self._audience.send(self._restored)

    async def _write_while_noted(self) -> None:
        while self._is_noted:
            await self._write()
            known = self._written
            large = known is not None and known.size_bytes > _LARGE_BYTES
            with suppress(TimeoutError):
                delay_s = _WRITE_LARGE_AFTER_S if large else _WRITE_AFTER_S
                await asyncio.wait_for(self._ended.wait(), delay_s)

    async def _write(self) -> None:
        self._is_noted = False
        kept = _bounded(self._sources.kept())
        if kept == self._written or self._file is None:
            return
        at = datetime.now(UTC).isoformat(timespec="seconds")
        confined = self._workspace.confined
        only = None if confined is None else tuple(sorted(confined))
        draft = Draft(self._workspace.path, at, self._opened_with, kept, only)
        try:
            await asyncio.to_thread(_write_or_remove, self._file, draft)
        except DraftError as error:
            self._complain(error)
            return
        self._written = kept
        self._findings.replace("drafts", ())

    def _report_cut_save(self, file: DraftFile) -> None:
        written, missed = file.journal.cut(self._on_disk)
        if not missed:
            file.journal.end()
            return
        self._findings.replace("saving", [save_cut(written, missed)])

    def _on_disk(self, file: str) -> bytes:
        try:
            return self._workspace.served.read(file)
        except PackageError:
            return b""

    def _complain(self, error: DraftError) -> None:
        place = Place(self._workspace.path)
        problem = Problem(Severity.WARNING, "draft-not-kept", str(error), place)
        self._findings.replace("drafts", [problem])


COMMANDS: Final = Commands[Drafts](Scope.DOCUMENT)
COMMANDS.presenter(DiscardRestored, lambda drafts, _, __: drafts.discard())


def _bounded(kept: KeptSources) -> KeptSources:
    """With as much of the undo list as is kept."""
    kept = replace(kept, done=kept.done[-_STEPS_KEPT:], undone=kept.undone[-_STEPS_KEPT:])
    return kept if kept.size_bytes <= _LIMIT_BYTES else replace(kept, done=(), undone=())


def _write_or_remove(file: DraftFile, draft: Draft) -> None:
    """A document without edits, steps and new arguments needs no draft.

    Raises:
        DraftError: It is too large, or the disk refuses it.
    """
    kept = draft.kept
    if kept.size_bytes > _LIMIT_BYTES:
        raise DraftError(draft.entry, "they are too large")
    if kept.texts or kept.done or kept.undone or kept.arguments != draft.opened_with:
        file.write(draft)
    else:
        file.remove()


def save_cut(written: Sequence[str], missed: Sequence[str]) -> Problem:
    """The studio was ended in the middle of a save: some files are new, others are not."""
    sentence = (
        f"The studio was ended while it saved: {_names(written)} was written, {_names(missed)} was "
        "not, so the files may not fit each other. The edits are here: save them again."
    )
    return Problem(Severity.WARNING, "save-cut-off", sentence, Place(missed[0]))


def _names(files: Sequence[str]) -> str:
    return ", ".join(Path(one).name for one in files)
