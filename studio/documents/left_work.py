"""Unsaved work of files that are not open: what an earlier run left, offered to presenters."""

from __future__ import annotations

import asyncio
from pathlib import Path
from typing import TYPE_CHECKING

from studio.debounce import Throttle
from studio.documents.draft_files import forget_drafts, left_drafts
from studio.files import is_file
from studio.protocol.listeners import tell
from studio.protocol.roles import Role
from studio.protocol.saving import LeftWork, LeftWorkEntry

if TYPE_CHECKING:
    from studio.documents.engine import Engine
    from studio.packages.roots import ServedRoots
    from studio.protocol.listeners import Listener


class LeftDrafts:
    """Looks for drafts of served files that nobody holds, and tells the presenters of them."""

    def __init__(self, engine: Engine, data_folder: Path) -> None:
        self._engine, self._data_folder = engine, data_folder
        self._presenters: set[Listener] = set()
        self._told: LeftWork | None = None
        self._throttle = Throttle(self._look)

    def attach(self, listener: Listener) -> None:
        """Let a presenter hear of it, now and whenever it changes."""
        if listener.role is Role.PRESENTER:
            self._presenters.add(listener)
            if self._told is not None:
                tell(listener, self._told)

    def detach(self, listener: Listener) -> None:
        """Forget it; it need not be there."""
        self._presenters.discard(listener)

    def doubt(self) -> None:
        """Documents were opened or closed: look again, beside."""
        self._throttle.trigger()

    async def forget(self, path: str) -> None:
        """Give the work on a served file up.

        Raises:
            PackageError: The file is not served.
        """
        file = self._engine.served.resolve(Path(path))
        await asyncio.to_thread(forget_drafts, self._data_folder, [file])
        await self._look()

    async def close(self) -> None:
        """End what runs for it."""
        await self._throttle.close()

    async def _look(self) -> None:
        told = await asyncio.to_thread(_left_work, self._data_folder, self._engine.served)
        if told != (self._told or LeftWork(entries=())):
            self._told = told
            for listener in tuple(self._presenters):
                tell(listener, told)


def _left_work(data_folder: Path, served: ServedRoots) -> LeftWork:
    entries = (
        LeftWorkEntry(path=one.entry, title=Path(one.entry).name, at=one.at)
        for one in left_drafts(data_folder)
        if served.serves(one.entry) and is_file(Path(one.entry))
    )
    return LeftWork(entries=tuple(entries))
