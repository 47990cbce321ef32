"""What an editor in the page asks about a text, answered by the document's xacro worker."""

from __future__ import annotations

from typing import TYPE_CHECKING

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
from studio.protocol.language import (
    CompletionsAnswer,
    MeaningAnswer,
    OutlineAnswer,
    ReferencesAnswer,
)

if TYPE_CHECKING:
    from studio.documents.document import Document
    from studio.protocol.language import Complete, GetOutline, GetReferences, LookUp
    from studio.protocol.listeners import Listener


class LanguageDesk:
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
