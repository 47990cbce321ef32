"""Answers what an editor asks about the texts of one session."""

from __future__ import annotations

from pathlib import PurePath
from typing import TYPE_CHECKING, Final

from studio.description.cursor import Cursor
from studio.description.editor_text import EditorText
from studio.description.language import LookedUp, LookUpQuery, OutlineQuery
from studio.description.meaning import meaning_of
from studio.description.outline import outline_of
from studio.description.queries import NoReply
from studio.description.reading import Reading
from studio.description.subject_at import subject_at, yaml_subject_at
from studio.errors import EditError

if TYPE_CHECKING:
    from collections.abc import Mapping

    from studio.description.good_run import GoodRun
    from studio.description.language import LanguageQuery, LanguageReply, Meaning
    from studio.description.run_record import RunRecord
    from studio.description.source_store import SourceStore
    from studio.description.values import ReadPolicy, Site

_YAML: Final = frozenset({".yaml", ".yml"})


class LanguageDesk:
    """Holds what is known of the texts between two questions."""

    def __init__(self, store: SourceStore, policy: ReadPolicy, entry: str) -> None:
        self._reading = Reading(store, policy, entry)

    def answer(
        self,
        query: LanguageQuery,
        arguments: Mapping[str, str],
        good: GoodRun | None,
        sites: Mapping[str, Site],
    ) -> LanguageReply | NoReply:
        """Answer a question, from the last run that worked and the text as it is now."""
        reading = self._reading
        try:
            texts = {} if isinstance(query, OutlineQuery) else {query.file: query.text}
            reading.begin(texts, arguments, sites)
            reading.watch(_texts_of(good.record) if good else None)
            if isinstance(query, OutlineQuery):
                return outline_of(reading)
            cursor = _cursor(reading, query)
            return LookedUp(_look_up(cursor))
        except EditError as error:
            return NoReply(str(error))
        except Exception as error:  # noqa: BLE001 - a question may not cost the process its robot
            return NoReply(f"The question could not be answered: {type(error).__name__}: {error}")


def _texts_of(record: RunRecord) -> dict[str, bytes]:
    """What a run read, by resolved path."""
    texts = {path: tree.data for path, tree in record.trees.items()}
    return texts | {path: one.data for path, one in record.yaml.items()}


def _cursor(reading: Reading, query: LookUpQuery) -> Cursor:
    editor = EditorText(query.text)
    return Cursor(reading, query.file, editor, editor.index_of(query.offset))


def _look_up(cursor: Cursor) -> Meaning | None:
    if PurePath(cursor.file).suffix.lower() in _YAML:
        byte = cursor.editor.byte_at(cursor.editor.offset_of(cursor.index))
        subject = yaml_subject_at(cursor.file, cursor.editor.data, byte)
    else:
        subject = subject_at(cursor)
    return meaning_of(subject, cursor) if subject else None
