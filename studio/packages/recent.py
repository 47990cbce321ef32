"""The files that were opened last, kept in the data folder."""

from __future__ import annotations

import contextlib
from pathlib import Path
from typing import TYPE_CHECKING, Final

import msgspec

from studio.files import is_there, write_whole
from studio.packages.folder_memory import is_text

if TYPE_CHECKING:
    from collections.abc import Mapping

COUNT_LIMIT: Final = 30
_FILE: Final = "recent.json"
_SIZE_LIMIT_BYTES: Final = 1 << 20


class RecentFile(msgspec.Struct, frozen=True):
    """One opening; `time_s` is Unix time."""

    path: str
    title: str
    time_s: float
    arguments: dict[str, str] = {}


class _Store(msgspec.Struct, frozen=True):
    files: tuple[RecentFile, ...] = ()


class RecentFiles:
    """Newest first, each path once; what cannot be read or written is simply not remembered."""

    def __init__(self, data_folder: Path, name: str = _FILE) -> None:
        self._file = data_folder / name

    def all(self) -> tuple[RecentFile, ...]:
        """Return every entry, also of files that are gone."""
        with contextlib.suppress(OSError, msgspec.MsgspecError):
            if self._file.stat().st_size <= _SIZE_LIMIT_BYTES:
                return msgspec.json.decode(self._file.read_bytes(), type=_Store).files
        return ()

    def find(self, path: str) -> RecentFile | None:
        """Return the entry of a path."""
        return next((one for one in self.all() if one.path == path), None)

    def note(self, path: str, title: str, arguments: Mapping[str, str], time_s: float) -> None:
        """A file was opened."""
        if not is_text(path) or not is_text(title):
            return
        others = [one for one in self.all() if one.path != path]
        newest = RecentFile(path, title, time_s, dict(arguments))
        self._keep((newest, *others)[:COUNT_LIMIT])

    def forget(self, path: str) -> None:
        """Take an entry out of the list; the file stays."""
        self._keep(tuple(one for one in self.all() if one.path != path))

    def _keep(self, files: tuple[RecentFile, ...]) -> None:
        with contextlib.suppress(OSError, msgspec.MsgspecError, UnicodeEncodeError):
            write_whole(self._file, msgspec.json.format(msgspec.json.encode(_Store(files))))


def last_opened(data_folder: Path) -> RecentFile | None:
    """Return the newest entry whose file, or folder, is still there."""
    there = (one for one in RecentFiles(data_folder).all() if is_there(Path(one.path)))
    return next(there, None)
