"""Edits of values and of problems that have a fix, what a run made of them, and the undo list."""

from __future__ import annotations

from typing import ClassVar, Literal

from pydantic import Field

from studio.description.values import SiteKind, Widget
from studio.problems import Problem
from studio.protocol.message import Command, Event, Message


class EditSite(Command):
    """Write a new text at a site. All edits of one `gesture` are one undo step."""

    type: Literal["edit_site"] = "edit_site"
    site: str
    text: str = Field(max_length=100_000)
    gesture: str = ""


class ResetSite(Command):
    """Put a site back to its text on disk."""

    type: Literal["reset_site"] = "reset_site"
    site: str


class Undo(Command):
    """Take back the last step."""

    type: Literal["undo"] = "undo"


class Redo(Command):
    """Do again what was taken back."""

    type: Literal["redo"] = "redo"


class SiteView(Message):
    """One editable text, as a property row shows it."""

    id: str
    kind: SiteKind
    name: str
    file: str
    line: int
    text: str
    saved_text: str | None
    """The text on disk, when it differs."""
    value: str
    number: float | None
    values: tuple[str, ...]
    reads: int
    widget: Widget
    group: str
    owner: str
    argument: str | None
    """For an arg: the value passed from outside, which wins over the default."""


class Sites(Event):
    """The changed sites, and the order of all when it changed (sites not in it are gone)."""

    type: Literal["sites"] = "sites"
    order: tuple[str, ...] | None
    changed: tuple[SiteView, ...]


class Problems(Event):
    """All present problems. `showing_last_good`: the view is older than the texts."""

    type: Literal["problems"] = "problems"
    problems: tuple[Problem, ...]
    showing_last_good: bool


class History(Event):
    """The undo list, newest last, and what is unsaved."""

    type: Literal["history"] = "history"
    undo: tuple[str, ...]
    redo: tuple[str, ...]
    unsaved_files: tuple[str, ...]
    unsaved_count: int


class Built(Event):
    """A run ended: how long it took from the edit to the scene."""

    is_moment: ClassVar[bool] = True
    type: Literal["built"] = "built"
    ok: bool
    duration_ms: float


class ApplyFix(Command):
    """Make the edits of a problem's fix as one undo step; refused when it is no longer found.

    The three fields name the problem as in `problems`.
    """

    type: Literal["apply_fix"] = "apply_fix"
    code: str = Field(max_length=100)
    sentence: str = Field(max_length=4096)
    label: str = Field(max_length=1000)


class MendAll(Command):
    """Make the edits of every error's and every warning's fix as one undo step.

    Of two that want the same place, the first one's; notes (severity `info`) are left as they are.
    """

    type: Literal["mend_all"] = "mend_all"
