"""Lists a served folder, for choosing a file to open."""

from __future__ import annotations

import os
import stat
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, Literal, NamedTuple, TypeAlias

from studio.errors import UnreadableFileError
from studio.files import is_file
from studio.packages.folder_memory import is_robot_name, is_text
from studio.packages.manifest import FILE_NAME
from studio.packages.robot_files import survey
from studio.packages.roots import is_below

if TYPE_CHECKING:
    from pathlib import Path

    from studio.packages.roots import ServedRoots

ENTRY_LIMIT: Final = 5_000
_BAG_METADATA: Final = "metadata.yaml"
"""Of a folder of rosbag2."""
_BAG_SUFFIXES: Final = (".mcap", ".db3")

EntryKind: TypeAlias = Literal["folder", "package", "robot", "bag", "zip", "file"]


@dataclass(frozen=True, slots=True)
class ListedEntry:
    """One entry of a folder. With `openable` false comes the reason."""

    name: str
    path: str
    kind: EntryKind
    openable: bool
    reason: str = ""


class Listing(NamedTuple):
    """A folder; `path` is empty for the list of roots, `parent` None when there is none above."""

    path: str
    parent: str | None
    entries: tuple[ListedEntry, ...]


def list_folder(path: str, roots: ServedRoots) -> Listing:
    """List a served folder, folders first; an empty path lists the served roots.

    Hidden files, and names that are no text, are left out. Robot files are judged in the light of
    the folder's other files.

    Raises:
        OutsideRootsError: The folder is not served.
        UnreadableFileError: It is no folder, or may not be listed.
    """
    if not path:
        return Listing("", None, tuple(_entries(_outermost(roots), roots, whole_path=True)))
    folder = roots.resolve(path)
    try:
        with os.scandir(folder) as found:
            names = sorted(one.name for one in found if _is_shown(one.name))
    except OSError as error:
        reason = error.strerror or "cannot be listed"
        raise UnreadableFileError(path, f"cannot be listed as a folder ({reason}).") from error
    inside = [folder / name for name in names[:ENTRY_LIMIT]]
    entries = sorted(_entries(inside, roots), key=_order)
    return Listing(str(folder), _parent(folder, roots), tuple(entries))


def _outermost(roots: ServedRoots) -> list[Path]:
    """Return the roots without those that are reached from another one."""
    return [
        root
        for root in roots.all
        if not any(root != other and is_below(root, other) for other in roots.all)
    ]


def _is_shown(name: str) -> bool:
    return not name.startswith(".") and is_text(name)


def _parent(folder: Path, roots: ServedRoots) -> str:
    """Return the folder above, or the list of roots when that is not served."""
    return str(folder.parent) if roots.serves(folder.parent) else ""


def _entries(
    paths: list[Path], roots: ServedRoots, *, whole_path: bool = False
) -> list[ListedEntry]:
    files = [path for path in paths if is_robot_name(path.name)]
    robots = {
        point.path: (point.openable, point.reason)
        for point in survey([one for one in files if roots.serves(one)], roots)
    }
    entries: list[ListedEntry] = []
    for path in paths:
        kind, openable, reason = _judge(path, roots, robots)
        name = str(path) if whole_path else path.name
        entries.append(ListedEntry(name, str(path), kind, openable, reason))
    return entries


def _judge(
    path: Path, roots: ServedRoots, robots: dict[Path, tuple[bool, str]]
) -> tuple[EntryKind, bool, str]:
    if not roots.serves(path):
        return "file", False, "a link that leads out of the opened folders"
    try:
        mode = path.stat().st_mode
    except OSError as error:
        return "file", False, f"not readable: {error.strerror}"
    if stat.S_ISDIR(mode):
        return _kind_of_folder(path), True, ""
    if not stat.S_ISREG(mode):
        return "file", False, "a pipe, device or socket"
    return _judge_file(path, robots)


def _kind_of_folder(path: Path) -> EntryKind:
    if is_file(path / _BAG_METADATA):
        return "bag"
    return "package" if is_file(path / FILE_NAME) else "folder"


def _judge_file(path: Path, robots: dict[Path, tuple[bool, str]]) -> tuple[EntryKind, bool, str]:
    if path in robots:
        return "robot", *robots[path]
    if path.suffix.lower() == ".zip":
        return "zip", True, ""
    if path.suffix.lower() in _BAG_SUFFIXES:
        return "bag", True, ""
    return "file", False, "no robot description"


def _order(entry: ListedEntry) -> tuple[bool, bool, str]:
    is_file = entry.kind not in ("folder", "package")
    return is_file, is_file and not entry.openable, entry.name.casefold()
