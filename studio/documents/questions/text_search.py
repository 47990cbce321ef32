"""Words in texts, as a person looks for them: plain, whole or not, in any case or not."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import islice
from typing import TYPE_CHECKING, Final

from studio.description.editing.editor_text import EditorText
from studio.description.language.questions import TextPlace

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from studio.description.values import Edit

_SHOWN_BEFORE: Final = 24
_SHOWN: Final = 240


@dataclass(frozen=True, slots=True)
class Words:
    """What is looked for; never a pattern, which a text could make run for ever."""

    text: str
    match_case: bool = False
    whole_word: bool = False

    def spans(self, text: str) -> Iterator[tuple[int, int]]:
        """Where they stand, [start, end) as indices, one behind the other.

        Not by a regular expression: one that ignores case takes the length of both multiplied.
        """
        wanted = self._compared(self.text.replace("\r\n", "\n"))
        looked_at, at = self._compared(text), 0
        while (at := looked_at.find(wanted, at)) >= 0:
            end = at + len(wanted)
            is_found = not self.whole_word or _stands_alone(text, at, end)
            if is_found:
                yield at, end
            at = end if is_found else at + 1

    def _compared(self, text: str) -> str:
        """The text, small when case is the same, of the same length: only one letter grows."""
        return text if self.match_case else text.replace("\u0130", "i").lower()


@dataclass(frozen=True, slots=True)
class Match:
    """One place, as its line shows it: `line` begins at column `line_column`, from 1."""

    place: TextPlace
    line: str
    line_column: int


@dataclass(frozen=True, slots=True)
class Matches:
    """The first of `count` matches, in `files` files."""

    shown: tuple[Match, ...]
    count: int
    files: int


def matches_in(texts: Iterable[tuple[str, bytes]], words: Words, limit: int) -> Matches:
    """Look for words in the bytes of files, by name."""
    shown: list[Match] = []
    count = files = 0
    for file, data in texts:
        editor = EditorText(data)
        spans = words.spans(editor.text)
        first = list(islice(spans, max(0, limit - len(shown))))
        shown += _drawn(file, editor, first)
        here = len(first) + sum(1 for _ in spans)
        count += here
        files += here > 0
    return Matches(tuple(shown), count, files)


def replacements_in(
    file: str, data: bytes, words: Words, text: str, most: int | None = None
) -> list[Edit]:
    """The edits that write `text` wherever the words stand, the last place first.

    Of more than `most` places the first ones.

    Raises:
        EditError: The file's encoding lacks a letter of it.
    """
    editor = EditorText(data)
    return editor.replacements(file, islice(words.spans(editor.text), most), text)


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
