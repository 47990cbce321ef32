"""Opens a path: the file to show, the folders to serve, the packages found."""

from __future__ import annotations

import contextlib
import hashlib
import os
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Final, TypeAlias
from xml.sax.saxutils import quoteattr

from studio.errors import DataFolderError, UnreadableFileError, UnsafeArchiveError
from studio.files import is_file, is_folder, is_there, write_whole
from studio.packages.archive import folder_to_open, unpack_zip
from studio.packages.discovery import FOLDER_LIMIT, Discovery, discover
from studio.packages.environment import RosEnvironment, is_install_space, is_installed
from studio.packages.folder_memory import FolderMemory, is_text
from studio.packages.index import (
    Indexed,
    PackageIndex,
    Rank,
    folder_of_choice,
    load_choices,
    save_choices,
)
from studio.packages.manifest import FILE_NAME
from studio.packages.received_texts import FROM_ROS_FOLDER as FROM_WIRE
from studio.packages.received_texts import UNTITLED_FOLDER as UNTITLED
from studio.packages.received_texts import untitled_number
from studio.packages.robot_files import Candidate, robot_candidates
from studio.packages.roots import (
    ServedRoots,
    is_below,
    is_too_wide,
    package_folder_of,
    served_roots_for,
)
from studio.problems import Place, Problem, Severity
from studio.settings import UPLOADS_QUOTA_BYTES, ZIP_SIZE_LIMIT_BYTES

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

UPLOADS: Final = "uploads"
_BARE: Final = "workspaces"
_BARE_ROBOT: Final = '<robot name="{name}">\n  <link name={frame}/>\n</robot>\n'
"""For displays to stand in: as RViz, which has a fixed frame before anybody names one."""
_MEMORY: Final = "package_index"

Progress: TypeAlias = "Callable[[str, int, int], None]"
"""Called with (what is done, done, total); total 0 when it is not known."""


@dataclass(frozen=True, slots=True)
class Location:
    """An opened path. `entry` is None when a folder holds no robot; `candidates` say why."""

    root: Path
    """The folder that short names are shown against, and that choices are remembered for."""
    entry: Path | None
    served: ServedRoots
    index: PackageIndex
    candidates: tuple[Candidate, ...]
    """The robot files of the opened folder, or of the opened file's package: best first."""
    problems: tuple[Problem, ...]
    data_folder: Path

    @property
    def is_unpacked(self) -> bool:
        """Whether it was uploaded, unpacked, pasted or received from ROS."""
        folders = (UPLOADS, UNTITLED, FROM_WIRE)
        return any(self.root.is_relative_to(self.data_folder / one) for one in folders)

    @property
    def is_bare(self) -> bool:
        """Whether the folder holds no robot, and its entry file is one of `with_bare_entry`."""
        return self.entry is not None and self.entry.parent.parent == self.data_folder / _BARE

    def with_bare_entry(self, *, may_run: bool = False) -> Location:
        """Return a folder of packages without a robot as one that can be opened all the same.

        Its entry file lies in the data folder: a frame, for the displays of a 3D view to stand in.
        Any other location is returned as it is.

        Args:
            may_run: Whether it lies in a folder of --allow-run: such a folder is a workspace also
                while it is empty, for its first package is made in the page.

        Raises:
            DataFolderError: The data folder cannot take it.
        """
        if self.entry is not None or self.is_unpacked:
            return self
        here = (one for one in self.index.packages if is_below(one.folder, self.root))
        if not may_run and next(here, None) is None:
            return self
        name = hashlib.sha256(os.fsencode(self.root)).hexdigest()[:16]
        entry = self.data_folder / _BARE / name / "workspace.urdf"
        try:
            entry.parent.mkdir(parents=True, exist_ok=True)
            write_whole(entry, _BARE_ROBOT.format(name="workspace", frame='"map"').encode())
        except OSError as error:
            raise DataFolderError(str(entry.parent), error.strerror or "not writable") from error
        served = self.served.with_roots((), [entry.parent])
        return replace(self, entry=entry, served=served)

    @property
    def title(self) -> str:
        """The entry file's name, or which untitled text it is; that of a folder without a robot."""
        if self.entry is None:
            return ""
        if self.is_bare:
            return self.root.name
        number = untitled_number(self.entry, self.data_folder)
        return self.entry.name if number is None else f"Untitled {number}"

    def choose_package(self, name: str, folder: Path) -> Location:
        """Use a folder for a package from now on, serve it, and remember it.

        Raises:
            PackageNotFoundError: The folder holds packages, but none of that name.
            UnreadableFileError: It is no folder, or too wide to serve.
            DataFolderError: The choice cannot be kept.
        """
        chosen = folder_of_choice(name, folder)
        index = self.index.with_chosen(name, chosen)
        try:
            save_choices(self.data_folder, self.root, index.chosen)
        except OSError as error:
            raise DataFolderError(str(self.data_folder), error.strerror or "not kept") from error
        return replace(self, index=index, served=_serve_chosen(self.served, [chosen]))


