"""The texts of a document in editors: told, typed into, and asked about by whoever types."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Final

from studio.description.editing.editor_text import EditorText, Piece, changes_between, patched
from studio.description.language.questions import (
    CompletionQuery,
    Completions,
    LookedUp,
    LookUpQuery,
    Outline,
    OutlineQuery,
    References,
    ReferencesQuery,
)
from studio.errors import CommandError, EditError, ReadOnlyTextError, StaleTextError
from studio.protocol.language import (
    CompletionsAnswer,
    MeaningAnswer,
    OutlineAnswer,
    ReferencesAnswer,
)
from studio.protocol.roles import Role
from studio.protocol.texts import EditText, GetText, Text, TextChange, TextsChanged

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from studio.description.values import Edit
    from studio.documents.document import Document
    from studio.protocol.language import Complete, GetOutline, GetReferences, LookUp
    from studio.protocol.listeners import Listener


TEXT_LIMIT_BYTES: Final = 4 << 20
"""More than any robot description; an editor in a browser holds it with ease."""
_LIMIT_MB: Final = TEXT_LIMIT_BYTES >> 20
_READ_ONLY: Final = "it lies where the studio may only read."


@dataclass(frozen=True, slots=True)
class _Told:
    """What the audience holds of one file."""

    version: int
    text: EditorText


class Texts:
    """Gives texts out and keeps those who have them up to date, whatever changes the sources.

    A text gets a version with each change that is told. Whoever edits names the version that it
    saw; an edit of another one is refused, so no offset ever points into a text that it does not
    belong to.
    """

    def __init__(self, document: Document) -> None:
        self._document = document
        self._told: dict[str, _Told] = {}
        self._typed: dict[str, EditText] = {}
        """What was typed and is not told yet."""

    def answer(self, command: GetText, role: Role) -> Text:
        """A file's text; its changes are told from now on.

        Raises:
            CommandError: It is no text, too large, or no file of this document to a viewer.
            PackageError: It lies outside the opened folders, or cannot be read.
        """
        file = self._name(command.file, role)
        self.follow()
        told = self._told.get(file) or self._first(file)
        saved = self._document.sources.saved(file)
        return Text(
            request=command.request,
            file=file,
            version=told.version,
            text=told.text.text,
            saved=None if saved == told.text.data else EditorText(saved).text,
            read_only="" if self._may_write(file) else f"{file} cannot be edited: {_READ_ONLY}",
        )

    def bytes_of(self, file: str, role: Role) -> tuple[str, bytes]:
        """The name under which a file is known, and its bytes as they are edited.

        Raises:
            CommandError: It is too large, or no file of this document to a viewer.
            PackageError: It lies outside the opened folders, or cannot be read.
        """
        name = self._name(file, role)
        sources, served = self._document.sources, self._document.location.served
        data = sources.text(name) if name in sources.files else served.read(name)
        if len(data) > TEXT_LIMIT_BYTES:
            raise CommandError(f"{file} is larger than {_LIMIT_MB} MB: open it in another editor.")
        return name, data

    def edit(self, command: EditText) -> tuple[Edit, ...]:
        """Type into a text; what was done to the sources, in order. `follow` tells it.

        Raises:
            StaleTextError: The text is no longer the one that was seen.
            ReadOnlyTextError: It may not be written.
            EditError: A change is none of this text, or its encoding lacks a letter.
        """
        file = self._name(command.file, Role.PRESENTER)
        if not self._may_write(file):
            raise ReadOnlyTextError(file, _READ_ONLY)
        self.follow()
        told = self._told.get(file)
        if told is None or told.version != command.version:
            raise StaleTextError(file)
        edits = _edits(file, told.text, command.changes)
        if len(told.text.data) + sum(len(edit.new) for edit in edits) > TEXT_LIMIT_BYTES:
            raise EditError(f"{file} would grow beyond {_LIMIT_MB} MB: leave something out.")
        gesture = command.gesture or f"text {file} {told.version}"
        for edit in edits:
            name = f"Edit {Path(file).name}"
            self._document.sources.edit(edit, name, gesture, is_value=False)
        self._typed[file] = command
        return edits

    def follow(self) -> None:
        """Tell what changed in the texts that somebody has."""
        for file, told in self._told.items():
            data = self._document.sources.text(file)
            if typed := self._typed.pop(file, None):
                self._tell_typed(file, typed)
            elif data != told.text.data:
                self._tell_new(file, told.text.text, EditorText(data))

    def _first(self, file: str) -> _Told:
        sources = self._document.sources
        # What is no text for us is not held for ever.
        is_held = file in sources.files
        data = sources.text(file) if is_held else self._document.location.served.read(file)
        if len(data) > TEXT_LIMIT_BYTES:
            raise CommandError(f"{file} is larger than {_LIMIT_MB} MB: open it in another editor.")
        if b"\0" in data:
            raise CommandError(f"{file} is no text that can be shown: open another file.")
        told = self._told[file] = _Told(1, EditorText(sources.text(file)))
        return told

    def _tell_typed(self, file: str, command: EditText) -> None:
        """Tell the typed changes as they came, then what the file's bytes made of them beyond.

        A changed encoding declaration makes other letters of bytes that nobody touched.
        """
        told = self._told[file]
        pieces = [
            Piece(told.text.index_of(one.start), told.text.index_of(one.end), one.text)
            for one in command.changes
        ]
        typed = patched(told.text.text, pieces)
        new = EditorText(self._document.sources.text(file))
        self._tell(file, new, command.changes, command.origin)
        if new.text != typed:
            self._tell_new(file, typed, new)

    def _tell_new(self, file: str, old: str, new: EditorText) -> None:
        changes = [
            TextChange(
                start=_units(old[: piece.start]), end=_units(old[: piece.end]), text=piece.text
            )
            for piece in changes_between(old, new.text)
        ]
        self._tell(file, new, changes, "")

    def _tell(self, file: str, new: EditorText, changes: Iterable[TextChange], origin: str) -> None:
        told = self._told[file]
        self._told[file] = replace(told, version=told.version + 1, text=new)
        event = TextsChanged(
            file=file, version=told.version + 1, changes=tuple(changes), origin=origin
        )
        self._document.board.audience.tell(event)

    def _name(self, file: str, role: Role) -> str:
        """The name under which the sources hold a file: symlinks resolved."""
        if not Path(file).is_absolute():
            raise CommandError(f"{file!r} is no whole path: name the file from the root on.")
        name = str(self._document.location.served.resolve(Path(file)))
        if role is not Role.PRESENTER and name not in self._read_by_the_run():
            raise CommandError(f"{file} is no file of this document: choose one of its files.")
        return name

    def _read_by_the_run(self) -> tuple[str, ...]:
        expansion = self._document.expansion
        return expansion.files if expansion else (self._document.path,)

    def _may_write(self, file: str) -> bool:
        return self._document.location.served.may_write(Path(file))


def _edits(file: str, text: EditorText, changes: Sequence[TextChange]) -> tuple[Edit, ...]:
    """The edits one after the other, the last place first: so each one's offsets hold."""
    at = 0
    for change in changes:
        if not at <= change.start <= change.end:
            raise EditError(f"{file}: the changes overlap or are out of order: load it again.")
        at = change.end
    return tuple(text.edit(file, one.start, one.end, one.text) for one in reversed(changes))


