"""Messages about the files on disk: saving, reading again, and edits that collide."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from studio.protocol.message import Command, Event, Message


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
    """Where a file's unsaved edits collide with what another program wrote."""

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
    """Of the `collisions` that were looked at; refused when they are others now."""


class DiskMerged(Event):
    """Another program wrote a file; its changes are taken, and so many edits are kept unsaved."""

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

    type: Literal["saved"] = "saved"
    files: tuple[str, ...]
