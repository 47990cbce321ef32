"""Words in texts, as a person looks for them: plain, whole or not, in any case or not."""

from __future__ import annotations

import re
from bisect import bisect_right
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

    @property
    def pattern(self) -> re.Pattern[str]:
        """Them as a pattern."""
        plain = re.escape(self.text.replace("\r\n", "\n"))
        if self.whole_word:
            plain = rf"(?<!\w){plain}(?!\w)"
        return re.compile(plain, 0 if self.match_case else re.IGNORECASE)


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
    pattern = words.pattern
    shown: list[Match] = []
    count = files = 0
    for file, data in texts:
        editor = EditorText(data)
        found = [one.span() for one in pattern.finditer(editor.text)]
        count += len(found)
        files += bool(found)
        shown += islice(_drawn(file, editor, found), max(0, limit - len(shown)))
    return Matches(tuple(shown), count, files)


def replacements_in(file: str, data: bytes, words: Words, text: str) -> list[Edit]:
    """The edits that write `text` wherever the words stand, the last place first.

    Raises:
        EditError: The file's encoding lacks a letter of it.
    """
    editor = EditorText(data)
    spans = [one.span() for one in words.pattern.finditer(editor.text)]
    places = [(editor.offset_of(start), editor.offset_of(end)) for start, end in spans]
    return [editor.edit(file, start, end, text) for start, end in reversed(places)]


def _drawn(file: str, editor: EditorText, spans: list[tuple[int, int]]) -> Iterator[Match]:
    text = editor.text
    starts = [0, *(one.end() for one in re.finditer("\n", text))]
    for start, end in spans:
        number = bisect_right(starts, start)
        begin = starts[number - 1]
        line_end = text.find("\n", start)
        line_end = len(text) if line_end < 0 else line_end
        from_ = max(_indented(text, begin, start), start - _SHOWN_BEFORE)
        column = _units(editor, begin, start) + 1
        length = _units(editor, start, min(end, line_end))
        place = TextPlace(file, number, column, length)
        line = text[from_ : min(line_end, from_ + _SHOWN)].rstrip()
        yield Match(place, line, _units(editor, begin, from_) + 1)


def _indented(text: str, begin: int, start: int) -> int:
    """Behind the blanks that a line begins with."""
    return begin + len(text[begin:start]) - len(text[begin:start].lstrip())


def _units(editor: EditorText, start: int, end: int) -> int:
    return editor.offset_of(end) - editor.offset_of(start)
