"""What the disk did to an open document, as Problems."""

from studio.problems import Place, Problem, Severity


def changed_on_disk(file: str) -> Problem:
    """Somebody else wrote a file that has unsaved edits here."""
    sentence = (
        "This file was changed on disk while it has unsaved edits here: "
        "reload to take the disk's text (undo brings your edits back)."
    )
    return Problem(Severity.WARNING, "changed-on-disk", sentence, Place(file))


def file_gone(file: str) -> Problem:
    """A file was deleted, or can no longer be read."""
    sentence = "This file can no longer be read from disk; its last text is kept here."
    return Problem(Severity.WARNING, "file-gone", sentence, Place(file))