def bare_location(root: Path, frame: str, data_folder: Path) -> Location:
    """Return a bag without a robot as what can be opened: a link to stand in, and nothing else.

    Args:
        root: Folder or file of the bag; it is not read here.
        frame: Name of the link.
        data_folder: Where its entry file is kept.

    Raises:
        DataFolderError: The data folder cannot take it.
    """
    name = hashlib.sha256(os.fsencode(root)).hexdigest()[:16]
    entry = data_folder / _BARE / name / "bag.urdf"
    text = _BARE_ROBOT.format(name="bag", frame=quoteattr(frame))
    try:
        entry.parent.mkdir(parents=True, exist_ok=True)
        write_whole(entry, text.encode("utf-8", "replace"))
    except OSError as error:
        raise DataFolderError(str(entry.parent), error.strerror or "not writable") from error
    served = ServedRoots((), [entry.parent])
    return Location(root, entry, served, PackageIndex([], {}), (), (), data_folder)


def open_location(
    path: Path,
    package_paths: Iterable[Path],
    data_folder: Path,
    environment: Mapping[str, str],
    progress: Progress | None = None,
    *,
    within: ServedRoots | None = None,
) -> Location:
    """Return everything about a path that a document needs.

    A file opens itself; a folder opens its best robot file; a zip is unpacked into the data folder
    first, once for each content. A folder that is a package, or lies in one, is served as a file of
    that package is, so that it finds the packages beside it. `within` is for opening out of the
    page: it serves nothing for that path that was not served before, save what a zip holds.

    Raises:
        OutsideRootsError: It is not `within`.
        UnreadableFileError: Nothing is there, no file or folder, or it is too wide to serve.
        UnsafeArchiveError: The zip is not to be unpacked.
    """
    report = progress or _ignore
    real = Path(os.path.realpath(path))
    if not is_text(str(real)):
        shown = str(real).encode("utf-8", "replace").decode()
        raise UnreadableFileError(shown, "has a name that is no text: rename it to open it.")
    roots = _roots_to_serve(real) if within is None else _roots_within(real, within)
    if is_file(real) and real.suffix.lower() == ".zip":
        real = _unpacked(real, data_folder, report)
        roots = (real,)
    survey = _Survey(roots, package_paths, environment, data_folder / _MEMORY)
    survey.search(report)
    chosen = load_choices(data_folder, roots[0])
    served = _as_served_before(_serve_chosen(survey.served(), chosen.values()), within)
    candidates = _candidates(real, served, survey.memory, report)
    return Location(
        root=roots[0],
        entry=real if is_file(real) else _best(candidates),
        served=served,
        index=PackageIndex(survey.packages, chosen),
        candidates=candidates,
        problems=tuple(survey.problems),
        data_folder=data_folder,
    )


def _roots_to_serve(real: Path) -> tuple[Path, ...]:
    if is_there(real) and not (is_file(real) or is_folder(real)):
        raise UnreadableFileError(str(real), "is no file and no folder, and was not opened.")
    if is_folder(real) and not is_too_wide(real):
        package = package_folder_of(real)
        if package is not None:
            return served_roots_for(package / FILE_NAME)
    return served_roots_for(real)


def _roots_within(real: Path, within: ServedRoots) -> tuple[Path, ...]:
    """Return the same, cut down to the folder served already that holds the path."""
    within.resolve(real)
    roots = tuple(one for one in _roots_to_serve(real) if within.root_of(one) is not None)
    around = within.root_of(real)
    return roots if roots or around is None else (around,)


def _as_served_before(served: ServedRoots, before: ServedRoots | None) -> ServedRoots:
    """Keep read-only what was read-only when it is opened from the page."""
    if before is None:
        return served
    kept = [one for one in served.writable if before.root_of(one) in before.read_only]
    return ServedRoots([one for one in served.writable if one not in kept], served.all)


