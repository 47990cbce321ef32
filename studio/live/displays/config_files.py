"""ConfigFiles: where `.rviz` files are read, written and listed, and who changed one meanwhile."""

from __future__ import annotations

import hashlib
import os
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Final, Literal, Protocol

from studio.errors import CommandError, NotSavedError, UnreadableFileError
from studio.files import is_file, is_folder, is_there, write_whole
from studio.live.displays.display_file import OpenedConfig
from studio.packages.recent import RecentFiles
from studio.packages.roots import ServedRoots, package_folder_of
from studio.packages.run_folders import is_program
from studio.protocol.rviz_configs import RvizFileEntry
from studio.rviz.config_text import ENDINGS, SIZE_LIMIT_BYTES

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

_RECENT: Final = "recent_rviz.json"
_LISTED_MAX: Final = 200
_WALKED_MAX: Final = 2000
"""Folders that are looked into for config files."""


class ConfigFolders(Protocol):
    """The folders of a document."""

    @property
    def entry(self) -> Path:
        """The robot's file."""
        ...

    @property
    def served(self) -> ServedRoots:
        """The folders that may be read and written."""
        ...

    def resolve_uri(self, uri: str) -> Path:
        """Return the file of a URI; reads the disk, thread-safe.

        Raises:
            PackageError: It names no file that may be read.
        """
        ...


class ConfigFiles:
    """Config files below the served folders, and the one that the command line named; thread-safe.

    Args:
        folders: Where files are.
        data_folder: Remembers which were opened.
        config: Returns the one that is open; thread-safe.
    """

    def __init__(
        self, folders: ConfigFolders, data_folder: Path, config: Callable[[], OpenedConfig | None]
    ) -> None:
        self._folders, self._config = folders, config
        self._recent = RecentFiles(data_folder, _RECENT)
        self.named = ""
        """The file that the command line named, links followed; empty: none."""

    @property
    def proposed_name(self) -> str:
        """Of a file of the robot where none is open."""
        return f"{self._folders.entry.name.split('.')[0]}{ENDINGS[0]}"

    def note(self, path: str, name: str) -> None:
        """A file was opened or saved."""
        self._recent.note(path, name, {}, datetime.now(UTC).timestamp())

    def forget(self, path: str) -> None:
        """Take a file out of those opened lately."""
        self._recent.forget(path)

    def opened_as(self, name: str, path: str, text: str) -> OpenedConfig:
        """Return what is kept of a file that holds this text now; without a path it has none."""
        on_disk = digest_of(text) if path else ""
        return OpenedConfig(name, path, on_disk=on_disk, named=path in self._all_named())

    def read(self, path: str) -> tuple[bytes, Path]:
        """Return a file and where it is.

        Raises:
            PackageError: It may not be read, or cannot be.
        """
        found = self._found(path)
        return self._roots_of(found).read(found, SIZE_LIMIT_BYTES), found

    def target(self, wanted: str) -> Path:
        """Return where a file is written; without a path the one that is open.

        Raises:
            CommandError: No path is given, and no file was opened.
            PackageError: It leads out of the folders that may be written.
            NotSavedError: It may not be written there.
        """
        config = self._config()
        opened = config.path if config else ""
        wanted = wanted.strip() or opened
        if not wanted:
            raise CommandError("No file was opened yet: name the one to write.")
        if not wanted.endswith(ENDINGS) and wanted != opened:
            wanted += ENDINGS[0]
        asked = self._folders.entry.parent / wanted
        roots = self._roots_of(asked)
        path = roots.resolve(asked)
        if not is_folder(path.parent):
            raise NotSavedError(str(path), "there is no such folder; name one that is there")
        if not roots.may_write(path):
            raise NotSavedError(str(path), "it may only be read here; name another")
        if is_program(path) and not path.name.endswith(ENDINGS):
            raise NotSavedError(str(path), "it is a program, and no config; name another")
        return path

    def write(self, path: Path, text: str, *, replace: bool) -> Literal["", "file", "changes"]:
        """Write a file, unless something is lost by it: another one, or changes of others.

        Raises:
            NotSavedError: The disk refuses it.
        """
        lost = "" if replace else self._lost_by_writing(path)
        if not lost:
            _write_config(path, text)
        return lost

    def _lost_by_writing(self, path: Path) -> Literal["", "file", "changes"]:
        """Return what is written over: another file, or what others changed in the open one."""
        config = self._config()
        if not is_there(path):
            return ""
        if config is None or config.path != str(path) or not config.on_disk:
            return "file"
        try:
            now = self._roots_of(path).read(path, SIZE_LIMIT_BYTES)
        except UnreadableFileError:
            return "changes"
        return "" if _digest_of_bytes(now) == config.on_disk else "changes"

    def listed(self) -> tuple[tuple[RvizFileEntry, ...], str]:
        """Return those opened lately and those of the robot's package, and where one may go."""
        served, entry = self._folders.served, self._folders.entry
        recent = [
            RvizFileEntry(
                path=one.path, name=one.title, time_s=one.time_s, is_there=is_file(Path(one.path))
            )
            for one in self._recent.all()
            if self._roots_of(Path(one.path)).serves(one.path)
        ]
        known = {one.path for one in recent}
        folder = package_folder_of(entry.parent) or entry.parent
        found = sorted(_configs_in(folder)) if served.serves(folder) else []
        others = [
            RvizFileEntry(path=str(one), name=one.name, time_s=None, is_there=True)
            for one in found
            if str(one) not in known and served.serves(one) and is_file(one)
        ]
        places = [one for one in (folder / "rviz", folder, entry.parent) if is_folder(one)]
        place = next((one for one in places if served.may_write(one / f"x{ENDINGS[0]}")), None)
        return (*recent, *others), str(place) if place else ""

    def _found(self, path: str) -> Path:
        if "://" in path:
            return self._folders.resolve_uri(path)
        wanted = self._folders.entry.parent / path
        return self._roots_of(wanted).resolve(wanted)

    def _roots_of(self, path: Path) -> ServedRoots:
        """Return what decides about a file: the served folders, or itself where it was named."""
        served = self._folders.served
        if served.serves(path):
            return served
        return next((one for one in map(_alone, self._all_named()) if one.serves(path)), served)

    def _all_named(self) -> set[str]:
        """Return what the command line named, now or when the open file was opened."""
        config = self._config()
        return {self.named, config.path if config and config.named else ""} - {""}


