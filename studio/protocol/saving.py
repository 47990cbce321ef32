"""Saving and reloading: what differs from the disk, what collides with it, and restored drafts."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from pydantic import Field

from studio.protocol.message import Command, Event, Message
from studio.protocol.texts import DiffLineView


class Save(Command):
    """Write the edited bytes of these changed files of the document, or of all."""

    type: Literal["save"] = "save"
    files: tuple[Annotated[str, Field(max_length=4096)], ...] | None = Field(
        default=None, max_length=10_000
    )


class Reload(Command):
    """Read all files of the document from disk again; unsaved edits are given up."""

    type: Literal["reload"] = "reload"


class GetCollisions(Command):
    """Ask where a file's unsaved edits collide with what another program wrote."""

    type: Literal["get_collisions"] = "get_collisions"
    file: str = Field(max_length=4096)


class ResolveCollisions(Command):
    """Take a file's changes on disk; where they collide with unsaved edits, one side's.

    `each` chooses place by place for the first ones, `keep` for those beyond them.
    """

    type: Literal["resolve_collisions"] = "resolve_collisions"
    file: str = Field(max_length=4096)
    keep: Literal["mine", "theirs"]
    each: tuple[Literal["mine", "theirs"], ...] = Field(default=(), max_length=1000)
    state: str = Field(default="", max_length=100)
    """State of the `collisions` shown to the user; refused when they are others now."""


class DiskMerged(Event):
    """Another program wrote a file: its changes were taken, and so many edits are kept unsaved."""

    is_moment: ClassVar[bool] = True
    type: Literal["disk_merged"] = "disk_merged"
    file: str
    kept: int


class CollisionView(Message):
    """Whole lines that were edited here and changed on disk; `line` counts from 1 in the base."""

    line: int
    base: str
    mine: str
    theirs: str


class Collisions(Event):
    """Answer to `get_collisions`: the first of `count` places."""

    type: Literal["collisions"] = "collisions"
    request: int
    file: str
    places: tuple[CollisionView, ...]
    count: int
    state: str
    """Changes with what collides."""


class Saved(Event):
    """These files were written."""

    is_moment: ClassVar[bool] = True
    type: Literal["saved"] = "saved"
    files: tuple[str, ...]


class UndoTo(Command):
    """Undo, or redo, until this many steps are done; refused when the list is no longer `of`."""

    type: Literal["undo_to"] = "undo_to"
    position: int = Field(ge=0, le=1 << 20)
    of: int = Field(ge=0, le=1 << 20)
    """Number of all steps, done and undone, when the command was sent."""


class GetChanges(Command):
    """Ask what saving would change, file by file."""

    type: Literal["get_changes"] = "get_changes"


class FileChanges(Message):
    """One file that has unsaved edits."""

    file: str
    added: int
    removed: int
    hunks: tuple[tuple[DiffLineView, ...], ...]
    left_out: int
    """Lines that differ, too, and are not among the hunks."""
    hindrance: str
    """Why it cannot be saved, a sentence; empty: it can."""


class Changes(Event):
    """Answer to `get_changes`."""

    type: Literal["changes"] = "changes"
    request: int
    files: tuple[FileChanges, ...]
    copies: str
    """A folder that copies can be saved in; empty: there is none."""


class SaveCopy(Command):
    """Write a file's edited text to a path below the opened folders at which nothing is yet."""

    type: Literal["save_copy"] = "save_copy"
    file: str = Field(max_length=4096)
    path: str = Field(max_length=4096)


class DiscardRestored(Command):
    """Give up what was restored at the opening; undo brings it back."""

    type: Literal["discard_restored"] = "discard_restored"


class ForgetWork(Command):
    """Give up the unsaved work on a file that is not open."""

    type: Literal["forget_work"] = "forget_work"
    path: str = Field(max_length=4096)


class LeftWorkEntry(Message):
    """Unsaved work on one file; `at` is UTC, as ISO 8601."""

    path: str
    title: str
    at: str


class LeftWork(Event):
    """Files below the served folders that are not open, and have unsaved work of an earlier run."""

    type: Literal["left_work"] = "left_work"
    entries: tuple[LeftWorkEntry, ...]


class Restored(Event):
    """Edits of an earlier run were restored; `at` empty: nothing to report any more."""

    type: Literal["restored"] = "restored"
    at: str
    """When they were kept: UTC, as ISO 8601."""
    files: tuple[str, ...]
