"""The texts of a document: read, edited, renamed, searched; and its expanded URDF."""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING, ClassVar, Literal

from pydantic import Field

from studio.description.language.questions import SubjectKind, TextPlace
from studio.protocol.language import PlaceCommand
from studio.protocol.message import OFFSET_LIMIT, Command, Event, Message

if TYPE_CHECKING:
    from studio.description.editing.line_diff import LineDiff


class GetText(Command):
    """Ask for the text of a file as it is edited; `texts_changed` follows its changes."""

    type: Literal["get_text"] = "get_text"
    file: str = Field(max_length=4096)


class TextChange(Message):
    """Replace [start, end) of the text before by `text`.

    The text is as an editor holds it: no byte order mark, every line break one LF. Offsets are
    UTF-16 code units from 0.
    """

    start: int = Field(ge=0, le=OFFSET_LIMIT)
    end: int = Field(ge=0, le=OFFSET_LIMIT)
    text: str = Field(max_length=4_194_304)


class EditText(Command):
    """Edit a file's text; refused when its version is no longer this one.

    The changes are in order, none overlapping, each with offsets in the text before all of them.
    All edits of one `gesture` are one undo step. `origin`, chosen by the browser, comes back in
    their `texts_changed`, so that it recognises its own.
    """

    type: Literal["edit_text"] = "edit_text"
    file: str = Field(max_length=4096)
    version: int = Field(ge=0, le=OFFSET_LIMIT)
    changes: tuple[TextChange, ...] = Field(min_length=1, max_length=5000)
    gesture: str = Field(default="", max_length=100)
    origin: str = Field(default="", max_length=100)


class Text(Event):
    """Answer to `get_text`: the text at a version, as `TextChange` describes texts."""

    type: Literal["text"] = "text"
    request: int
    file: str
    """As the studio names it, which may differ from the name in the command."""
    version: int
    text: str
    saved: str | None
    """The text on disk, where it is another one."""
    read_only: str
    """Why it may not be edited, a sentence; empty: it may."""


class TextsChanged(Event):
    """A text that was asked for changed, by an edit or otherwise; it now has this version."""

    is_moment: ClassVar[bool] = True
    type: Literal["texts_changed"] = "texts_changed"
    file: str
    version: int
    changes: tuple[TextChange, ...]
    origin: str
    """Of the `edit_text` behind it; empty: there was none."""


class GetUrdf(Command):
    """The expanded URDF of the last good run."""

    type: Literal["get_urdf"] = "get_urdf"


class Urdf(Event):
    """Answer to `get_urdf`."""

    type: Literal["urdf"] = "urdf"
    request: int
    text: str


class GetRenaming(PlaceCommand):
    """Ask for the changes that a renaming to `name` would make."""

    type: Literal["get_renaming"] = "get_renaming"
    name: str = Field(max_length=200)


class Rename(PlaceCommand):
    """Change the name at a place to `name`, wherever it is used, as one undo step.

    Refused when the number of places is no longer `count`, the one in `renaming`.
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
    """Whether the last run evaluated the place; else it was found in the text alone."""


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


class TextSearch(Command):
    """A text to find in the files of the robot; plain, not a pattern."""

    text: str = Field(min_length=1, max_length=1000)
    match_case: bool = False
    whole_word: bool = False


class FindTexts(TextSearch):
    """Ask for the places of a text in the files of the robot."""

    type: Literal["find_texts"] = "find_texts"


class TextsFound(Event):
    """Answer to `find_texts`: the first of `count` places, in `files` files."""

    type: Literal["texts_found"] = "texts_found"
    request: int
    places: tuple[FoundText, ...]
    count: int
    files: int


class ReplaceTexts(TextSearch):
    """Write `replacement` at all places of a text, as one undo step.

    Refused when the number of places is no longer `count`, the one in `texts_found`.
    """

    type: Literal["replace_texts"] = "replace_texts"
    replacement: str = Field(max_length=1000)
    count: int = Field(ge=1, le=1 << 20)


class DiffLineView(Message):
    """A line with its numbers from 1 in the text before and after, where it is in them."""

    kind: Literal["same", "old", "new"]
    before: int | None
    after: int | None
    text: str


def hunk_views(diff: LineDiff) -> tuple[tuple[DiffLineView, ...], ...]:
    """Return the stretches of lines of a difference."""
    return tuple(tuple(DiffLineView(**asdict(line)) for line in hunk) for hunk in diff.hunks)


class GetUrdfChanges(Command):
    """Ask for the differences between the present URDF and that of the files on disk."""

    type: Literal["get_urdf_changes"] = "get_urdf_changes"


class UrdfChanges(Event):
    """Answer to `get_urdf_changes`: stretches of lines with a few around each."""

    type: Literal["urdf_changes"] = "urdf_changes"
    request: int
    added: int
    removed: int
    hunks: tuple[tuple[DiffLineView, ...], ...]
    left_out: int
    """Lines of further stretches that are not among them."""
    fault: str
    """Why the files on disk make no URDF, a sentence; empty: they do."""
