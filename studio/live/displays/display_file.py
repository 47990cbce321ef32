"""Keeps the displays and tools of a document: one small file per entry in the data folder."""

from __future__ import annotations

import asyncio
import hashlib
import logging
import os
from typing import TYPE_CHECKING, Any, Final

import msgspec

from studio.files import write_whole
from studio.live.displays.display_list import DISPLAYS_MAX, DisplaySpec
from studio.live.displays.groups import group_path, is_within, regrouped
from studio.rviz.config_groups import group_name, renamed_group
from studio.rviz.config_values import text_at
from studio.rviz.tools import TOOLS_MAX, ToolSpec
from studio.rviz.views import ViewSpec  # noqa: TC001 - msgspec reads it

if TYPE_CHECKING:
    from pathlib import Path

FOLDER: Final = "displays"
_LIMIT_BYTES: Final = 8 << 20
"""Tools and views of an `.rviz` file stand in it twice: as values, and in the file's tree."""

_log = logging.getLogger(__name__)


class OpenedConfig(msgspec.Struct, frozen=True, omit_defaults=True):
    """An `.rviz` file, with what of it the displays do not say."""

    name: str
    path: str = ""
    """Empty: it came without one."""
    groups: dict[str, dict[str, Any]] = {}
    rest: dict[str, Any] = {}
    """The tree without its displays."""
    digest: str = ""
    """Of its text as the studio writes it without a change."""
    on_disk: str = ""
    """Digest of what the file held when it was read or written; empty: it has no path."""
    named: bool = False
    """Whether the command line named it: then it may be read and written wherever it lies."""
    groups_empty: dict[str, int] = {}
    """Groups in which nothing was, and how many stood before each in the group around it."""

    def regrouped(self, group: str, to: str) -> OpenedConfig:
        """Return it for a group that has another path: what the file says of it goes with it.

        Args:
            group: Its path.
            to: Its new path; empty: what is in it goes where it stands.

        Raises:
            CommandError: A group would stand in too many others.
        """
        to = group_path(to) or group.rpartition("/")[0]
        groups = {path: one for path, one in self.groups.items() if not is_within(path, group)}
        empty = {path: at for path, at in self.groups_empty.items() if not is_within(path, group)}
        for path in self.groups.keys() - groups.keys():
            if new := regrouped(path, group, to):
                entry = self.groups[path]
                groups.setdefault(new, _named(entry, to) if path == group else entry)
                if path in self.groups_empty:
                    empty.setdefault(new, self.groups_empty[path])
        return msgspec.structs.replace(self, groups=groups, groups_empty=empty)


def _named(entry: dict[str, Any], path: str) -> dict[str, Any]:
    """Return the entry of a group with the name that its path ends with, if that is another."""
    name = path.rpartition("/")[2]
    return entry if group_name(text_at(entry, "Name")) == name else renamed_group(entry, name)


class KeptDisplays(msgspec.Struct, frozen=True, omit_defaults=True):
    """The content of the file; displays and tools in the order of their lists."""

    displays: tuple[DisplaySpec, ...] = ()
    groups_off: tuple[str, ...] = ()
    fixed_frame: str = ""
    tools: tuple[ToolSpec, ...] = ()
    """None: RViz's first set."""
    background: str = ""
    """As `#rrggbb`; empty: that of the theme."""
    frame_rate: int = 0
    """Pictures of the 3D view per second at most; 0: as many as there can be."""
    config: OpenedConfig | None = None
    """The `.rviz` file that was opened or saved last."""
    views: tuple[ViewSpec, ...] = ()

    def regrouped(self, group: str, to: str | None) -> KeptDisplays:
        """Return it for a group that has another path; None: it has the same.

        Raises:
            CommandError: A group would stand in too many others.
        """
        if self.config is None or to is None:
            return self
        return msgspec.structs.replace(self, config=self.config.regrouped(group, to))


_DECODER: Final = msgspec.json.Decoder(KeptDisplays)
_BROKEN: Final = (msgspec.MsgspecError, UnicodeDecodeError, RecursionError)


class DisplayFile:
    """Reads and writes it; a file that cannot be read is as none, for it holds no work."""

    def __init__(self, data_folder: Path, entry: Path) -> None:
        name = hashlib.sha256(os.fsencode(entry)).hexdigest()[:32]
        self._path = data_folder / FOLDER / f"{name}.json"

    def read(self) -> KeptDisplays:
        """Return what was kept; an empty list if there is none or the file is broken."""
        try:
            if self._path.stat().st_size > _LIMIT_BYTES:
                return KeptDisplays()
            kept = _DECODER.decode(self._path.read_bytes())
        except (OSError, *_BROKEN):
            return KeptDisplays()
        displays, tools = kept.displays[:DISPLAYS_MAX], kept.tools[:TOOLS_MAX]
        return msgspec.structs.replace(kept, displays=displays, tools=tools)

    def delete(self) -> None:
        """Delete the file; thread-safe."""
        self._path.unlink(missing_ok=True)

    def write(self, kept: KeptDisplays) -> None:
        """Write the file; thread-safe. Errors of the disk are logged."""
        try:
            self._path.parent.mkdir(parents=True, exist_ok=True)
            write_whole(self._path, msgspec.json.encode(kept), mode=0o600)
        except OSError as error:
            _log.warning("The displays are not kept in %s: %s.", self._path, error.strerror)


class Keeper:
    """Writes what is kept, the newest only: a slider changes faster than the disk."""

    def __init__(self, file: DisplayFile) -> None:
        self._file = file
        self._unkept: KeptDisplays | None = None
        self._writing: asyncio.Task[None] | None = None

    def keep(self, kept: KeptDisplays) -> None:
        """Write it soon."""
        self._unkept = kept
        if self._writing is None or self._writing.done():
            self._writing = asyncio.create_task(self._write())

    async def close(self) -> None:
        """Wait until the newest is written."""
        if self._writing is not None:
            await self._writing

    async def _write(self) -> None:
        while self._unkept is not None:
            kept, self._unkept = self._unkept, None
            await asyncio.to_thread(self._file.write, kept)