def _write_config(path: Path, text: str) -> None:
    """Write a file whole; it keeps its permissions.

    Raises:
        NotSavedError: The disk refuses it.
    """
    try:
        mode = path.stat().st_mode & 0o777 if is_there(path) else 0o644
        write_whole(path, text.encode("utf-8"), mode=mode, flush=True)
    except OSError as error:
        raise NotSavedError(str(path), error.strerror or "the disk refused it") from error


def digest_of(text: str) -> str:
    """Return what tells two texts apart."""
    return _digest_of_bytes(text.encode("utf-8", "replace"))


def _digest_of_bytes(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()[:32]


def _alone(file: str) -> ServedRoots:
    """Serve one file and nothing beside it; none at all where a link has taken its place."""
    roots = ServedRoots([Path(file)])
    return roots if roots.all == (Path(file),) else ServedRoots(())


def _configs_in(folder: Path) -> Iterator[Path]:
    """Yield the config files in a folder and below it, of a large one the first."""
    left = _LISTED_MAX
    for walked, (root, folders, files) in enumerate(os.walk(folder)):
        folders[:] = sorted(one for one in folders if not one.startswith("."))
        for name in files:
            if name.endswith(ENDINGS) and left > 0:
                left -= 1
                yield Path(root, name)
        if left == 0 or walked > _WALKED_MAX:
            return
