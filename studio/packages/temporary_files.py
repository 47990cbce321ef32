"""Files that stand beside another for the moment of its writing, and what a killed studio left."""

from __future__ import annotations

import contextlib
import os
import re
import tempfile
import time
from pathlib import Path
from typing import TYPE_CHECKING, Final

from studio.system import is_running

if TYPE_CHECKING:
    from collections.abc import Iterable

_NAME_KEPT: Final = 100
"""Characters of the other file's name; a folder takes no name of more than 255 bytes."""
_LEFT_AFTER_S: Final = 600.0
"""No writing takes so long; where it cannot be told whether its process still runs, age tells."""
_OURS: Final = re.compile(r"\..*\.studio-(\d{1,10})-[a-z0-9_]{8}\.tmp", re.DOTALL)
_EARLIER: Final = re.compile(r"\..+\.[a-z0-9_]{8}\.tmp", re.DOTALL)
"""As the studio named them before; other programs may do so, too: these are never removed."""


def temporary_beside(target: Path) -> tuple[int, Path]:
    """Make and open a file in the folder of `target`, to be renamed over it.

    Raises:
        OSError: The disk refuses it.
    """
    prefix = f".{target.name[:_NAME_KEPT]}.studio-{os.getpid()}-"
    handle, name = tempfile.mkstemp(prefix=prefix, suffix=".tmp", dir=target.parent)
    return handle, Path(name)


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
