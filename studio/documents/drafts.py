"""Nothing that was edited is lost with the process: kept beside the edits, back at the opening."""

from __future__ import annotations

import asyncio
from contextlib import contextmanager, suppress
from dataclasses import replace
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Final

from studio.description.editing.undo import Change
from studio.documents.draft_files import Draft, draft_file
from studio.documents.saving import save_cut
from studio.errors import DraftError, PackageError
from studio.problems import Place, Problem, Severity
from studio.protocol.saving import Restored

if TYPE_CHECKING:
    from collections.abc import Collection, Generator, Iterable
    from pathlib import Path

    from studio.description.editing.undo import KeptSources
    from studio.documents.document import Document
    from studio.documents.draft_files import DraftFile


_WRITE_AFTER_S: Final = 0.3
"""From a draft to the next one; the first edit of a pause is written at once."""
_WRITE_LARGE_AFTER_S: Final = 3.0
_SHOWN_WITHIN_S: Final = 0.05
"""An edit is shown before it is written, but for a run that takes longer."""
_LARGE_BYTES: Final = 1 << 20
_LIMIT_BYTES: Final = 64 << 20
_STEPS_KEPT: Final = 300


class Drafts:
    """Keeps the draft of one document, off the way of its edits."""

    def __init__(self, document: Document, data_folder: Path) -> None:
        self._document, self._data_folder = document, data_folder
        self._opened_with = document.sources.arguments
        self._file: DraftFile | None = None
        self._written: KeptSources | None = None
        self._restored = Restored(at="", files=())
        self._writing: asyncio.Task[None] | None = None
        self._not_shown: asyncio.TimerHandle | None = None
        """Ends the time that an edit has to be shown."""
        self._is_noted = self._is_forgotten = False
        self._ended = asyncio.Event()

    def events(self) -> Iterable[Restored]:
        """What a newcomer is told."""
        if self._restored.at:
            yield self._restored

    def restore(self) -> None:
        """Before the first run: take up what an earlier run of the studio left unsaved."""
        try:
            self._file = draft_file(self._data_folder, self._document.entry)
            draft = self._file.read()
        except DraftError as error:
            self._complain(error)
            return
        self._tell_cut_save(self._file)
        if draft is not None and draft.entry == self._document.path:
            self._take(draft)

    def note(self, *, shown: bool = True) -> None:
        """Something may have changed: write it down soon, and not too often.

        Of what is not `shown` yet, it is to be said once more when it is.
        """
        self._is_noted = True
        self._end_notice()
        if shown:
            self._begin()
        elif self._not_shown is None:
            loop = asyncio.get_running_loop()
            self._not_shown = loop.call_later(_SHOWN_WITHIN_S, self._begin)

    def _begin(self) -> None:
        if self._not_shown is not None:
            self._not_shown.cancel()
            self._not_shown = None
        if self._file is not None and (self._writing is None or self._writing.done()):
            self._writing = asyncio.create_task(self._write_while_noted())

    @contextmanager
    def saving(self, files: Collection[str] | None) -> Generator[None]:
        """Write these changed files, or all, inside: a kill meanwhile is told at the next run."""
        sources = self._document.sources
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
        self._document.board.find("saving", ())

    def forget(self) -> None:
        """The document is closed for good: nothing of it is to come back."""
        self._is_forgotten = True

    async def close(self) -> None:
        """Write what is not written yet, and leave the draft to the next run."""
        self._ended.set()
        if self._not_shown is not None:
            self._begin()
        if self._writing:
            await self._writing
        if self._file is None:
            return
        if self._is_forgotten:
            self._file.remove()
            self._file.journal.end()
        self._file.close()

    async def discard(self) -> None:
        """Give up what was restored: the files as the disk has them, which undo takes back."""
        document, sources = self._document, self._document.sources
        self._restored = Restored(at="", files=())
        document.board.audience.tell(self._restored)
        opened = self._opened_with
        values = {one: opened.get(one) for one in sources.arguments.keys() | opened.keys()}
        if sources.arguments != opened:
            sources.set_arguments(values, "Discard the restored arguments")
            await document.follow(Change("", arguments=sources.arguments))
        await document.saving.reload()

    def _take(self, draft: Draft) -> None:
        document, served = self._document, self._document.location.served
        kept, sources = draft.kept, document.sources
        texts = tuple(one for one in kept.texts if served.serves(one.file))
        if texts != kept.texts:  # other folders are open than were then
            kept = replace(kept, texts=texts, done=(), undone=())
        if draft.opened_with != self._opened_with:  # whoever names arguments wants these
            kept = replace(kept, arguments=self._opened_with)
        sources.put(kept)
        document.disk.look([one.file for one in texts])
        if sources.unsaved_files or sources.arguments != self._opened_with:
            self._restored = Restored(at=draft.at, files=sources.unsaved_files)
            document.board.audience.tell(self._restored)

    def _end_notice(self) -> None:
        """What was saved or taken back needs no word any more."""
        if not self._restored.at:
            return
        sources = self._document.sources
        if not (sources.unsaved_files or sources.arguments != self._opened_with):
            self._restored = Restored(at="", files=())
            self._document.board.audience.tell(self._restored)

    async def _write_while_noted(self) -> None:
        while self._is_noted and self._not_shown is None:
            await self._write()
            known = self._written
            large = known is not None and known.size_bytes > _LARGE_BYTES
            with suppress(TimeoutError):
                delay_s = _WRITE_LARGE_AFTER_S if large else _WRITE_AFTER_S
                await asyncio.wait_for(self._ended.wait(), delay_s)

    async def _write(self) -> None:
        self._is_noted = False
        kept = _bounded(self._document.sources.kept())
        if kept == self._written or self._file is None:
            return
        at = datetime.now(UTC).isoformat(timespec="seconds")
        draft = Draft(self._document.path, at, self._opened_with, kept)
        try:
            await asyncio.to_thread(_write_or_remove, self._file, draft)
        except DraftError as error:
            self._complain(error)
            return
        self._written = kept
        self._document.board.find("drafts", ())

    def _tell_cut_save(self, file: DraftFile) -> None:
        written, missed = file.journal.cut(self._on_disk)
        if not missed:
            file.journal.end()
            return
        self._document.board.find("saving", [save_cut(written, missed)])

    def _on_disk(self, file: str) -> bytes:
        try:
            return self._document.location.served.read(file)
        except PackageError:
            return b""

    def _complain(self, error: DraftError) -> None:
        place = Place(self._document.path)
        problem = Problem(Severity.WARNING, "draft-not-kept", str(error), place)
        self._document.board.find("drafts", [problem])


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
