"""Messages that look for words in all texts of a robot, and write others in their place."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from studio.description.language.questions import SubjectKind, TextPlace
from studio.protocol.language import PlaceCommand
from studio.protocol.message import Command, Event, Message


class GetRenaming(PlaceCommand):
    """What would change if what stands there were called `name`."""

    type: Literal["get_renaming"] = "get_renaming"
    name: str = Field(max_length=200)


class Rename(PlaceCommand):
    """Call what stands there `name`, wherever it is named, as one undo step.

    Refused when `count`, the number of places that `renaming` told, is another one by now.
    """

    type: Literal["rename"] = "rename"
    name: str = Field(max_length=200)
    count: int = Field(ge=1, le=1 << 20)


class FoundText(Message):
    """A place, and what stands in its line from `line_column` (from 1) on."""

    place: TextPlace
    line: str
    line_column: int = 1
    in_run: bool = True
    """The run came by; else it is told from the text alone."""


class RenamingAnswer(Event):
    """Answer to `get_renaming`: the first of `count` places, in `files` files."""

    type: Literal["renaming"] = "renaming"
    request: int
    kind: SubjectKind
    old: str
    new: str
    places: tuple[FoundText, ...]
    count: int
    files: int


class WordsCommand(Command):
    """Something about words in the files of the robot; they are plain words, no pattern."""

    text: str = Field(min_length=1, max_length=1000)
    match_case: bool = False
    whole_word: bool = False


class FindTexts(WordsCommand):
    """Where some words stand in the files of the robot."""

    type: Literal["find_texts"] = "find_texts"


class TextsFound(Event):
    """Answer to `find_texts`: the first of `count` places, in `files` files."""

    type: Literal["texts_found"] = "texts_found"
    request: int
    places: tuple[FoundText, ...]
    count: int
    files: int


class ReplaceTexts(WordsCommand):
    """Write `replacement` wherever the words are found, as one undo step.

    Refused when `count`, the number of places that `texts_found` told, is another one by now.
    """

    type: Literal["replace_texts"] = "replace_texts"
    replacement: str = Field(max_length=1000)
    count: int = Field(ge=1, le=1 << 20)
