"""Names and texts replaced in all files of a document at once, as one undo step."""

from __future__ import annotations

import asyncio
from dataclasses import dataclass
from itertools import count, islice
from typing import TYPE_CHECKING, Final

from studio.description.editing.editor_text import EditorText
from studio.description.editing.undo import Change
from studio.description.language.questions import Renaming, RenamingQuery, SubjectKind, TextPlace
from studio.description.values import Edit
from studio.documents.edits import READ_ONLY, TEXT_LIMIT_BYTES
from studio.errors import CommandError, EditError, PackageError, ReadOnlyTextError, StaleTextError
from studio.protocol.commands import Commands, OnCopies, Scope
from studio.protocol.texts import (
    FindTexts,
    FoundText,
    GetRenaming,
    Rename,
    RenamingAnswer,
    ReplaceTexts,
    TextSearch,
    TextsFound,
)

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from studio.documents.edits import Edits
    from studio.documents.runs import Runs
    from studio.documents.texts import Texts
    from studio.documents.workspace import Workspace
    from studio.protocol.listeners import Listener


_SHOWN_BEFORE: Final = 24
_SHOWN: Final = 240


@dataclass(frozen=True, slots=True)
class SearchText:
    """A text to find; never a pattern, which could be made to run for ever."""

    text: str
    match_case: bool = False
    whole_word: bool = False

    def spans(self, text: str) -> Iterator[tuple[int, int]]:
        """Yield the places, [start, end) as indices, none overlapping.

        Not by a regular expression: one that ignores case takes the length of both multiplied.
        """
        wanted = self._compared(self.text.replace("\r\n", "\n"))
        compared, at = self._compared(text), 0
        while (at := compared.find(wanted, at)) >= 0:
            end = at + len(wanted)
            is_found = not self.whole_word or _stands_alone(text, at, end)
            if is_found:
                yield at, end
            at = end if is_found else at + 1

    def _compared(self, text: str) -> str:
        """Return the text, in lower case unless case counts, of the same length."""
        return text if self.match_case else text.replace("\u0130", "i").lower()


@dataclass(frozen=True, slots=True)
class Match:
    """One place with its line: `line` begins at column `line_column`, from 1."""

    place: TextPlace
    line: str
    line_column: int


@dataclass(frozen=True, slots=True)
class Matches:
    """The first of `count` matches, in `files` files."""

    shown: tuple[Match, ...]
    count: int
    files: int


def matches_in(texts: Iterable[tuple[str, bytes]], wanted_text: SearchText, limit: int) -> Matches:
    """Find a text in the bytes of files, by name."""
    shown: list[Match] = []
    count = files = 0
    for file, data in texts:
        editor = EditorText(data)
        spans = wanted_text.spans(editor.text)
        first = list(islice(spans, max(0, limit - len(shown))))
        shown += _drawn(file, editor, first)
        here = len(first) + sum(1 for _ in spans)
        count += here
        files += here > 0
    return Matches(tuple(shown), count, files)


def replacements_in(
    file: str, data: bytes, wanted_text: SearchText, text: str, most: int | None = None
) -> list[Edit]:
    """Return the edits that write `text` at each place, the last place first.

    Of more than `most` places only the first.

    Raises:
        EditError: The file's encoding lacks a letter of it.
    """
    editor = EditorText(data)
    return editor.replacements(file, islice(wanted_text.spans(editor.text), most), text)


def _stands_alone(text: str, start: int, end: int) -> bool:
    """Whether no letter, digit or underscore goes on before or behind."""
    around = (text[start - 1 : start] if start else "", text[end : end + 1])
    return not any(one.isalnum() or one == "_" for one in around)


def _drawn(file: str, editor: EditorText, spans: list[tuple[int, int]]) -> Iterator[Match]:
    text, number, counted = editor.text, 1, 0
    for start, end in spans:
        number += text.count("\n", counted, start)
        counted = start
        begin = text.rfind("\n", 0, start) + 1
        line_end = text.find("\n", start)
        line_end = len(text) if line_end < 0 else line_end
        from_ = start - len(text[max(begin, start - _SHOWN_BEFORE) : start].lstrip())
        column = _units(editor, begin, start) + 1
        length = _units(editor, start, min(end, line_end))
        place = TextPlace(file, number, column, length)
        line = text[from_ : min(line_end, from_ + _SHOWN)].rstrip()
        yield Match(place, line, _units(editor, begin, from_) + 1)


def _units(editor: EditorText, start: int, end: int) -> int:
    return editor.offset_of(end) - editor.offset_of(start)


PLACES_SHOWN: Final = 1_000
REPLACED_LIMIT: Final = 5_000
_LABEL_LENGTH: Final = 30


