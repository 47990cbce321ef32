"""FileWatch: notices which of a document's files changed on disk."""

# watchfiles' stub names anyio's events, which name trio's, which is not installed.
# pyright: reportUnknownVariableType=false
from __future__ import annotations

import asyncio
import contextlib
import logging
import time
from pathlib import Path
from typing import TYPE_CHECKING, Final

from watchfiles import awatch

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable, Iterable

_DEBOUNCE_MS: Final = 50
_RETRY_S: Final = 2.0
_STANDS_AFTER_MS: Final = 500
"""A watch that has not failed for so long stands."""
_TICK_NS: Final = 20_000_000
"""A file's time may be so much older than the moment that it was written."""
_LOG = logging.getLogger(__name__)


class FileWatch:
    """Watches the folders of a set of files and reports those of the set that changed.

    Folders are watched rather than files, because editors replace a file instead of writing it.
    `watch` is called after the files were read, so changes since the call before are reported, too,
    even if nothing was watched then; some of them may have been read already.

    When the system refuses to watch, it is tried again every two seconds, and each attempt reports
    the changes until then.

    Args:
        changed: Called with each set of changed files.
        fits: Whether a path that is not of the set is reported, too, when it comes, changes or
            goes; asked for each change in a watched folder.
        troubled: Called with the reason when the system refuses, and "" when it watches again.
    """

    def __init__(
        self,
        changed: Callable[[set[str]], Awaitable[None]],
        fits: Callable[[str], bool] | None = None,
        troubled: Callable[[str], None] = lambda _: None,
    ) -> None:
        self._changed, self._fits, self._troubled = changed, fits, troubled
        self._trouble = ""
        self._files: frozenset[str] = frozenset()
        self._folders: frozenset[str] = frozenset()
        self._beside: frozenset[str] = frozenset()
        self._some_missing = False
        self._seen_until_ns = time.time_ns()
        self._stop = asyncio.Event()
        self._task: asyncio.Task[None] | None = None
        self._catching_up: set[asyncio.Task[None]] = set()

    def watch(self, files: Iterable[str], beside: Iterable[str] = ()) -> None:
        """Watch these files from now on; cheap when their folders stay the same.

        `beside` are more folders, in which files that fit may come.
        """
        wanted, more = frozenset(files), frozenset(beside)
        since_ns, self._seen_until_ns = self._seen_until_ns, time.time_ns()
        if (wanted, more) == (self._files, self._beside) and not self._some_missing:
            return
        self._files, self._beside = wanted, more
        self._watch_folders(wanted, more)
        self._catch_up(since_ns - _TICK_NS)

    def _watch_folders(self, wanted: frozenset[str], more: frozenset[str]) -> None:
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
        tasks = [task for task in (self._task, *self._catching_up) if task]
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)

    def _catch_up(self, since_ns: int) -> None:
        """Report what changed before the watch began, which it does with its task."""

        async def report() -> None:
            paths = self._files | self._beside
            touched = await asyncio.to_thread(_touched, paths, since_ns, time.time_ns())
            if meant := {path for path in touched if self._is_meant(path)}:
                await self._report(meant)

        task = asyncio.create_task(report())
        self._catching_up.add(task)
        task.add_done_callback(self._catching_up.discard)

    async def _run(self, folders: frozenset[str], stop: asyncio.Event) -> None:
        since_ns = time.time_ns()
        while not stop.is_set():
            try:
                await self._watch_until(folders, stop)
            except (OSError, RuntimeError, ExceptionGroup) as error:
                self._take_trouble(str(error) or type(error).__name__)
                self._catch_up(since_ns - _TICK_NS)
                since_ns = time.time_ns()
                with contextlib.suppress(TimeoutError):
                    await asyncio.wait_for(stop.wait(), _RETRY_S)

    async def _watch_until(self, folders: frozenset[str], stop: asyncio.Event) -> None:
        """Report changes until `stop`; raises the system's error when it cannot watch."""
        watched = awatch(
            *folders,
            recursive=False,
            stop_event=stop,
            debounce=_DEBOUNCE_MS,
            yield_on_timeout=bool(self._trouble),
            rust_timeout=_STANDS_AFTER_MS if self._trouble else None,
        )
        async for changes in watched:
            self._take_trouble("")
            touched = {path for _, path in changes if self._is_meant(path)}
            if touched and not stop.is_set():
                await self._report(touched)

    def _take_trouble(self, trouble: str) -> None:
        if trouble != self._trouble:
            self._trouble = trouble
            self._troubled(trouble)

    async def _report(self, paths: set[str]) -> None:
        """Report changes; an error of the callback does not end the watch."""
        try:
            await self._changed(paths)
        except Exception:  # noqa: BLE001 - a bug of ours must not leave the files unwatched
            _LOG.exception("A change on disk was not taken")

    def _is_meant(self, path: str) -> bool:
        return path in self._files or (self._fits is not None and self._fits(path))


def _touched(paths: Iterable[str], since_ns: int, until_ns: int) -> set[str]:
    """Return the paths written or removed in that time."""
    return {path for path in paths if since_ns <= _changed_at_ns(Path(path)) <= until_ns}


def _changed_at_ns(path: Path) -> int:
    """Return when it was last written, or its folder if it does not exist; 0 without either."""
    for one in (path, path.parent):
        with contextlib.suppress(OSError):
            return one.stat().st_mtime_ns
    return 0
