"""Writes files so that nothing a user wrote is ever lost: all are checked, then all are written.

A file is written beside itself, flushed to the disk and renamed over the old one: a reader gets
the old text or the new one. Its mode is kept; a symlink stays and its target is written.
"""

from __future__ import annotations

import contextlib
import os
import stat
from dataclasses import dataclass
from pathlib import Path
from typing import IO, TYPE_CHECKING

from studio.errors import NotSavedError, PackageError, SaveConflictError
from studio.files import is_writable, temporary_beside

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

_WRITE_BITS = stat.S_IWUSR | stat.S_IWGRP | stat.S_IWOTH


@dataclass(frozen=True, slots=True)
class FileToSave:
    """One file to write: as it was opened, as it was read, and its new bytes."""

    file: str
    read: bytes
    data: bytes


@dataclass(frozen=True, slots=True)
class _Checked:
    wanted: FileToSave
    target: Path
    mode: int
    modified_ns: int


def save_files(
    files: Iterable[FileToSave],
    resolve: Callable[[Path], Path],
    may_write: Callable[[Path], bool],
    saved: Callable[[FileToSave], None],
) -> None:
    """Write all files, or none when any of them may not or cannot be written.

    Args:
        files: What to write.
        resolve: Gives a path's real place below the opened folders, or raises.
        may_write: Whether that place may be written.
        saved: Told of each file once it stands on the disk.

    Raises:
        SaveConflictError: A file on disk is no longer the one that was read.
        NotSavedError: A file is read-only, lies in a read-only folder, or the disk refused it.
        OutsideRootsError: A file leads out of the opened folders.
    """
    checked = [_check(one, resolve, may_write) for one in files]
    temporaries: list[Path] = []
    try:
        for one in checked:
            temporaries.append(_write_beside(one))  # noqa: PERF401 - the ones before a fall count
        for one, temporary in zip(checked, temporaries, strict=True):
            _replace(one, temporary)
            saved(one.wanted)
    finally:
        for temporary in temporaries:
            temporary.unlink(missing_ok=True)


def hindrance(
    file: str, read: bytes, resolve: Callable[[Path], Path], may_write: Callable[[Path], bool]
) -> str:
    """Why a file cannot be saved now, in a sentence; empty: it can, as far as is known before."""
    try:
        _check(FileToSave(file, read, read), resolve, may_write)
    except (NotSavedError, SaveConflictError, PackageError) as error:
        return str(error)
    return ""


def write_copy(target: Path, data: bytes) -> None:
    """Write a file that is not there yet, down to the disk.

    Raises:
        NotSavedError: It is there, or the disk refused it; then nothing of it is left.
    """
    try:
        with target.open("xb") as stream:
            _fill(stream, target, data)
    except FileExistsError as error:
        raise NotSavedError(str(target), "such a file is there already; name another") from error
    except OSError as error:
        raise NotSavedError(str(target), error.strerror or "the disk refused it") from error
    _flush_folder(target.parent)


def _fill(stream: IO[bytes], target: Path, data: bytes) -> None:
    try:
        stream.write(data)
        stream.flush()
        os.fsync(stream.fileno())
    except OSError:
        target.unlink(missing_ok=True)
        raise


def _check(
    wanted: FileToSave, resolve: Callable[[Path], Path], may_write: Callable[[Path], bool]
) -> _Checked:
    target = resolve(Path(wanted.file))
    try:
        status = target.stat()
        is_same = stat.S_ISREG(status.st_mode) and target.read_bytes() == wanted.read
    except FileNotFoundError as error:
        raise NotSavedError(
            wanted.file, "it was deleted on disk; put it back or save a copy"
        ) from error
    except OSError as error:
        raise NotSavedError(wanted.file, error.strerror or "it cannot be read") from error
    if not is_same:
        raise SaveConflictError(wanted.file)
    _refuse_read_only(wanted.file, target, allowed=may_write(target))
    return _Checked(wanted, target, stat.S_IMODE(status.st_mode), status.st_mtime_ns)


def _refuse_read_only(file: str, target: Path, *, allowed: bool) -> None:
    # What the system forbids comes first: it also makes that nothing is allowed.
    for path, sentence in (
        (target, "the file is read-only; make it writable first"),
        (target.parent, "its folder is read-only; make it writable first"),
    ):
        # Root may write everything, but a mode without write bits still means "leave it".
        if not path.stat().st_mode & _WRITE_BITS or not is_writable(path):
            raise NotSavedError(file, sentence)
    if not allowed:
        raise NotSavedError(file, "its folder was opened for reading only; save a copy elsewhere")


def _write_beside(one: _Checked) -> Path:
    """Write the new bytes to a temporary file in the same folder, down to the disk."""
    temporary: Path | None = None
    try:
        handle, temporary = temporary_beside(one.target)
        with os.fdopen(handle, "wb") as stream:
            stream.write(one.wanted.data)
            stream.flush()
            os.fsync(stream.fileno())
        _keep_owner_and_mode(one, temporary)
    except OSError as error:
        if temporary is not None:
            temporary.unlink(missing_ok=True)
        raise NotSavedError(one.wanted.file, error.strerror or "the disk refused it") from error
    return temporary


def _keep_owner_and_mode(one: _Checked, temporary: Path) -> None:
    before, now = one.target.stat(), temporary.stat()
    if (before.st_uid, before.st_gid) != (now.st_uid, now.st_gid):
        with contextlib.suppress(OSError, AttributeError):  # only root may give files away
            os.chown(temporary, before.st_uid, before.st_gid)
    temporary.chmod(one.mode)


def _replace(one: _Checked, temporary: Path) -> None:
    try:
        if one.target.stat().st_mtime_ns != one.modified_ns:
            raise SaveConflictError(one.wanted.file)
        temporary.replace(one.target)
    except OSError as error:
        raise NotSavedError(one.wanted.file, error.strerror or "the disk refused it") from error
    _flush_folder(one.target.parent)


def _flush_folder(folder: Path) -> None:
    """Make the rename outlast a power cut, where folders can be flushed."""
    with contextlib.suppress(OSError):
        handle = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)