class _Survey:
    """Searches every folder that may hold packages, and so learns what may be written."""

    def __init__(
        self,
        roots: tuple[Path, ...],
        package_paths: Iterable[Path],
        variables: Mapping[str, str],
        memories: Path,
    ) -> None:
        self._opened = roots
        self._roots = tuple(dict.fromkeys((*roots, *map(_package_path, package_paths))))
        self._environment = RosEnvironment.from_variables(variables)
        self._beside = _install_beside(self._roots)
        self._read_only = [*(one for one in self._roots if is_installed(one)), *self._beside]
        folders = (*self._roots, *self._beside, *self._environment.folders)
        key = hashlib.sha256(os.fsencode("\n".join(map(str, folders)))).hexdigest()[:16]
        self.memory = FolderMemory(memories / key, ServedRoots(folders))
        self.packages: list[Indexed] = []
        self.problems: list[Problem] = []

    def search(self, report: Progress) -> None:
        for root in self._roots:
            self._search_root(root, report)
        for prefix in self._beside:
            self._search_prefix(prefix, report, order=0)
        self._search_environment(report)
        self.memory.save()
        self.packages = list({one.folder: one for one in reversed(self.packages)}.values())

    def served(self) -> ServedRoots:
        """Opened folders to write, unless installed; package paths and the environment to read."""
        writable = [one for one in self._opened if one not in self._read_only]
        beside = (*self._roots, *self._environment.folders)
        outside = [one for one in beside if not _is_in(one, writable)]
        return ServedRoots(writable, (*self._read_only, *outside, *self._environment.prefixes))

    def _search_root(self, root: Path, report: Progress) -> None:
        found = discover(root, self.memory, progress=_counting(report))
        self._note(root, found)
        self._read_only += found.generated
        installed = is_installed(root)
        for package in found.packages:
            indexed = Indexed.found(package)
            if installed:
                indexed = replace(indexed, rank=Rank.INSTALLED)
            self.packages.append(indexed)

    def _search_environment(self, report: Progress) -> None:
        for order, prefix in enumerate(self._environment.prefixes, start=1):
            self._search_prefix(prefix, report, order=order)
        for order, source in enumerate(self._environment.sources):
            found = discover(source, self.memory, progress=_counting(report))
            self._note(source, found)
            self.packages += [
                Indexed.found(one, from_environment=True, order=order) for one in found.packages
            ]

    def _search_prefix(self, prefix: Path, report: Progress, *, order: int) -> None:
        found = discover(prefix, self.memory, is_prefix=True, progress=_counting(report))
        self.packages += [Indexed.found(one, order=order) for one in found.packages]

    def _note(self, root: Path, found: Discovery) -> None:
        if found.complete:
            return
        self.problems.append(
            Problem(
                Severity.WARNING,
                "folder-too-large",
                f"Only the first {FOLDER_LIMIT:,} folders of {root} were searched for packages: "
                "open a smaller folder.",
                place=Place(str(root)),
            )
        )


def _install_beside(roots: Iterable[Path]) -> list[Path]:
    """Return what colcon installed beside an opened `src`: it may have packages without source."""
    beside = (root.parent / "install" for root in roots if root.name == "src")
    return [one for one in beside if is_install_space(one)]


def _package_path(path: Path) -> Path:
    real = Path(os.path.realpath(path))
    if not is_folder(real):
        raise UnreadableFileError(str(path), "is no folder: give another --package-path.")
    if is_too_wide(real):
        raise UnreadableFileError(str(path), "is too wide to serve: give a folder inside it.")
    return real


def _serve_chosen(served: ServedRoots, chosen: Iterable[Path]) -> ServedRoots:
    """A chosen folder is read only, as a package path is: it was not opened."""
    return served.with_roots((), [one for one in chosen if served.root_of(one) is None])


def _candidates(
    opened: Path, served: ServedRoots, memory: FolderMemory, report: Progress
) -> tuple[Candidate, ...]:
    folder = opened if is_folder(opened) else package_folder_of(opened)
    if folder is None or not served.serves(folder):
        return ()

    def progress(done: int, total: int) -> None:
        report("robot files", done, total)

    return tuple(robot_candidates(folder, served, progress, memory))


def _best(candidates: tuple[Candidate, ...]) -> Path | None:
    return next((one.path for one in candidates if one.openable), None)


def unpacked_folder(zip_path: Path, data_folder: Path) -> Path:
    """Return the folder for a zip of this content; it need not exist yet.

    Raises:
        UnreadableFileError: The zip cannot be read.
    """
    try:
        with zip_path.open("rb") as file:
            digest = hashlib.file_digest(file, "sha256").hexdigest()[:20]
    except OSError as error:
        raise UnreadableFileError(str(zip_path), f"cannot be read ({error.strerror}).") from error
    return data_folder / UPLOADS / digest


def _unpacked(zip_path: Path, data_folder: Path, report: Progress) -> Path:
    """Return the folder of a zip's content; edits after an earlier opening stay."""
    folder = unpacked_folder(zip_path, data_folder)
    uploads = folder.parent
    if is_folder(folder):
        return folder_to_open(folder)
    left = UPLOADS_QUOTA_BYTES - folder_bytes(uploads)
    if left <= 0:
        reason = f"{uploads} is full: delete folders there that you need no more."
        raise UnsafeArchiveError(str(zip_path), reason)
    limit_bytes = min(ZIP_SIZE_LIMIT_BYTES, left)
    label = f"unpacking {zip_path.name}"
    return unpack_zip(zip_path, folder, limit_bytes, lambda done, total: report(label, done, total))


def folder_bytes(folder: Path) -> int:
    """Return the size of all files below a folder; 0 when it does not exist."""
    sizes = 0
    for path, _, names in os.walk(folder):
        for name in names:
            with contextlib.suppress(OSError):  # deleted meanwhile
                sizes += Path(path, name).lstat().st_size
    return sizes


def _is_in(folder: Path, folders: Iterable[Path]) -> bool:
    return any(is_below(folder, one) for one in folders)


def _counting(report: Progress) -> Callable[[int, int], None]:
    return lambda done, total: report("folders", done, total)


def _ignore(_label: str, _done: int, _total: int) -> None:
    return