def _units(text: str) -> int:
    """Length in UTF-16 code units."""
    return len(text) if text.isascii() else len(text.encode("utf-16-le")) // 2


class EditorQuestions:
    """Asks with the text as it is edited at that moment, whatever the worker has read so far.

    Every question raises a CommandError when nobody can answer it, or a PackageError for a file
    that may not be read.
    """

    def __init__(self, document: Document) -> None:
        self._document = document

    async def outline(self, command: GetOutline, asker: Listener) -> OutlineAnswer:
        """What the files of the document hold."""
        outline = await self._document.ask(OutlineQuery(), Outline, asker)
        return OutlineAnswer(request=command.request, outline=outline)

    async def look_up(self, command: LookUp, asker: Listener) -> MeaningAnswer:
        """What stands at a place."""
        file, text = self._document.texts.bytes_of(command.file, asker.role)
        query = LookUpQuery(file, text, command.offset)
        found = await self._document.ask(query, LookedUp, asker)
        return MeaningAnswer(request=command.request, meaning=found.meaning)

    async def references(self, command: GetReferences, asker: Listener) -> ReferencesAnswer:
        """All places that name what stands at a place."""
        file, text = self._document.texts.bytes_of(command.file, asker.role)
        query = ReferencesQuery(file, text, command.offset)
        references = await self._document.ask(query, References, asker)
        return ReferencesAnswer(request=command.request, references=references)

    async def complete(self, command: Complete, asker: Listener) -> CompletionsAnswer:
        """What may be typed at a place."""
        file, text = self._document.texts.bytes_of(command.file, asker.role)
        query = CompletionQuery(file, text, command.offset)
        completions = await self._document.ask(query, Completions, asker)
        return CompletionsAnswer(request=command.request, completions=completions)
