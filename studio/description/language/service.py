"""Answer what an editor asks about the texts of one session."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from studio.description.editing.editor_text import EditorText
from studio.description.language.completion import completions_at
from studio.description.language.cursor import Cursor
from studio.description.language.meaning import meaning_of, subject_at, yaml_subject_at
from studio.description.language.outline import outline_of
from studio.description.language.questions import (
    CompletionQuery,
    Completions,
    LookedUp,
    OutlineQuery,
    References,
    ReferencesQuery,
    RenamingQuery,
)
from studio.description.language.reading import Reading
from studio.description.language.references import UsesBook, references_to
from studio.description.language.renaming import renaming_of

if TYPE_CHECKING:
    from collections.abc import Mapping

    from studio.description.evaluator.runs import GoodRun
    from studio.description.evaluator.source_store import SourceStore
    from studio.description.language.questions import LanguageQuery, LanguageReply
    from studio.description.values import ReadPolicy, Site


_NOTHING_TO_TYPE: Final = Completions(0, 0)
_NAMED_NOWHERE: Final = References(None, "", (), 0)


class LanguageService:
    """Holds what is known of the texts between two questions."""

    def __init__(self, store: SourceStore, policy: ReadPolicy, entry: str) -> None:
        self._reading = Reading(store, policy, entry)
        self._uses = UsesBook()

    def answer(
        self,
        query: LanguageQuery,
        arguments: Mapping[str, str],
        good: GoodRun | None,
        sites: Mapping[str, Site],
    ) -> LanguageReply:
        """Answer a question, from the last run that worked and the text as it is now.

        Raises:
            EditError: The question's place is not in the text, or its renaming is refused.
            Fault: A text that it needs cannot be read.
        """
        texts = {} if isinstance(query, OutlineQuery) else {query.file: query.text}
        self._reading.begin(texts, arguments, sites)
        if isinstance(query, CompletionQuery):
            self._reading.follow(good)
        else:
            self._reading.watch(good)
        return self._reply(query)

    def _reply(self, query: LanguageQuery) -> LanguageReply:
        if isinstance(query, OutlineQuery):
            return outline_of(self._reading)
        editor = EditorText(query.text)
        cursor = Cursor(self._reading, query.file, editor, editor.index_of(query.offset))
        if isinstance(query, CompletionQuery):
            return _NOTHING_TO_TYPE if cursor.is_yaml else completions_at(cursor)
        subject = yaml_subject_at(cursor) if cursor.is_yaml else subject_at(cursor)
        if isinstance(query, RenamingQuery):
            return renaming_of(subject, query.name, self._reading, self._uses)
        if isinstance(query, ReferencesQuery):
            return references_to(subject, self._reading, self._uses) if subject else _NAMED_NOWHERE
        return LookedUp(meaning_of(subject, cursor) if subject else None)
