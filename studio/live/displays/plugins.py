"""Plugins: displays of the owner's own, each a Python file in a folder of the command line."""

from __future__ import annotations

import asyncio
import logging
from typing import TYPE_CHECKING, Final

from studio.errors import DisplayError
from studio.files import is_file, stamp_of

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable, Iterable, Mapping
    from pathlib import Path

    from studio.displays.display import Display
    from studio.files import Stamp
    from studio.live.displays.plugin_display import PluginDisplay, PluginFile

PREFIX: Final = "plugins/"
"""Before the names of their kinds, so that none is taken for one of the studio's."""
PLUGINS_MAX: Final = 100
_LOOK_EVERY_S: Final = 0.5

_log = logging.getLogger(__name__)


class Plugins:
    """Watches the folders, and runs what is in them; everything on the loop.

    Args:
        folders: As the owner gave them on the command line.
    """

    def __init__(self, folders: Iterable[Path] = ()) -> None:
        self._folders = tuple(folders)
        self._files: dict[Path, PluginFile] = {}
        self._kinds: dict[str, type[PluginDisplay]] = {}
        self._clashes: dict[str, str] = {}
        """Why files are not shown whose kind another has, too, by their names."""
        self._watching: asyncio.Task[None] | None = None
        self._watchers: set[Callable[[frozenset[str]], Awaitable[None]]] = set()
        self.generation = 0
        """Grows with each change of the kinds."""
        self.ready = asyncio.Event()
        """Set once the folders were read for the first time."""
        if not self._folders:
            self.ready.set()

    def start(self) -> None:
        """Read the folders, and again whenever a file in them changes."""
        if self._folders and self._watching is None:
            self._watching = asyncio.create_task(self._watch())

    async def close(self) -> None:
        """End all processes."""
        if self._watching is not None:
            self._watching.cancel()
            await asyncio.gather(self._watching, return_exceptions=True)
        await asyncio.gather(*(one.close() for one in self._files.values()))

    def on_change(self, told: Callable[[frozenset[str]], Awaitable[None]]) -> Callable[[], None]:
        """Have a function be told of kinds that came, changed or went; return the end of it."""
        self._watchers.add(told)
        return lambda: self._watchers.discard(told)

    def of_kind(self, kind: str) -> type[Display]:
        """Return the display of a name, the owner's or the studio's.

        Raises:
            DisplayError: There is none.
        """
        if not kind.startswith(PREFIX):
            from studio.displays.catalogue import display_of_kind  # noqa: PLC0415 - imports all

            return display_of_kind(kind)
        if found := self._kinds.get(kind):
            return found
        raise DisplayError(self.why_not(kind))

    def why_not(self, kind: str) -> str:
        """Return why there is no display of such a name here, and what would bring it."""
        if not kind.startswith(PREFIX):
            return f'There is no display "{kind[:60]}" here.'
        if not self.ready.is_set():
            return "The files of your own displays are being read."
        name = kind.removeprefix(PREFIX)[:60]
        if faults := list(self.faults().values()):
            return f'No file makes your own display "{name}". One is switched off: {faults[0]}.'
        return (
            f'The display "{name}" of your own is not here: start the studio with --displays and '
            "the folder of its file."
        )

    def kinds(self) -> tuple[type[Display], ...]:
        """Return all kinds, the studio's and the owner's."""
        from studio.displays.catalogue import DISPLAYS  # noqa: PLC0415 - imports all

        return (*DISPLAYS, *self._kinds.values())

    def kind_of_type(self, type_name: str) -> str:
        """Return the owner's display that shows messages of a type; empty: there is none."""
        shown = (
            name
            for name, one in self._kinds.items()
            if one.TOPICS and type_name in one.TOPICS[0].types
        )
        return next(shown, "")

    def faults(self) -> dict[str, str]:
        """Return why files are switched off, by their names."""
        own = {one.path.name: one.fault for one in self._files.values() if one.fault}
        return own | self._clashes

    async def _watch(self) -> None:
        while True:
            try:
                found = await asyncio.to_thread(_files_in, self._folders)
                await self._take(found)
            except Exception:  # noqa: BLE001 - what fails once is tried again
                _log.exception("The folders of displays could not be read.")
            self.ready.set()
            await asyncio.sleep(_LOOK_EVERY_S)

    async def _take(self, found: Mapping[Path, Stamp]) -> None:
        changed = [
            path
            for path, stamp in found.items()
            if path not in self._files or self._files[path].stamp != stamp
        ]
        gone = [path for path in self._files if path not in found]
        if not changed and not gone:
            return
        from studio.live.displays.plugin_display import PluginFile  # noqa: PLC0415 - imports all

        before = self._kinds
        for path in (*gone, *changed):
            if file := self._files.pop(path, None):
                await file.close()
        for path in changed:
            self._files[path] = PluginFile(path, found[path])
        await asyncio.gather(*(self._files[path].load() for path in changed))
        self._kinds = self._named()
        self.generation += 1
        both = {name for name in before.keys() & self._kinds if before[name] is self._kinds[name]}
        touched = frozenset(before.keys() | self._kinds.keys()) - both
        for told in tuple(self._watchers):
            await told(touched)

    def _named(self) -> dict[str, type[PluginDisplay]]:
        """Return the kinds by name; of two files with one name the first by path has it."""
        kinds: dict[str, type[PluginDisplay]] = {}
        self._clashes = {}
        for path in sorted(self._files):
            kind = self._files[path].kind
            if kind is not None and (first := kinds.setdefault(kind.KIND, kind)) is not kind:
                other = first.FILE.path.name
                self._clashes[path.name] = f"{path.name}: its KIND is that of {other}, too"
        return kinds


def _files_in(folders: Iterable[Path]) -> dict[Path, Stamp]:
    found: dict[Path, Stamp] = {}
    for folder in folders:
        for path in sorted(folder.glob("*.py")):
            if path.name[0] in "._" or not is_file(path) or len(found) >= PLUGINS_MAX:
                continue
            if stamp := stamp_of(path):
                found[path] = stamp
    return found
