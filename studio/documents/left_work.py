"""Unsaved work of files that are not open: what an earlier run left, offered to presenters."""

from __future__ import annotations

import asyncio
from pathlib import Path
from typing import TYPE_CHECKING

from studio.debounce import Throttle
from studio.documents.draft_files import forget_drafts, left_drafts
from studio.files import is_file
from studio.protocol.listeners import send
from studio.protocol.roles import Role
from studio.protocol.saving import LeftWork, LeftWorkEntry

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.packages.roots import ServedRoots
    from studio.protocol.listeners import Listener


class LeftDrafts:
    """Finds drafts of served files that no document holds, and reports them to presenters.

    Args:
        served: The folders that are served now.
        data_folder: The folder of the drafts.
    """

    def __init__(self, served: Callable[[], ServedRoots], data_folder: Path) -> None:
        self._served, self._data_folder = served, data_folder
        self._presenters: set[Listener] = set()
        self._latest: LeftWork | None = None
        self._throttle = Throttle(self._refresh)

    def attach(self, listener: Listener) -> None:
        """Send a presenter the list, now and whenever it changes."""
        if listener.role is Role.PRESENTER:
            self._presenters.add(listener)
            if self._latest is not None:
                send(listener, self._latest)

    def detach(self, listener: Listener) -> None:
        """Forget it; it need not be there."""
        self._presenters.discard(listener)

    def trigger(self) -> None:
        """Search again soon: documents were opened or closed."""
        self._throttle.trigger()

    async def forget(self, path: str) -> None:
        """Give the work on a served file up.

        Raises:
            PackageError: The file is not served.
        """
        file = self._served().resolve(Path(path))
        await asyncio.to_thread(forget_drafts, self._data_folder, [file])
        await self._refresh()

    async def close(self) -> None:
        """End what runs for it."""
        await self._throttle.close()

    async def _refresh(self) -> None:
        left = await asyncio.to_thread(_left_work, self._data_folder, self._served())
        if left != (self._latest or LeftWork(entries=())):
            self._latest = left
            for listener in tuple(self._presenters):
                send(listener, left)


def _left_work(data_folder: Path, served: ServedRoots) -> LeftWork:
    entries = (
        LeftWorkEntry(path=one.entry, title=Path(one.entry).name, at=one.at)
        for one in left_drafts(data_folder)
        if served.serves(one.entry) and is_file(Path(one.entry))
    )
    return LeftWork(entries=tuple(entries))
