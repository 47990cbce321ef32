"""The files around a robot that may name joint positions: SRDFs, and initial positions."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Final, NamedTuple

from studio.files import is_folder
from studio.packages.roots import package_folder_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from studio.packages.index import PackageIndex
    from studio.packages.roots import ServedRoots

FILE_LIMIT: Final = 60
"""Limit for each kind; a workspace of many robots has more, most of them of others."""
FOLDERS_WATCHED_MAX: Final = 300
"""The system watches so many by default."""
_FOLDER_LIMIT: Final = 400
"""Limit for one package."""
_DEPTH_LIMIT: Final = 5
_MOVEIT: Final = ("_moveit_config", "_moveit", "_moveit2", "_moveit2_config")
_SRDF: Final = (".srdf", ".srdf.xacro")
_YAML: Final = (".yaml", ".yml")


class PoseFiles(NamedTuple):
    """Files by kind, those of the robot's own package first."""

    srdf: tuple[Path, ...]
    initial: tuple[Path, ...]
    folders: tuple[Path, ...] = ()
    """Folders that were searched, in which new ones would be."""


def pose_files(entry: Path, index: PackageIndex, served: ServedRoots) -> PoseFiles:
    """Search the robot's package and the packages that configure MoveIt.

    Links to folders are not followed. What lies outside of the served folders is left out.
    """
    srdf: dict[Path, None] = {}
    initial: dict[Path, None] = {}
    places: list[Path] = []
    for folder in _folders(entry, index, served):
        for path in _files_below(folder, places):
            if _is_srdf(path.name):
                srdf[path] = None
            elif _is_initial(path.name):
                initial[path] = None
    watched = tuple(one for one in places if served.serves(one))[:FOLDERS_WATCHED_MAX]
    return PoseFiles(_served(srdf, served), _served(initial, served), watched)


def may_name_poses(path: str) -> bool:
    """Whether a new file may do so, by its name; or it is a folder, which may hold such files."""
    name = Path(path).name
    return _is_srdf(name) or _is_initial(name) or is_folder(Path(path))


def _is_srdf(name: str) -> bool:
    return name.lower().endswith(_SRDF)


def _is_initial(name: str) -> bool:
    return name.lower().endswith(_YAML) and "initial_positions" in name.lower()


def _served(paths: Iterable[Path], served: ServedRoots) -> tuple[Path, ...]:
    return tuple(path for path in paths if served.serves(path))[:FILE_LIMIT]


def _folders(entry: Path, index: PackageIndex, served: ServedRoots) -> Iterator[Path]:
    own = package_folder_of(entry) or entry.parent
    if served.serves(own):
        yield own
    named = [one for one in index.packages if one.name.endswith(_MOVEIT) and one.folder != own]
    like = own.name.removesuffix("_description")
    named.sort(key=lambda one: (-_shared_letters(one.name, like), one.name))
    yield from (one.folder for one in named)


def _shared_letters(one: str, other: str) -> int:
    pairs = enumerate(zip(one, other, strict=False))
    return next((at for at, (a, b) in pairs if a != b), min(len(one), len(other)))


def _files_below(folder: Path, places: list[Path]) -> Iterator[Path]:
    """Yield the files, in order; `places` is given the folders as they are read."""
    waiting = [(folder, 0)]
    for _ in range(_FOLDER_LIMIT):
        if not waiting:
            return
        place, depth = waiting.pop()
        places.append(place)
        try:
            entries = sorted(os.scandir(place), key=lambda one: one.name)
        except OSError:
            continue
        inner: list[tuple[Path, int]] = []
        for one in entries:
            if one.is_dir(follow_symlinks=False):
                if depth < _DEPTH_LIMIT and not one.name.startswith("."):
                    inner.append((Path(one.path), depth + 1))
            else:
                yield Path(one.path)
        waiting += reversed(inner)
