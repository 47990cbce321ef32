"""The texts of a document in editors: sent, edited, and questions about them."""

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
from studio.documents.edits import PROGRAM, READ_ONLY, TEXT_LIMIT_BYTES
from studio.errors import CommandError, EditError, ReadOnlyTextError, StaleTextError
from studio.protocol.commands import Commands, OnCopies, Scope
from studio.protocol.language import (
    Complete,
    CompletionsAnswer,
    GetOutline,
    GetReferences,
    LookUp,
    MeaningAnswer,
    OutlineAnswer,
    ReferencesAnswer,
)
from studio.protocol.roles import Role
from studio.protocol.texts import EditText, GetText, Text, TextChange, TextsChanged

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from studio.description.values import Edit
    from studio.documents.edits import Edits
    from studio.documents.runs import LastRun, Runs
    from studio.documents.workspace import Workspace
    from studio.protocol.listeners import Audience, Listener

_LIMIT_MB: Final = TEXT_LIMIT_BYTES >> 20


@dataclass(frozen=True, slots=True)
class _Sent:
    """The audience's copy of one file."""

    version: int
    text: EditorText


class Texts:
    """Sends texts and keeps all copies up to date, whatever changes the sources.

    A text gets a new version with each change that is sent. An edit names the version that it is
    for and is refused for another one, so no offset ever points into a text that it does not
    belong to.

    Args:
        workspace: The files and their texts.
        last_run: The files of the robot.
        audience: Is sent the changes.
        edits: Runs what was typed.
    """

    def __init__(
        self, workspace: Workspace, last_run: LastRun, audience: Audience, edits: Edits
    ) -> None:
        self.on_first: Callable[[], None] = lambda: None
        """Called when a file's text is asked for that nobody had so far."""
        self._workspace, self._sources, self._last_run = workspace, workspace.sources, last_run
        self._audience, self._edits = audience, edits
        self._sent: dict[str, _Sent] = {}
        self._typed: dict[str, EditText] = {}
        """What was typed and not sent yet."""

    def answer(self, command: GetText, role: Role) -> Text:
        """Return a file's text; its changes are sent from now on.

        Raises:
            CommandError: It is no text, too large, or no file of this document to a viewer.
            PackageError: It lies outside the opened folders, or cannot be read.
        """
        file = self._name(command.file, role)
        self.follow()
        sent = self._sent.get(file) or self._first(file)
        saved = self._sources.saved(file)
        return Text(
            request=command.request,
            file=file,
            version=sent.version,
            text=sent.text.text,
            saved=None if saved == sent.text.data else EditorText(saved).text,
            read_only=f"{file} cannot be edited: {why}" if (why := self._read_only(file)) else "",
        )

    def bytes_of(self, file: str, role: Role) -> tuple[str, bytes]:
        """Return the name under which a file is known, and its bytes as they are edited.

        Raises:
            CommandError: It is too large, or no file of this document to a viewer.
            PackageError: It lies outside the opened folders, or cannot be read.
        """
        name = self._name(file, role)
        sources, served = self._sources, self._workspace.served
        data = sources.text(name) if name in sources.files else served.read(name)
        if len(data) > TEXT_LIMIT_BYTES:
            raise CommandError(f"{file} is larger than {_LIMIT_MB} MB: open it in another editor.")
        return name, data

    async def edit(self, command: EditText, role: Role) -> None:
        """Type into a text, and show what that does.

        Raises:
            StaleTextError: The text is no longer the one that was seen.
            ReadOnlyTextError: It may not be written.
            EditError: A change is none of this text, or its encoding lacks a letter.
            CommandError: It is no file of this document to anybody but a presenter.
            NotAllowedError: It is a program, which is a presenter's alone.
        """
        file = self._name(command.file, role)
        self._workspace.check_role([file], role)
        if reason := self._read_only(file):
            raise ReadOnlyTextError(file, reason)
        self.follow()
        sent = self._sent.get(file)
        if sent is None or sent.version != command.version:
            raise StaleTextError(file)
        edits = _edits(file, sent.text, command.changes)
        if len(sent.text.data) + sum(len(edit.new) for edit in edits) > TEXT_LIMIT_BYTES:
            raise EditError(f"{file} would grow beyond {_LIMIT_MB} MB: leave something out.")
        gesture = command.gesture or f"text {file} {sent.version}"
        for edit in edits:
            name = f"Edit {Path(file).name}"
            self._sources.type_in(edit, name, gesture)
        self._typed[file] = command
        await self._edits.run(edits, in_gesture=bool(command.gesture))

    def follow(self) -> None:
        """Send the changes of the texts that somebody has."""
        for file, sent in self._sent.items():
            data = self._sources.text(file)
            if typed := self._typed.pop(file, None):
                self._send_typed(file, typed)
            elif data != sent.text.data:
                self._send_new(file, sent.text.text, EditorText(data))

    def _first(self, file: str) -> _Sent:
        sources = self._sources
        # What is no text for us is not held for ever.
        is_held = file in sources.files
        data = sources.text(file) if is_held else self._workspace.served.read(file)
        if len(data) > TEXT_LIMIT_BYTES:
            raise CommandError(f"{file} is larger than {_LIMIT_MB} MB: open it in another editor.")
        if b"\0" in data:
            raise CommandError(f"{file} is no text that can be shown: open another file.")
        sent = self._sent[file] = _Sent(1, EditorText(sources.text(file)))
        if not is_held:
            self.on_first()
        return sent

    def _send_typed(self, file: str, command: EditText) -> None:
        """Send the changes as typed, then what else they changed in the decoded text.

        Another encoding declaration changes letters whose bytes nobody touched.
        """
        sent = self._sent[file]
        pieces = [
            Piece(sent.text.index_of(one.start), sent.text.index_of(one.end), one.text)
            for one in command.changes
        ]
        typed = patched(sent.text.text, pieces)
        new = EditorText(self._sources.text(file))
        self._send(file, new, command.changes, command.origin)
        if new.text != typed:
            self._send_new(file, typed, new)

    def _send_new(self, file: str, old: str, new: EditorText) -> None:
        changes = [
            TextChange(
                start=_units(old[: piece.start]), end=_units(old[: piece.end]), text=piece.text
            )
            for piece in changes_between(old, new.text)
        ]
        self._send(file, new, changes, "")

    def _send(self, file: str, new: EditorText, changes: Iterable[TextChange], origin: str) -> None:
        sent = self._sent[file]
        self._sent[file] = replace(sent, version=sent.version + 1, text=new)
        event = TextsChanged(
            file=file, version=sent.version + 1, changes=tuple(changes), origin=origin
        )
        self._audience.send(event)

    def _name(self, file: str, role: Role) -> str:
        """Return the name under which the sources hold a file: symlinks resolved."""
        if not Path(file).is_absolute():
            raise CommandError(f"{file!r} is no whole path: name the file from the root on.")
        name = str(self._workspace.served.resolve(Path(file)))
        if role is not Role.PRESENTER and name not in self._read_by_the_run():
            raise CommandError(f"{file} is no file of this document: choose one of its files.")
        return name

    def _read_by_the_run(self) -> tuple[str, ...]:
        expansion = self._last_run.expansion
        return expansion.files if expansion else (self._workspace.path,)

    def _read_only(self, file: str) -> str:
        """Return why a file cannot be edited; empty: it can."""
        if not self._workspace.may_program(file):
            return PROGRAM.format(folder=self._workspace.location.root)
        return "" if self._workspace.served.may_write(Path(file)) else READ_ONLY


