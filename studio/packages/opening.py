"""Opens a file below a folder without following a link, whoever renames what meanwhile."""

from __future__ import annotations

import os
import stat
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from pathlib import Path

# O_NONBLOCK: a pipe that took the file's place must not hang us. Windows lacks some of these.
_FILE_FLAGS: Final = (
    os.O_RDONLY
    | getattr(os, "O_NONBLOCK", 0)
    | getattr(os, "O_NOFOLLOW", 0)
    | getattr(os, "O_CLOEXEC", 0)
    | getattr(os, "O_BINARY", 0)
)
_FOLDER_FLAGS: Final = _FILE_FLAGS | getattr(os, "O_DIRECTORY", 0)
_CAN_WALK: Final = os.open in os.supports_dir_fd and hasattr(os, "O_NOFOLLOW")


class NotRegularError(OSError):
    """What stands under the name is a folder, pipe, device or socket."""


def open_regular(root: Path, resolved: Path) -> int:
    """Open a file at or below `root`; both are resolved. Returns the descriptor.

    Each folder on the way is opened from the one before it and must not be a link: comparing
    paths before and after is not enough, as a folder can be swapped between any two looks.

    Raises:
        NotRegularError: It is no regular file.
        OSError: It cannot be opened, or a link stands on the way now.
    """
    descriptor = _walk(root, resolved) if _CAN_WALK else os.open(resolved, _FILE_FLAGS)
    if stat.S_ISREG(os.fstat(descriptor).st_mode):
        return descriptor
    os.close(descriptor)
    raise NotRegularError


def _walk(root: Path, resolved: Path) -> int:
    top = root.parent if root == resolved else root
    *folders, name = resolved.relative_to(top).parts
    folder = os.open(top, _FOLDER_FLAGS)
    try:
        for step in folders:
            inner = os.open(step, _FOLDER_FLAGS, dir_fd=folder)
            os.close(folder)
            folder = inner
        # Opening a device may already act on it, so look first.
        if not stat.S_ISREG(os.stat(name, dir_fd=folder, follow_symlinks=False).st_mode):
            raise NotRegularError
        return os.open(name, _FILE_FLAGS, dir_fd=folder)
    finally:
        os.close(folder)
