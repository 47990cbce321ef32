"""Which of a document's files changed on disk, as soon as they did."""

# watchfiles' stub names anyio's events, which name trio's, which is not installed.
# pyright: reportUnknownVariableType=false
from __future__ import annotations

import asyncio
import contextlib
from pathlib import Path
from typing import TYPE_CHECKING

from watchfiles import awatch

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable, Iterable

_DEBOUNCE_MS = 50


class FileWatch:
    """Watches the folders of a set of files and reports those of the set that changed.

    Folders are watched rather than files, because editors replace a file instead of writing it.

    Args:
        changed: Told of each bundle of changes.
        fits: Whether a path that is not of the set is reported, too, when it comes, changes or
            goes; asked for each change in a watched folder.
    """

    def __init__(
        self,
        changed: Callable[[set[str]], Awaitable[None]],
        fits: Callable[[str], bool] | None = None,
    ) -> None:
        self._changed, self._fits = changed, fits
        self._files: frozenset[str] = frozenset()
        self._folders: frozenset[str] = frozenset()
        self._beside: frozenset[str] = frozenset()
        self._some_missing = False
        self._stop = asyncio.Event()
        self._task: asyncio.Task[None] | None = None

    def watch(self, files: Iterable[str], beside: Iterable[str] = ()) -> None:
        """Watch these files from now on; cheap when their folders stay the same.

        `beside` are more folders, in which files that fit may come.
        """
        wanted, more = frozenset(files), frozenset(beside)
        if (wanted, more) == (self._files, self._beside) and not self._some_missing:
            return
        self._files, self._beside = wanted, more
        parents = {Path(file).parent for file in wanted} | {Path(folder) for folder in more}
        folders = frozenset(str(folder) for folder in parents if folder.is_dir())
        self._some_missing = len(folders) < len(parents)
        if folders == self._folders:
            return
        self._folders = folders
        self._stop.set()
        self._stop = asyncio.Event()
        self._task = asyncio.create_task(self._run(folders, self._stop)) if folders else None

    async def close(self) -> None:
        """End the watch."""
        self._stop.set()
        if self._task:
            self._task.cancel()
            with contextlib.suppress(asyncio.CancelledError):
                await self._task

    async def _run(self, folders: frozenset[str], stop: asyncio.Event) -> None:
        watched = awatch(*folders, recursive=False, stop_event=stop, debounce=_DEBOUNCE_MS)
        async for changes in watched:
            touched = {path for _, path in changes if self._is_meant(path)}
            if touched and not stop.is_set():
                await self._changed(touched)

    def _is_meant(self, path: str) -> bool:
        return path in self._files or (self._fits is not None and self._fits(path))
