"""Packages by name: which folder a name means for a file, and which ones a person chose."""

from __future__ import annotations

import contextlib
import hashlib
import os
from collections import defaultdict
from dataclasses import dataclass
from enum import IntEnum
from pathlib import Path
from typing import TYPE_CHECKING, Final

import msgspec

from studio.errors import PackageNotFoundError, UnreadableFileError
from studio.files import is_folder, is_there, write_whole
from studio.packages.discovery import Origin, discover
from studio.packages.folder_memory import FolderMemory
from studio.packages.manifest import FILE_NAME
from studio.packages.roots import ServedRoots, is_below, is_too_wide
from studio.problems import Place, Problem, Severity

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from studio.packages.discovery import Package

_FOLDER: Final = "chosen_packages"
_CHOICES: Final = msgspec.json.Decoder(dict[str, str])


class Rank(IntEnum):
    """Rank of a package; a name means the lowest that has it."""

    OPENED = 0
    """A source package below an opened folder or a `--package-path`."""
    NESTED = 1
    """Inside another package: an example or a template."""
    ENVIRONMENT = 2
    """A source package of ROS_PACKAGE_PATH."""
    INSTALLED = 3
    """In an install space, without a source."""


@dataclass(frozen=True, slots=True)
class Indexed:
    """One folder for a name. `order`: place in the environment's list, earlier overlays later."""

    name: str
    folder: Path
    rank: Rank
    order: int = 0

    @classmethod
    def found(cls, package: Package, *, from_environment: bool = False, order: int = 0) -> Indexed:
        """Rank what `discover` found."""
        rank = _RANKS[package.origin]
        if from_environment:
            rank = max(rank, Rank.ENVIRONMENT)
        return cls(package.name, package.folder, rank, order)


_RANKS = {
    Origin.SOURCE: Rank.OPENED,
    Origin.NESTED: Rank.NESTED,
    Origin.INSTALLED: Rank.INSTALLED,
}


class PackageIndex:
    """All packages found, and the folders that a user chose for some names."""

    def __init__(
        self, packages: Iterable[Indexed], chosen: Mapping[str, Path] | None = None
    ) -> None:
        self.packages = tuple(packages)
        self.chosen = dict(chosen or {})
        self._by_name: dict[str, list[Indexed]] = defaultdict(list)
        for one in self.packages:
            self._by_name[one.name].append(one)

    def without(self, left_out: Callable[[Path], bool]) -> PackageIndex:
        """Return the same but for the packages in some folders."""
        chosen = {name: folder for name, folder in self.chosen.items() if not left_out(folder)}
        return PackageIndex((one for one in self.packages if not left_out(one.folder)), chosen)

    def __contains__(self, name: object) -> bool:
        return name in self.chosen or name in self._by_name

    @property
    def names(self) -> frozenset[str]:
        """Every name that can be found."""
        return frozenset(self._by_name) | frozenset(self.chosen)

    def candidates(self, name: str, asking_file: Path | str) -> tuple[Path, ...]:
        """Return folders that may serve a name, the one that does first; empty without any.

        A chosen folder is the only one. Else those nearest to the user (see `Rank`); the
        package that the asking file itself lies in counts as opened though it be nested.
        """
        if name in self.chosen:
            return (self.chosen[name],)
        known = self._by_name.get(name, ())
        if len(known) < 2:  # nearly always
            return tuple(one.folder for one in known)
        asking = Path(asking_file)
        ranked = [(_rank_of(one, asking), one) for one in known]
        lowest = min(((rank, one.order) for rank, one in ranked), default=None)
        serving = [one.folder for rank, one in ranked if (rank, one.order) == lowest]
        return tuple(sorted(serving, key=lambda folder: _distance(folder, asking)))

    def best(self, name: str, asking_file: Path | str) -> Path:
        """Return the folder that a name means for a file.

        Raises:
            PackageNotFoundError: No folder has that name.
        """
        folders = self.candidates(name, asking_file)
        if not folders:
            raise PackageNotFoundError(name, str(asking_file))
        return folders[0]

    def mapping_for(self, entry: Path | str) -> dict[str, tuple[str, ...]]:
        """Return every name with its folders, best first, as a file's reading policy holds them."""
        asking = os.path.realpath(entry)
        return {name: tuple(map(str, self.candidates(name, asking))) for name in sorted(self.names)}

    def duplicates(
        self, asking_file: Path | str, names: Iterable[str] | None = None
    ) -> list[Problem]:
        """Return a warning for each name (of all, or of these) that several folders could serve."""
        wanted = sorted(self.names if names is None else set(names) & self.names)
        found = ((name, self.candidates(name, asking_file)) for name in wanted)
        return [_duplicate(name, folders) for name, folders in found if len(folders) > 1]

    def with_chosen(self, name: str, folder: Path) -> PackageIndex:
        """Return the same index with one more choice."""
        return PackageIndex(self.packages, {**self.chosen, name: folder})


