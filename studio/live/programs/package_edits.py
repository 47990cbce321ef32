"""PackageEdits: new packages and what is added to them, written to the disk and taken back."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, Final

from studio.errors import CommandError, NotSavedError
from studio.packages.edits.writing import Written, write_edit
from studio.packages.roots import ServedRoots

if TYPE_CHECKING:
    from pathlib import Path

    from studio.packages.edits.package_edit import PackageEdit

KEPT_MAX: Final = 100


class PackageEdits:
    """Keeps the newest edits of packages, so that each can be taken back.

    That is for files as the edit left them: what anybody wrote since is not lost. Undo of a
    document is another thing, which knows texts that are not on the disk yet. Reads and writes the
    disk: for a thread.
    """

    def __init__(self) -> None:
        self._written: dict[int, tuple[str, Written]] = {}
        self._numbers = itertools.count(1)

    def write(self, root: Path, edit: PackageEdit) -> tuple[int, tuple[Path, ...]]:
        """Make new files below `root` and change others; returns a number and those files.

        Raises:
            NotMadeError: A new file is there already, a changed one is another by now, or the disk
                refuses it; nothing was changed.
            PackageError: A file lies elsewhere, or cannot be read.
        """
        written = write_edit(edit, ServedRoots([root]))
        number = next(self._numbers)
        self._written[number] = edit.label, written
        for one in list(self._written)[:-KEPT_MAX]:
            del self._written[one]
        return number, tuple(written.after)

    def undo(self, number: int) -> str:
        """Take an edit back, and return its label.

        Raises:
            CommandError: It is not known any more, or a file was changed since.
            NotSavedError: The disk refuses it.
        """
        label, written = self._written.get(number, ("", None))
        if written is None:
            raise CommandError("That edit cannot be taken back any more: its files are yours.")
        if (path := written.changed_since) is not None:
            raise CommandError(
                f"{path} was changed since, so {label} is not taken back: change it by hand."
            )
        try:
            written.take_back()
        except OSError as error:
            reason = error.strerror or type(error).__name__
            raise NotSavedError(str(error.filename or label), reason) from error
        del self._written[number]
        return label
