"""Files of the disk: written whole or not at all, and whether something is there.

`Path.exists` and its like raise where a folder above is closed to us or a name is too long; here
such a path leads to nothing.
"""

from __future__ import annotations

import contextlib
import os
import re
import secrets
import stat
import time
from pathlib import Path
from typing import TYPE_CHECKING, Final, TypeAlias

from studio.system import is_running

if TYPE_CHECKING:
    from collections.abc import Iterable

_NAME_KEPT: Final = 100
"""Characters of the other file's name; a folder takes no name of more than 255 bytes."""
_LEFT_AFTER_S: Final = 600.0
"""Writing is over by then, where it is unknown whether its process still runs."""
_OURS: Final = re.compile(r"\..*\.studio-(\d{1,10})-[a-z0-9_]{8}\.tmp", re.DOTALL)
_EARLIER: Final = re.compile(r"\..+\.[a-z0-9_]{8}\.tmp", re.DOTALL)
"""The studio's former names; other programs may use them, so these are never removed."""
LFS_REASON: Final = (
    'is a Git LFS pointer: its content was not fetched, run "git lfs pull" in the repository.'
)
_BEGINNING: Final = b"version https://git-lfs.github.com/spec/"
_LENGTH_LIMIT: Final = 1024
"""Source: the specification of Git LFS, docs/spec.md."""
Stamp: TypeAlias = tuple[int, int, int]
"""Time of the last change, size and inode: one that is saved by rename is another file, even if its
time and its size are the same."""


def write_whole(target: Path, data: bytes, *, mode: int | None = None, flush: bool = False) -> None:
    """Put these bytes in the place of a file, or of none; a symlink there is replaced.

    Args:
        target: The file; its folder has to be there.
        data: All of its bytes.
        mode: Its permissions; None: those of any new file.
        flush: Whether they are on the disk itself when this returns.

    Raises:
        OSError: The disk refuses it; what was there before is still there.
    """
    handle, temporary = temporary_beside(target, 0o666 if mode is None else 0o600)
    try:
        with os.fdopen(handle, "wb") as stream:
            stream.write(data)
            if flush:
                stream.flush()
                os.fsync(stream.fileno())
        if mode is not None:
            temporary.chmod(mode)
        temporary.replace(target)
    except OSError:
        with contextlib.suppress(OSError):
            temporary.unlink(missing_ok=True)
        raise


def temporary_beside(target: Path, mode: int = 0o600) -> tuple[int, Path]:
    """Make and open a file in the folder of `target`, to be renamed over it.

    Args:
        target: The file that it will be.
        mode: Its permissions, as far as the system gives them to a new file.

    Raises:
        OSError: The disk refuses it.
    """
    name = f".{target.name[:_NAME_KEPT]}.studio-{os.getpid()}-{secrets.token_hex(4)}.tmp"
    path = target.with_name(name)
    flags = os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0)
    return os.open(path, flags, mode), path


def is_temporary(name: str) -> bool:
    """Whether a file of that name stands for a moment only, or was left by a killed studio."""
    return bool(_OURS.fullmatch(name) or _EARLIER.fullmatch(name))


def sweep(folders: Iterable[Path]) -> None:
    """Remove what studios that run no more left in these folders."""
    for folder in folders:
        with contextlib.suppress(OSError), os.scandir(folder) as entries:
            for entry in entries:
                if _is_left(entry):
                    Path(entry.path).unlink(missing_ok=True)


def _is_left(entry: os.DirEntry[str]) -> bool:
    found = _OURS.fullmatch(entry.name)
    if found is None or not entry.is_file(follow_symlinks=False):
        return False
    written_s = entry.stat(follow_symlinks=False).st_mtime
    age_s = time.time() - written_s  # noqa: TID251 - files have no other clock
    return age_s > _LEFT_AFTER_S or not is_running(int(found[1]))


def is_there(path: Path) -> bool:
    """Whether a path leads to anything, links followed."""
    return _mode(path) is not None


def is_file(path: Path) -> bool:
    """Whether a path leads to a regular file."""
    mode = _mode(path)
    return mode is not None and stat.S_ISREG(mode)


def is_folder(path: Path) -> bool:
    """Whether a path leads to a folder."""
    mode = _mode(path)
    return mode is not None and stat.S_ISDIR(mode)


def stamp_of(path: Path | str) -> Stamp | None:
    """Return by which signs a change of a file is noticed; None: it is not there."""
    try:
        about = os.stat(path)  # noqa: PTH116 - of hundreds of files, each second
    except (OSError, ValueError):
        return None
    return about.st_mtime_ns, about.st_size, about.st_ino


def is_writable(path: Path) -> bool:
    """Whether this process may write a file, or files in a folder."""
    return os.access(path, os.W_OK, effective_ids=os.access in os.supports_effective_ids)


def _mode(path: Path) -> int | None:
    try:
        return os.stat(path).st_mode  # noqa: PTH116 - as `Path.stat`, and twice as fast
    except (OSError, ValueError):
        return None


def is_lfs_pointer(data: bytes) -> bool:
    """Whether a file's whole content is a pointer."""
    return len(data) < _LENGTH_LIMIT and data.startswith(_BEGINNING)
