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