COMMANDS: Final = Commands[Texts](Scope.DOCUMENT)
COMMANDS.controller(
    EditText, lambda texts, c, who: texts.edit(c, who.role), on_copies=OnCopies.WITHIN_ROOM
)
COMMANDS.viewer(GetText, lambda texts, c, who: texts.answer(c, who.role), same_for_all=True)


def _edits(file: str, text: EditorText, changes: Sequence[TextChange]) -> tuple[Edit, ...]:
    """Return the edits one after the other, the last place first: so each one's offsets hold."""
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
    """Asks the worker about the text as edited, whatever it has read so far.

    Every question raises a CommandError without an answer, or a PackageError for a file that may
    not be read.
    """

    def __init__(self, texts: Texts, runs: Runs) -> None:
        self._texts, self._runs = texts, runs

    async def outline(self, command: GetOutline, asker: Listener) -> OutlineAnswer:
        """Return the outline of the document's files."""
        outline = await self._runs.answer(OutlineQuery(), Outline, asker)
        return OutlineAnswer(request=command.request, outline=outline)

    async def look_up(self, command: LookUp, asker: Listener) -> MeaningAnswer:
        """Return the meaning at a place."""
        file, text = self._texts.bytes_of(command.file, asker.role)
        query = LookUpQuery(file, text, command.offset)
        found = await self._runs.answer(query, LookedUp, asker)
        return MeaningAnswer(request=command.request, meaning=found.meaning)

    async def references(self, command: GetReferences, asker: Listener) -> ReferencesAnswer:
        """Return all places of the name at a place."""
        file, text = self._texts.bytes_of(command.file, asker.role)
        query = ReferencesQuery(file, text, command.offset)
        references = await self._runs.answer(query, References, asker)
        return ReferencesAnswer(request=command.request, references=references)

    async def complete(self, command: Complete, asker: Listener) -> CompletionsAnswer:
        """Return the completions at a place."""
        file, text = self._texts.bytes_of(command.file, asker.role)
        query = CompletionQuery(file, text, command.offset)
        completions = await self._runs.answer(query, Completions, asker)
        return CompletionsAnswer(request=command.request, completions=completions)


QUESTIONS: Final = Commands[EditorQuestions](Scope.DOCUMENT)
QUESTIONS.viewer(GetOutline, lambda editor, c, who: editor.outline(c, who))
QUESTIONS.viewer(LookUp, lambda editor, c, who: editor.look_up(c, who))
QUESTIONS.viewer(GetReferences, lambda editor, c, who: editor.references(c, who))
QUESTIONS.controller(Complete, lambda editor, c, who: editor.complete(c, who))
