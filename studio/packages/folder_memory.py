"""The contents of folders, kept between runs and valid while a folder's mtime stays."""

from __future__ import annotations

import contextlib
import os
from pathlib import Path
from typing import TYPE_CHECKING, Final

import msgspec

from studio.errors import PackageError
from studio.files import write_whole
from studio.packages.manifest import FILE_NAME, SIZE_LIMIT_BYTES, package_name

if TYPE_CHECKING:
    from studio.packages.roots import ServedRoots

_VERSION: Final = 2
ROBOT_SUFFIXES: Final = (".xacro", ".urdf", ".xml")
_IGNORE_MARKERS: Final = frozenset({"COLCON_IGNORE", "AMENT_IGNORE", "CATKIN_IGNORE"})
INSTALL_MARKERS: Final = frozenset({".colcon_install_layout", ".catkin", "local_setup.sh"})
_NEVER_ENTERED: Final = frozenset({"node_modules", "__pycache__", "site-packages", "CVS"})
_CLOCK_GRAIN_NS: Final = 2_000_000_000
"""A folder changed this shortly before it was seen may change again within the same mtime."""


class FolderFacts(msgspec.Struct, frozen=True, array_like=True):
    """The content of one folder when it was listed."""

    mtime_ns: int
    subfolders: tuple[str, ...]
    """Names of the folders to enter: no links, nothing hidden; sorted."""
    robot_files: tuple[str, ...]
    """Names of the files whose suffix a robot description may have; sorted."""
    has_manifest: bool
    ignored: bool
    is_install_space: bool


class ManifestFacts(msgspec.Struct, frozen=True, array_like=True):
    """The name in a package.xml, None when it has none, and what that was read from."""

    mtime_ns: int
    size: int
    name: str | None


class _Store(msgspec.Struct, frozen=True, array_like=True):
    version: int
    folders: dict[str, FolderFacts]
    manifests: dict[str, ManifestFacts]


class FolderMemory:
    """Facts by folder path; `file` None keeps them for this object's life only."""

    def __init__(self, file: Path | None, served: ServedRoots) -> None:
        self._file, self._served = file, served
        self._written_ns, self._old = _load(file)
        self._folders: dict[str, FolderFacts] = {}
        self._manifests: dict[str, ManifestFacts] = {}
        self.listed = 0
        """How many folders had to be listed, because nothing valid was kept of them."""

    def facts(self, folder: str) -> FolderFacts | None:
        """Return what is in a folder; None when it cannot be listed. Each is listed once a run."""
        if folder in self._folders:
            return self._folders[folder]
        try:
            mtime_ns = os.lstat(folder).st_mtime_ns
            known = self._old.folders.get(folder)
            if known is None or known.mtime_ns != mtime_ns or not self._is_settled(mtime_ns):
                known = _facts_of(folder, mtime_ns)
                self.listed += 1
        except OSError:
            return None
        self._folders[folder] = known
        return known

    def name_in(self, folder: str) -> str | None:
        """Return the name in the package.xml of a folder; None when there is none."""
        manifest = f"{folder}{os.sep}{FILE_NAME}"
        try:
            now = Path(manifest).stat()
        except OSError:
            return None
        known = self._old.manifests.get(manifest)
        same = known is not None and (known.mtime_ns, known.size) == (now.st_mtime_ns, now.st_size)
        if known is None or not same or not self._is_settled(now.st_mtime_ns):
            known = ManifestFacts(now.st_mtime_ns, now.st_size, self._read_name(manifest))
        self._manifests[manifest] = known
        return known.name

    def save(self) -> None:
        """Keep what was seen for the next run; a data folder that is full costs speed only."""
        store = _Store(_VERSION, self._folders, self._manifests)
        if self._file is None or (store == self._old and not self.listed):
            return
        with contextlib.suppress(OSError, UnicodeEncodeError):  # the root's own name may be no text
            self._file.parent.mkdir(parents=True, exist_ok=True)
            write_whole(self._file, msgspec.msgpack.encode(store))

    def _is_settled(self, mtime_ns: int) -> bool:
        return mtime_ns < self._written_ns - _CLOCK_GRAIN_NS

    def _read_name(self, manifest: str) -> str | None:
        try:
            return package_name(self._served.read(manifest, SIZE_LIMIT_BYTES))
        except PackageError:
            return None


def _load(file: Path | None) -> tuple[int, _Store]:
    """Return the stored facts and their time; nothing when they are missing or broken."""
    if file is not None:
        with contextlib.suppress(OSError, msgspec.MsgspecError):
            store = msgspec.msgpack.decode(file.read_bytes(), type=_Store)
            if store.version == _VERSION:
                return file.stat().st_mtime_ns, store
    return 0, _Store(_VERSION, {}, {})


def _facts_of(folder: str, mtime_ns: int) -> FolderFacts:
    subfolders: list[str] = []
    names: set[str] = set()
    with os.scandir(folder) as entries:
        for entry in entries:
            if not is_text(entry.name):
                continue
            if entry.is_dir(follow_symlinks=False):
                subfolders.append(entry.name)
            else:
                names.add(entry.name)
    is_environment = "pyvenv.cfg" in names
    return FolderFacts(
        mtime_ns=mtime_ns,
        subfolders=tuple(sorted(name for name in subfolders if _is_entered(name))),
        robot_files=tuple(sorted(name for name in names if is_robot_name(name))),
        has_manifest=FILE_NAME in names,
        ignored=is_environment or not names.isdisjoint(_IGNORE_MARKERS),
        is_install_space=not names.isdisjoint(INSTALL_MARKERS),
    )


def is_text(name: str) -> bool:
    """Whether a file name is text: Linux allows any bytes, which no message can carry."""
    try:
        name.encode()
    except UnicodeEncodeError:
        return False
    return True


def is_robot_name(name: str) -> bool:
    """Whether a file may be a robot by its name; its content decides."""
    return name.lower().endswith(ROBOT_SUFFIXES) and name != FILE_NAME


def _is_entered(name: str) -> bool:
    return not name.startswith(".") and name not in _NEVER_ENTERED
