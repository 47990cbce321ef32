"""Writes an edit of a package to the disk, all of it or nothing, and takes it back."""

from __future__ import annotations

import contextlib
from dataclasses import dataclass
from typing import TYPE_CHECKING

from studio.errors import NotMadeError, PackageError
from studio.files import is_there, write_whole
from studio.packages.roots import ServedRoots
from studio.packages.sources.spans import with_replacements

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from studio.packages.edits.package_edit import PackageEdit


@dataclass(frozen=True, slots=True)
class Written:
    """What an edit did."""

    before: Mapping[Path, bytes | None]
    """Bytes of each file before; None: it was not there."""
    after: Mapping[Path, bytes]
    """The bytes that were written, the new files first."""
    folders: tuple[Path, ...]
    """Folders that were made, the outermost first."""

    @property
    def changed_since(self) -> Path | None:
        """A file that is no longer as it was written, if there is one."""
        return next((path for path, data in self.after.items() if _bytes_of(path) != data), None)

    def take_back(self) -> None:
        """Put all back as it was before; a folder stays where somebody put something into it.

        Raises:
            OSError: The disk refuses it.
        """
        for path, data in self.before.items():
            if data is None:
                path.unlink(missing_ok=True)
            else:
                _write_over(path, data)
        for folder in reversed(self.folders):
            with contextlib.suppress(OSError):
                folder.rmdir()


def write_edit(edit: PackageEdit, roots: ServedRoots) -> Written:
    """Write new and changed files below the served folders.

    Raises:
        NotMadeError: A new file is there already, a changed one is not as it was, or the system
            refused; nothing was changed.
        PackageError: A file lies elsewhere, or cannot be read.
    """
    before: dict[Path, bytes | None] = {}
    after: dict[Path, bytes] = {}
    for new in edit.new_files:
        path = roots.resolve(new.file)
        if is_there(path):
            raise NotMadeError(str(path), "it is there already: choose another name.")
        before[path], after[path] = None, new.text.encode()
    for path, data in _changed(edit, roots).items():
        before[path], after[path] = roots.read(path), data
    folders: list[Path] = []
    done: dict[Path, bytes | None] = {}
    for path, data in after.items():
        try:
            _make_folders(path.parent, folders)
            if before[path] is None:
                with path.open("xb") as opened:
                    done[path] = None
                    opened.write(data)
            else:
                _write_over(path, data)
                done[path] = before[path]
        except OSError as error:
            with contextlib.suppress(OSError):
                Written(done, {}, tuple(folders)).take_back()
            reason = f"the system refused ({error.strerror or type(error).__name__})."
            raise NotMadeError(str(path), reason) from error
    return Written(before, after, tuple(folders))


def _changed(edit: PackageEdit, roots: ServedRoots) -> dict[Path, bytes]:
    """Return the new bytes of each file that changes."""
    found: dict[Path, bytes] = {}
    for file in dict.fromkeys(one.file for one in edit.edits):
        path = roots.resolve(file)
        changes = [one for one in edit.edits if one.file == file]
        try:
            found[path] = with_replacements(roots.read(path), changes)
        except ValueError:
            raise NotMadeError(file, "it has changed meanwhile: try again.") from None
    return found


def _write_over(path: Path, data: bytes) -> None:
    """Write a file that is there; its permissions stay."""
    write_whole(path, data, mode=path.stat().st_mode & 0o777)


def _make_folders(folder: Path, made: list[Path]) -> None:
    """Make a folder and those above it, and note each that was made, the outermost first."""
    missing = [one for one in (folder, *folder.parents) if not one.exists()]
    for one in reversed(missing):
        one.mkdir()
        made.append(one)


def _bytes_of(path: Path) -> bytes | None:
    try:
        return ServedRoots([path]).read(path)
    except PackageError:
        return None
