"""What the disk did to an open document, as Problems."""

from studio.problems import Fix, Place, Problem, Severity


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