class Rewriting:
    """Lists the places first, then writes them if they are still the same.

    Args:
        workspace: The texts, and which files may be written.
        runs: Asks the worker for the places of a name and the files of the robot.
        texts: Sends the texts to those who may read them.
        edits: Runs an undo step.
    """

    def __init__(self, workspace: Workspace, runs: Runs, texts: Texts, edits: Edits) -> None:
        self._workspace, self._sources, self._runs = workspace, workspace.sources, runs
        self._texts, self._edits = texts, edits
        self._steps = count(1)

    async def renaming(self, command: GetRenaming, asker: Listener) -> RenamingAnswer:
        """Return the changes that a renaming would make.

        Raises:
            CommandError: The name cannot be changed; the sentence says why.
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
        sources, name = self._sources, renaming.new.encode()
        for one in renaming.places:
            data = sources.text(one.place.file)
            if data[one.start : one.end] != renaming.old.encode():
                raise StaleTextError(one.place.file)
        edits = [Edit(p.place.file, p.start, p.end, name) for p in reversed(renaming.places)]
        await self._write(edits, f"Rename {renaming.old} → {renaming.new}", renaming)

    async def find(self, command: FindTexts, asker: Listener) -> TextsFound:
        """Return the places of a text in the files of the robot."""
        texts = self._robot_texts(asker)
        found = await asyncio.to_thread(matches_in, texts, _search_text(command), PLACES_SHOWN)
        return _texts_found(command.request, found)

    async def replace(self, command: ReplaceTexts, asker: Listener) -> None:
        """Replace a text in the files of the robot, and run them.

        Raises:
            CommandError: The places have changed, or are too many.
            ReadOnlyTextError: A file may not be written.
            EditError: A file's encoding lacks a letter, or it would grow too large.
        """
        if command.count > REPLACED_LIMIT:
            raise CommandError(
                f"These are more than {REPLACED_LIMIT} places: look for longer words."
            )
        wanted_text, edits = _search_text(command), list[Edit]()
        for file, data in self._robot_texts(asker):
            most = command.count - len(edits) + 1
            edits += replacements_in(file, data, wanted_text, command.replacement, most)
            if len(edits) > command.count:
                break
        if len(edits) != command.count:
            raise CommandError("The texts have changed since: look at the places again.")
        await self._write(edits, f"Replace {_short(command.text)} → {_short(command.replacement)}")

    async def _ask(self, command: GetRenaming | Rename, asker: Listener) -> Renaming:
        file, text = self._texts.bytes_of(command.file, asker.role)
        query = RenamingQuery(file, text, command.offset, command.name)
        return await self._runs.answer(query, Renaming, asker)

    def _robot_texts(self, asker: Listener) -> list[tuple[str, bytes]]:
        """Return the files of the robot that hold text, as they are edited."""
        found: list[tuple[str, bytes]] = []
        for file in self._runs.last.files:
            try:
                found.append(self._texts.bytes_of(file, asker.role))
            except (CommandError, PackageError):  # too large, or gone from the disk
                continue
        return [(file, data) for file, data in found if b"\0" not in data]

    async def _write(
        self, edits: Sequence[Edit], label: str, renaming: Renaming | None = None
    ) -> None:
        """Make all edits, in order, one step of undo."""
        self._check(edits)
        sources, gesture = self._sources, f"rewrite {next(self._steps)}"
        sources.edit_all(edits, label, gesture)
        arguments = None
        if renaming and renaming.kind is SubjectKind.ARG and renaming.old in sources.arguments:
            given = sources.arguments[renaming.old]
            sources.set_arguments({renaming.old: None, renaming.new: given}, label, gesture)
            arguments = sources.arguments
        await self._edits.follow(Change(label, tuple(edits), arguments))

    def _check(self, edits: Sequence[Edit]) -> None:
        sources, served = self._sources, self._workspace.served
        grown: dict[str, int] = {}
        for edit in edits:
            grown[edit.file] = grown.get(edit.file, 0) + len(edit.new) - (edit.end - edit.start)
        for file, more in grown.items():
            if not served.may_write(file):
                raise ReadOnlyTextError(file, READ_ONLY)
            if len(sources.text(file)) + more > TEXT_LIMIT_BYTES:
                raise EditError(f"{file} would grow too large: write less.")


COMMANDS: Final = Commands[Rewriting](Scope.DOCUMENT)
COMMANDS.controller(
    Rename, lambda rewriting, c, who: rewriting.rename(c, who), on_copies=OnCopies.WITHIN_ROOM
)
COMMANDS.controller(
    ReplaceTexts,
    lambda rewriting, c, who: rewriting.replace(c, who),
    on_copies=OnCopies.WITHIN_ROOM,
)
COMMANDS.controller(GetRenaming, lambda rewriting, c, who: rewriting.renaming(c, who))
COMMANDS.viewer(FindTexts, lambda rewriting, c, who: rewriting.find(c, who))


def _search_text(command: TextSearch) -> SearchText:
    return SearchText(command.text, command.match_case, command.whole_word)


def _texts_found(request: int, found: Matches) -> TextsFound:
    places = [
        FoundText(place=one.place, line=one.line, line_column=one.line_column)
        for one in found.shown
    ]
    return TextsFound(request=request, places=tuple(places), count=found.count, files=found.files)


def _short(text: str) -> str:
    line = " ".join(text.split())
    return line if len(line) <= _LABEL_LENGTH else f"{line[:_LABEL_LENGTH]}…"
