"""Names and words that change in all texts of a document at once, as one step of undo."""

from __future__ import annotations

import asyncio
from itertools import count
from typing import TYPE_CHECKING, Final

from studio.description.editing.sources import Change
from studio.description.language.questions import Renaming, RenamingQuery, SubjectKind
from studio.description.values import Edit
from studio.documents.questions.text_search import Matches, Words, matches_in, replacements_in
from studio.documents.questions.texts import TEXT_LIMIT_BYTES
from studio.errors import CommandError, EditError, PackageError, ReadOnlyTextError, StaleTextError
from studio.protocol.texts import (
    FindTexts,
    FoundText,
    GetRenaming,
    Rename,
    RenamingAnswer,
    ReplaceTexts,
    TextsFound,
    WordsCommand,
)

if TYPE_CHECKING:
    from collections.abc import Sequence

    from studio.documents.document import Document
    from studio.protocol.listeners import Listener

PLACES_SHOWN: Final = 1_000
REPLACED_LIMIT: Final = 5_000
_LABEL_LENGTH: Final = 30


class RewritingDesk:
    """Tells the places first, then writes them, when they are still the same."""

    def __init__(self, document: Document) -> None:
        self._document = document
        self._steps = count(1)

    async def renaming(self, command: GetRenaming, asker: Listener) -> RenamingAnswer:
        """What a renaming would change.

        Raises:
            CommandError: What stands there cannot be renamed so; the sentence says why.
        """
        found = await self._ask(command, asker)
        places = [
            FoundText(place=one.place, line=one.line, in_run=one.in_run)
            for one in found.places[:PLACES_SHOWN]
        ]
        return RenamingAnswer(
            request=command.request,
            kind=found.kind,
            old=found.old,
            new=found.new,
            places=tuple(places),
            count=len(found.places),
            files=len({one.place.file for one in found.places}),
        )

    async def rename(self, command: Rename, asker: Listener) -> None:
        """Rename what stands at a place, and show what that does.

        Raises:
            CommandError: It cannot be renamed so, or the places are others by now.
            ReadOnlyTextError: A file may not be written.
            StaleTextError: A text is another one by now.
        """
        renaming = await self._ask(command, asker)
        if len(renaming.places) != command.count:
            raise CommandError("The texts have changed since: look at the places again.")
        sources, name = self._document.sources, renaming.new.encode()
        for one in renaming.places:
            data = sources.text(one.place.file)
            if data[one.start : one.end] != renaming.old.encode():
                raise StaleTextError(one.place.file)
        edits = [Edit(p.place.file, p.start, p.end, name) for p in reversed(renaming.places)]
        await self._write(edits, f"Rename {renaming.old} → {renaming.new}", renaming)

    async def find(self, command: FindTexts, asker: Listener) -> TextsFound:
        """Where words stand in the files of the robot."""
        texts = self._texts(asker)
        found = await asyncio.to_thread(matches_in, texts, _words(command), PLACES_SHOWN)
        return _texts_found(command.request, found)

    async def replace(self, command: ReplaceTexts, asker: Listener) -> None:
        """Replace words in the files of the robot, and show what that does.

        Raises:
            CommandError: They stand at other places by now, or at too many.
            ReadOnlyTextError: A file may not be written.
            EditError: A file's encoding lacks a letter, or it would grow too large.
        """
        if command.count > REPLACED_LIMIT:
            raise CommandError(
                f"These are more than {REPLACED_LIMIT} places: look for longer words."
            )
        words, edits = _words(command), list[Edit]()
        for file, data in self._texts(asker):
            most = command.count - len(edits) + 1
            edits += replacements_in(file, data, words, command.replacement, most)
            if len(edits) > command.count:
                break
        if len(edits) != command.count:
            raise CommandError("The texts have changed since: look at the places again.")
        await self._write(edits, f"Replace {_short(command.text)} → {_short(command.replacement)}")

    async def _ask(self, command: GetRenaming | Rename, asker: Listener) -> Renaming:
        file, text = self._document.texts.bytes_of(command.file, asker.role)
        query = RenamingQuery(file, text, command.offset, command.name)
        return await self._document.ask(query, Renaming, asker)

    def _texts(self, asker: Listener) -> list[tuple[str, bytes]]:
        """The files of the robot that hold text, as they are edited."""
        found: list[tuple[str, bytes]] = []
        for file in self._document.files_read:
            try:
                found.append(self._document.texts.bytes_of(file, asker.role))
            except (CommandError, PackageError):  # too large, or gone from the disk
                continue
        return [(file, data) for file, data in found if b"\0" not in data]

    async def _write(
        self, edits: Sequence[Edit], label: str, renaming: Renaming | None = None
    ) -> None:
        """Make all edits, in order, one step of undo."""
        self._check(edits)
        sources, gesture = self._document.sources, f"rewrite {next(self._steps)}"
        sources.edit_all(edits, label, gesture)
        arguments = None
        if renaming and renaming.kind is SubjectKind.ARG and renaming.old in sources.arguments:
            given = sources.arguments[renaming.old]
            sources.set_arguments({renaming.old: None, renaming.new: given}, label, gesture)
            arguments = sources.arguments
        await self._document.follow(Change(label, tuple(edits), arguments))

    def _check(self, edits: Sequence[Edit]) -> None:
        sources, served = self._document.sources, self._document.location.served
        grown: dict[str, int] = {}
        for edit in edits:
            grown[edit.file] = grown.get(edit.file, 0) + len(edit.new) - (edit.end - edit.start)
        for file, more in grown.items():
            if not served.may_write(file):
                raise ReadOnlyTextError(file, "it lies where the studio may only read.")
            if len(sources.text(file)) + more > TEXT_LIMIT_BYTES:
                raise EditError(f"{file} would grow too large: write less.")


def _words(command: WordsCommand) -> Words:
    return Words(command.text, command.match_case, command.whole_word)


def _texts_found(request: int, found: Matches) -> TextsFound:
    places = [
        FoundText(place=one.place, line=one.line, line_column=one.line_column)
        for one in found.shown
    ]
    return TextsFound(request=request, places=tuple(places), count=found.count, files=found.files)


def _short(text: str) -> str:
    line = " ".join(text.split())
    return line if len(line) <= _LABEL_LENGTH else f"{line[:_LABEL_LENGTH]}…"
