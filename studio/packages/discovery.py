"""Finds the packages below a folder, as colcon would, and what it built there."""

from __future__ import annotations

import os
from dataclasses import dataclass
from enum import Enum, auto
from pathlib import Path
from typing import TYPE_CHECKING, Final

from studio.files import is_folder

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from studio.packages.folder_memory import FolderFacts, FolderMemory

FOLDER_LIMIT: Final = 200_000
_GENERATED: Final = frozenset({"build", "install", "log", "devel"})
_INSTALL: Final = frozenset({"install", "devel"})


class Origin(Enum):
    """Source of a package; an earlier one is used for a name before a later one."""

    SOURCE = auto()
    NESTED = auto()
    """Inside another package: colcon does not see it, but examples and templates refer to it."""
    INSTALLED = auto()


@dataclass(frozen=True, slots=True)
class Package:
    """A folder with a package.xml."""

    name: str
    folder: Path
    origin: Origin


@dataclass(frozen=True, slots=True)
class Discovery:
    """The packages below one folder. `generated`: build, install and log folders, not to edit."""

    packages: tuple[Package, ...]
    generated: tuple[Path, ...]
    complete: bool
    """False: it has over FOLDER_LIMIT folders and the rest was not searched."""


class _Space(Enum):
    """Kind of folder that the search is in."""

    SOURCE = auto()
    NESTED = auto()
    PREFIX = auto()
    """An install space: `share/<package>`, or `<package>/share/<package>`."""
    PREFIX_OF_ONE = auto()
    SHARE = auto()
    INSTALLED = auto()


_SOURCES: Final = frozenset({_Space.SOURCE, _Space.NESTED})
_ORIGINS: Final = {
    _Space.SOURCE: Origin.SOURCE,
    _Space.NESTED: Origin.NESTED,
    _Space.INSTALLED: Origin.INSTALLED,
}


def discover(
    root: Path,
    memory: FolderMemory,
    *,
    is_prefix: bool = False,
    progress: Callable[[int, int], None] | None = None,
) -> Discovery:
    """Search a folder of sources, a workspace, or (`is_prefix`) an install space.

    Packages inside packages are found too. Links to folders are not followed: what they lead to is
    either found where it is, or lies outside. `progress` is called with (folders seen, 0).
    """
    search = _Search(memory, progress)
    search.run(root, _Space.PREFIX if is_prefix else _Space.SOURCE)
    packages = sorted(search.packages, key=lambda one: one.folder)
    return Discovery(tuple(packages), tuple(search.generated), not search.waiting)


def robot_files(folder: Path, memory: FolderMemory) -> Iterator[Path]:
    """Yield the files that may be robot descriptions, in the sources below a folder.

    An install space is left out, unless it is the folder that was asked for.
    """
    top = str(folder)
    waiting = [top]
    for _ in range(FOLDER_LIMIT):
        if not waiting:
            return
        one = waiting.pop()
        facts = memory.facts(one)
        if facts is not None and (one == top or _is_source(one, facts)):
            yield from (Path(one, name) for name in facts.robot_files)
            waiting += [f"{one}{os.sep}{name}" for name in reversed(facts.subfolders)]


def _is_source(folder: str, facts: FolderFacts) -> bool:
    if facts.ignored or (facts.is_install_space and not facts.has_manifest):
        return False
    return facts.has_manifest or _base_name(folder) not in _GENERATED


def _base_name(folder: str) -> str:
    return folder.rpartition(os.sep)[2]


class _Search:
    def __init__(
        self, memory: FolderMemory, progress: Callable[[int, int], None] | None = None
    ) -> None:
        self._memory, self._progress = memory, progress
        self._root, self._seen = "", 0
        self.waiting: list[tuple[str, _Space]] = []
        self.packages: list[Package] = []
        self.generated: list[Path] = []

    def run(self, root: Path, space: _Space) -> None:
        self._root = str(root)
        self.waiting.append((self._root, space))
        while self.waiting and self._seen < FOLDER_LIMIT:
            self._visit(*self.waiting.pop())

    def _visit(self, folder: str, space: _Space) -> None:
        facts = self._memory.facts(folder)
        if facts is None:
            return
        self._count()
        actual = self._space_of(folder, facts, space) if space in _SOURCES else space
        if actual is None:
            return
        if facts.has_manifest and actual in _ORIGINS:
            self._take(folder, actual)
        self.waiting += [(f"{folder}{os.sep}{name}", into) for name, into in _inner(facts, actual)]

    def _count(self) -> None:
        self._seen += 1
        if self._progress is not None and self._seen % 500 == 0:
            self._progress(self._seen, 0)

    def _space_of(self, folder: str, facts: FolderFacts, space: _Space) -> _Space | None:
        """Return what kind a folder among sources is; None when it is not entered.

        The folders that colcon and catkin make are known by their names, unless they are packages,
        and install spaces by their files; the ignore marker in these is for builds only.
        """
        name = _base_name(folder)
        made = folder != self._root and name in _GENERATED and not facts.has_manifest
        installed = (made and name in _INSTALL) or facts.is_install_space
        if made or installed:
            self._note_generated(folder, facts)
        if installed:
            return _Space.PREFIX
        return None if made or facts.ignored else space

    def _note_generated(self, folder: str, facts: FolderFacts) -> None:
        """A folder that merely happens to be called `log` stays writable."""
        path = Path(folder)
        if facts.ignored or facts.is_install_space or is_folder(path.parent / "src"):
            self.generated.append(path)

    def _take(self, folder: str, space: _Space) -> None:
        name = self._memory.name_in(folder)
        if name is not None:
            self.packages.append(Package(name, Path(folder), _ORIGINS[space]))


def _inner(facts: FolderFacts, space: _Space) -> Iterator[tuple[str, _Space]]:
    """Return the folders to enter next, and as what."""
    if space in _SOURCES:
        into = _Space.NESTED if facts.has_manifest else space
        return ((name, into) for name in facts.subfolders)
    if space is _Space.SHARE:
        return ((name, _Space.INSTALLED) for name in facts.subfolders)
    if space in (_Space.PREFIX, _Space.PREFIX_OF_ONE) and "share" in facts.subfolders:
        return iter([("share", _Space.SHARE)])
    if space is _Space.PREFIX:
        return ((name, _Space.PREFIX_OF_ONE) for name in facts.subfolders)
    return iter(())
