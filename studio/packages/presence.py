"""Whether something is there; what may not be looked at, or cannot be named, is not.

`Path.exists` and its like raise where a folder above is closed to us or a name is too long.
"""

from __future__ import annotations

import os
import stat
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path


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


def is_writable(path: Path) -> bool:
    """Whether this process may write a file, or files in a folder."""
    return os.access(path, os.W_OK, effective_ids=os.access in os.supports_effective_ids)


def _mode(path: Path) -> int | None:
    try:
        return os.stat(path).st_mode  # noqa: PTH116 - as `Path.stat`, and twice as fast
    except (OSError, ValueError):
        return None
