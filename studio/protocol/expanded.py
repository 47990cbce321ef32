"""Messages about what the edits make of the expanded URDF."""

from __future__ import annotations

from typing import Literal

from studio.protocol.diff_lines import DiffLineView
from studio.protocol.message import Command, Event


class GetUrdfChanges(Command):
    """What of the URDF is otherwise than the files on disk make it, opened as the document was."""

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
