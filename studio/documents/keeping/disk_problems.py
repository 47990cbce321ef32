"""What the disk did to an open document, as Problems."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from studio.problems import Fix, Place, Problem, Severity

if TYPE_CHECKING:
    from collections.abc import Sequence


def changed_on_disk(file: str) -> Problem:
    """Somebody else wrote a file in the very places that have unsaved edits here."""
    sentence = (
        "This file was changed on disk where it has unsaved edits: "
        "choose whose text stands (undo brings the other back)."
    )
    fix = Fix("Compare and choose", "resolve_collisions", file)
    return Problem(Severity.WARNING, "changed-on-disk", sentence, Place(file), fix=fix)


def file_gone(file: str) -> Problem:
    """A file was deleted, or can no longer be read."""
    sentence = "This file can no longer be read from disk; its last text is kept here."
    return Problem(Severity.WARNING, "file-gone", sentence, Place(file))


def not_watched(reason: str) -> Problem:
    """The system has no watch left, or no file handle for one."""
    sentence = (
        f"The system does not watch the files of this robot ({reason.rstrip('. ')}), so what other "
        "programs write is seen only every two seconds: close programs that watch many files, or "
        "raise fs.inotify.max_user_instances."
    )
    return Problem(Severity.WARNING, "not-watched", sentence)


def save_cut(written: Sequence[str], missed: Sequence[str]) -> Problem:
    """The studio was ended in the middle of a save: some files are new, others are not."""
    sentence = (
        f"The studio was ended while it saved: {_names(written)} was written, {_names(missed)} was "
        "not, so the files may not fit each other. The edits are here: save them again."
    )
    return Problem(Severity.WARNING, "save-cut-off", sentence, Place(missed[0]))


def _names(files: Sequence[str]) -> str:
    return ", ".join(Path(one).name for one in files)
