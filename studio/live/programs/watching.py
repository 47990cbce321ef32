"""FolderWatch: notices which files below some folders are written, those that builds make aside."""

# watchfiles' stub names anyio's events, which name trio's, which is not installed.
# pyright: reportUnknownVariableType=false
from __future__ import annotations

import asyncio
import logging
from pathlib import Path
from typing import TYPE_CHECKING, Final

from watchfiles import DefaultFilter, awatch

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from watchfiles import Change

_DEBOUNCE_MS: Final = 100
_RETRY_S: Final = 5.0
_ASIDE: Final = ("build", "install", "log", ".ruff_cache", ".vscode", ".cache")
_LOG: Final = logging.getLogger(__name__)


class _Filter(DefaultFilter):
    """Lets files of sources through: nothing that a build, git or Python writes beside them."""

    def __init__(self, roots: Iterable[Path]) -> None:
        super().__init__(ignore_dirs=(*DefaultFilter.ignore_dirs, *_ASIDE))
        self._roots = tuple(map(str, roots))

    def __call__(self, change: Change, path: str) -> bool:
        # A workspace may itself lie below a folder called `build`.
        root = next((one for one in self._roots if path.startswith(one)), "")
        return super().__call__(change, path.removeprefix(root)) and not path.endswith(".tmp")


class FolderWatch:
    """Watches folders with all that is below; where the system refuses, it is tried again.

    Args:
        changed: Called with the files that were written, made or removed.
    """

    def __init__(self, changed: Callable[[set[Path]], object]) -> None:
        self._changed = changed
        self._folders: tuple[Path, ...] = ()
        self._stop = asyncio.Event()
        self._task: asyncio.Task[None] | None = None

    def watch(self, folders: Iterable[Path]) -> None:
        """Watch these from now on, and no others; cheap when they are the same."""
        wanted = tuple(sorted(set(folders)))
        if wanted == self._folders:
            return
        self._folders = wanted
        self._stop.set()
        self._stop = asyncio.Event()
        self._task = asyncio.create_task(self._run(wanted, self._stop)) if wanted else None

    async def close(self) -> None:
        """End the watch."""
        self._stop.set()
        if self._task is not None:
            self._task.cancel()
            await asyncio.gather(self._task, return_exceptions=True)

    async def _run(self, folders: tuple[Path, ...], stop: asyncio.Event) -> None:
        while not stop.is_set():
            there = [one for one in folders if one.is_dir()]
            try:
                watched = awatch(
                    *there,
                    watch_filter=_Filter(there),
                    stop_event=stop,
                    debounce=_DEBOUNCE_MS,
                    step=50,
                    ignore_permission_denied=True,
                )
                async for changes in watched:
                    self._changed({Path(path) for _, path in changes})
            except (OSError, RuntimeError, ExceptionGroup) as error:
                _LOG.warning("The files of the workspace are not watched (%s).", error)
                await asyncio.sleep(_RETRY_S)