def nearest(folders: Sequence[str], asking_file: str) -> str:
    """Return the folder that shares the longest path with the asking file.

    Among equals the first: `folders` come best first, as in `mapping_for`.
    """
    asking = Path(asking_file).parts
    return max(folders, key=lambda folder: _shared_parts(Path(folder).parts, asking))


def _rank_of(one: Indexed, asking_file: Path) -> Rank:
    if one.rank is Rank.NESTED and is_below(asking_file, one.folder):
        return Rank.OPENED
    return one.rank


def _distance(folder: Path, asking_file: Path) -> tuple[int, int, str]:
    shared = _shared_parts(folder.parts, asking_file.parts)
    return -shared, len(folder.parts), str(folder)


def _shared_parts(one: Sequence[str], other: Sequence[str]) -> int:
    pairs = zip(one, other, strict=False)
    return next((n for n, (a, b) in enumerate(pairs) if a != b), min(len(one), len(other)))


def _duplicate(name: str, folders: Sequence[Path]) -> Problem:
    others = " and ".join(map(str, folders[1:]))
    return Problem(
        Severity.WARNING,
        "duplicate-package",
        f'Package "{name}" exists {len(folders)} times: {folders[0]} is used, {others} is not.',
        place=Place(str(folders[0] / "package.xml")),
    )


def load_choices(data_folder: Path, workspace: Path) -> dict[str, Path]:
    """Return what was chosen for a workspace, without folders that are gone."""
    with contextlib.suppress(OSError, msgspec.MsgspecError):
        chosen = _CHOICES.decode(_file(data_folder, workspace).read_bytes())
        return {name: Path(folder) for name, folder in chosen.items() if is_folder(Path(folder))}
    return {}


def save_choices(data_folder: Path, workspace: Path, chosen: Mapping[str, Path]) -> None:
    """Remember what was chosen.

    Raises:
        OSError: The data folder cannot be written.
    """
    file = _file(data_folder, workspace)
    file.parent.mkdir(parents=True, exist_ok=True)
    text = msgspec.json.encode({name: str(folder) for name, folder in chosen.items()})
    write_whole(file, msgspec.json.format(text))


def folder_of_choice(name: str, chosen: Path) -> Path:
    """Return the package that a user meant by a folder: itself, or the one of that name below.

    A folder without any package.xml is accepted.

    Raises:
        UnreadableFileError: It is no folder, or too wide to serve.
        PackageNotFoundError: There are packages, and none has that name.
    """
    try:
        folder = Path(os.path.realpath(chosen))
    except ValueError as error:  # a NUL character
        raise UnreadableFileError(repr(str(chosen)), "is no file name.") from error
    if not is_folder(folder):
        raise UnreadableFileError(str(chosen), "is no folder.")
    if is_too_wide(folder):
        raise UnreadableFileError(str(chosen), "is too wide to serve: choose a folder inside it.")
    found = discover(folder, FolderMemory(None, ServedRoots([folder]))).packages
    named = [one.folder for one in found if one.name == name]
    if named:
        return min(named, key=lambda one: len(one.parts))
    if found or is_there(folder / FILE_NAME):
        raise PackageNotFoundError(name, str(folder))
    return folder


def _file(data_folder: Path, workspace: Path) -> Path:
    key = hashlib.sha256(os.fsencode(workspace)).hexdigest()[:16]
    return data_folder / _FOLDER / f"{key}.json"
