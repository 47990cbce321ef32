"""PackageEdits: new packages and what is added to them, written to the disk and taken back."""

from __future__ import annotations

import contextlib
import itertools
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from studio.description.editing.edits import edits_of
from studio.errors import CommandError, NotMadeError, NotSavedError, PackageError
from studio.files import is_there, write_whole
from studio.packages.roots import ServedRoots

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from studio.problems import NewFile, Replacement

KEPT_MAX: Final = 100
_LIMIT_BYTES: Final = 4 << 20


@dataclass(frozen=True, slots=True)
class Written:
    """One edit that was written.

    Attributes:
        number: Counts all of this studio.
        before: Bytes of each file before; None: it was not there.
        after: The bytes that were written.
        folders: Folders that were made, the outermost first.
    """

    number: int
    label: str
    before: Mapping[Path, bytes | None]
    after: Mapping[Path, bytes]
    folders: tuple[Path, ...]


class PackageEdits:
    """Writes edits of packages whole or not at all, and takes the newest ones back.

    An edit is taken back only where its files are still as it left them: what anybody wrote since
    is not lost. Reads and writes the disk: for a thread.
    """

    def __init__(self) -> None:
        self._written: dict[int, Written] = {}
        self._numbers = itertools.count(1)

    def write(
        self, root: Path, label: str, new: Sequence[NewFile], replaced: Sequence[Replacement] = ()
    ) -> Written:
        """Make new files below `root` and change others.

        Raises:
            NotMadeError: One of the new files is there already.
            StaleTextError: A file that is to be changed is another one by now.
            NotSavedError: The disk refuses it; nothing was changed.
            PackageError: A file lies elsewhere, or cannot be read.
        """
        served = ServedRoots([root])
        before: dict[Path, bytes | None] = {}
        after: dict[Path, bytes] = {}
        for one in new:
            path = served.resolve(one.file)
            if is_there(path):
                raise NotMadeError(str(path), "there is something of that name: choose another.")
            before[path], after[path] = None, one.text.encode()
        for path, data in _replaced(served, replaced).items():
            before[path], after[path] = served.read(path, _LIMIT_BYTES), data
        return self._write(label, before, after)

    def undo(self, number: int) -> str:
        """Take an edit back, and return its label.

        Raises:
            CommandError: It is not known any more, or a file was changed since.
            NotSavedError: The disk refuses it.
        """
        written = self._written.get(number)
        if written is None:
            raise CommandError("That edit cannot be taken back any more: its files are yours.")
        for path, data in written.after.items():
            if _bytes_of(path) != data:
                raise CommandError(
                    f"{path} was changed since, so {written.label} is not taken back: "
                    "change it by hand."
                )
        for path, data in written.before.items():
            try:
                _put_back(path, data)
            except OSError as error:
                raise NotSavedError(str(path), error.strerror or type(error).__name__) from error
        for folder in reversed(written.folders):
            with contextlib.suppress(OSError):  # somebody put something there
                folder.rmdir()
        del self._written[number]
        return written.label

    def _write(
        self, label: str, before: Mapping[Path, bytes | None], after: Mapping[Path, bytes]
    ) -> Written:
        made: list[Path] = []
        done: list[Path] = []
        for path, data in after.items():
            try:
                made += _make_folders(path.parent)
                write_whole(path, data, mode=_mode_of(path))
            except OSError as error:
                for one in done:
                    with contextlib.suppress(OSError):
                        _put_back(one, before[one])
                for folder in reversed(made):
                    with contextlib.suppress(OSError):
                        folder.rmdir()
                raise NotSavedError(str(path), error.strerror or type(error).__name__) from error
            done.append(path)
        return self._keep(label, before, after, tuple(made))

    def _keep(
        self,
        label: str,
        before: Mapping[Path, bytes | None],
        after: Mapping[Path, bytes],
        folders: tuple[Path, ...],
    ) -> Written:
        written = Written(next(self._numbers), label, before, after, folders)
        self._written[written.number] = written
        for number in list(self._written)[:-KEPT_MAX]:
            del self._written[number]
        return written


def _replaced(served: ServedRoots, replaced: Sequence[Replacement]) -> dict[Path, bytes]:
    """Return the bytes of each file with its replacements made."""
    texts: dict[str, bytes] = {}

    def text_of(file: str) -> bytes:
        if file not in texts:
            texts[file] = served.read(file, _LIMIT_BYTES)
        return texts[file]

    changed: dict[str, bytearray] = {}
    for edit in edits_of(replaced, text_of):
        text = changed.setdefault(edit.file, bytearray(text_of(edit.file)))
        text[edit.start : edit.end] = edit.new
    return {served.resolve(file): bytes(text) for file, text in changed.items()}


def _put_back(path: Path, data: bytes | None) -> None:
    """Write the bytes that a file had; None: it was not there."""
    if data is None:
        path.unlink()
    else:
        write_whole(path, data, mode=_mode_of(path))


def _make_folders(folder: Path) -> list[Path]:
    missing = [one for one in (folder, *folder.parents) if not one.exists()]
    for one in reversed(missing):
        one.mkdir()
    return missing[::-1]


def _mode_of(path: Path) -> int | None:
    """Return the permissions of a file that is there: those of a script stay."""
    try:
        return path.stat().st_mode & 0o777
    except OSError:
        return None


def _bytes_of(path: Path) -> bytes | None:
    try:
        return ServedRoots([path]).read(path, _LIMIT_BYTES)
    except PackageError:
        return None
