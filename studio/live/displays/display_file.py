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
from studio.rviz.tools import TOOLS_MAX, ToolSpec
from studio.rviz.views import ViewSpec  # noqa: TC001 - msgspec reads it

if TYPE_CHECKING:
    from pathlib import Path

FOLDER: Final = "displays"
_LIMIT_BYTES: Final = 4 << 20

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
