"""The folders that may be read: every file of a user is opened here, nowhere else."""

from __future__ import annotations

import errno
import os
import stat
from pathlib import Path
from typing import TYPE_CHECKING, Final

from studio.errors import OutsideRootsError, UnreadableFileError
from studio.files import is_file, is_folder, is_there, is_writable
from studio.settings import SOURCE_SIZE_LIMIT_BYTES

if TYPE_CHECKING:
    from collections.abc import Iterable

# O_NONBLOCK: a pipe that took the file's place must not hang us. Windows lacks some of these.
_FILE_FLAGS: Final = (
    os.O_RDONLY
    | getattr(os, "O_NONBLOCK", 0)
    | getattr(os, "O_NOFOLLOW", 0)
    | getattr(os, "O_CLOEXEC", 0)
    | getattr(os, "O_BINARY", 0)
)
_FOLDER_FLAGS: Final = _FILE_FLAGS | getattr(os, "O_DIRECTORY", 0)
_CAN_WALK: Final = os.open in os.supports_dir_fd and hasattr(os, "O_NOFOLLOW")
_CHUNK_BYTES: Final = 1 << 20
_MARKER_LEVELS: Final = 3


class NotRegularError(OSError):
    """The name is of a folder, pipe, device or socket."""


def open_regular(root: Path, resolved: Path) -> int:
    """Open a file at or below `root`; both are resolved. Returns the descriptor.

    Each folder on the way is opened from the one before it and must not be a link: comparing
    paths before and after is not enough, as a folder can be swapped between two checks.

    Raises:
        NotRegularError: It is no regular file.
        OSError: It cannot be opened, or a link is on the way now.
    """
    descriptor = _walk(root, resolved) if _CAN_WALK else os.open(resolved, _FILE_FLAGS)
    if stat.S_ISREG(os.fstat(descriptor).st_mode):
        return descriptor
    os.close(descriptor)
    raise NotRegularError


def _walk(root: Path, resolved: Path) -> int:
    top = root.parent if root == resolved else root
    *folders, name = resolved.relative_to(top).parts
    folder = os.open(top, _FOLDER_FLAGS)
    try:
        for step in folders:
            inner = os.open(step, _FOLDER_FLAGS, dir_fd=folder)
            os.close(folder)
            folder = inner
        # Opening a device may already act on it, so check first.
        if not stat.S_ISREG(os.stat(name, dir_fd=folder, follow_symlinks=False).st_mode):
            raise NotRegularError
        return os.open(name, _FILE_FLAGS, dir_fd=folder)
    finally:
        os.close(folder)


class ServedRoots:
    """Folders (or single files) below which files may be read, and which of them may be written.

    Symlinks are resolved first. `read_only` folders are served, too; where one is inside a writable
    root, or the other way round, the innermost decides.
    """

    def __init__(self, roots: Iterable[Path], read_only: Iterable[Path] = ()) -> None:
        self.writable = _resolved(roots)
        self.read_only = tuple(one for one in _resolved(read_only) if one not in self.writable)
        self.all = self.writable + self.read_only

    def __repr__(self) -> str:
        return f"ServedRoots({self.writable!r}, read_only={self.read_only!r})"

    def with_roots(self, roots: Iterable[Path], read_only: Iterable[Path] = ()) -> ServedRoots:
        """Serve these as well."""
        return ServedRoots((*self.writable, *roots), (*self.read_only, *read_only))

    def resolve(self, path: Path | str) -> Path:
        """Follow all symlinks of a path, which need not exist, and check that it stays inside.

        Raises:
            OutsideRootsError: It leads out of the served folders.
            UnreadableFileError: It cannot be a file name, or vanished while it was followed.
        """
        return self._locate(path)[0]

    def serves(self, path: Path | str) -> bool:
        """Whether `resolve` lets a path through."""
        try:
            self.resolve(path)
        except (OutsideRootsError, UnreadableFileError):
            return False
        return True

    def root_of(self, resolved: Path) -> Path | None:
        """Return the innermost served folder that holds an already resolved path."""
        holding = (root for root in self.all if is_below(resolved, root))
        return max(holding, key=lambda root: len(root.parts), default=None)

    def read(self, path: Path | str, limit_bytes: int = SOURCE_SIZE_LIMIT_BYTES) -> bytes:
        """Read a regular file whole.

        Raises:
            OutsideRootsError: It leads out of the served folders.
            UnreadableFileError: Missing, no regular file, not permitted, or over `limit_bytes`.
        """
        real, root = self._locate(path)
        try:
            descriptor = open_regular(root, real)
            try:
                return _read_all(descriptor, str(path), limit_bytes)
            finally:
                os.close(descriptor)
        except NotRegularError as error:
            raise UnreadableFileError(str(path), _what_it_is(real)) from error
        except OSError as error:
            raise UnreadableFileError(str(path), _os_reason(error)) from error

    def may_write(self, path: Path | str) -> bool:
        """Whether a file can be saved: inside a writable root, and permitted by the system.

        A save renames a new file into place, so the folder must be writable as well.
        """
        try:
            real, root = self._locate(path)
        except (OutsideRootsError, UnreadableFileError):
            return False
        if root not in self.writable or not is_writable(real.parent):
            return False
        return not is_there(real) or (is_file(real) and is_writable(real))

    def _locate(self, path: Path | str) -> tuple[Path, Path]:
        """Return the real path, and the innermost root that holds it."""
        try:
            real = Path(os.path.realpath(path))
        except ValueError as error:  # a NUL character
            raise UnreadableFileError(repr(str(path)), "is no file name.") from error
        except OSError as error:
            raise UnreadableFileError(str(path), _os_reason(error)) from error
        root = self.root_of(real)
        if root is None:
            raise OutsideRootsError(str(path))
        return real, root


def is_below(path: Path, folder: Path) -> bool:
    """Whether a path is a folder or below it; both resolved, the disk is not read."""
    inner, outer = os.path.normcase(path), os.path.normcase(folder)
    return inner == outer or inner.startswith(outer.rstrip(os.sep) + os.sep)


def served_roots_for(opened: Path) -> tuple[Path, ...]:
    """Choose what opening a path serves.

    A folder: that folder. A file: its package and the packages beside it, that is the colcon `src`
    or else the nearest folder with `.git` at most three levels above the package; without one, the
    package and each package folder directly beside it, and nothing else that lies there (it may be
    a folder of downloads). A file in no package: its folder.
    Never the file system's root or the home folder: a file that lies there is served alone.

    Raises:
        UnreadableFileError: A folder was named that is too wide to serve, or nothing is there.
    """
    real = Path(os.path.realpath(opened))
    try:
        mode = real.stat().st_mode
    except OSError as error:
        raise UnreadableFileError(str(opened), _os_reason(error)) from error
    if stat.S_ISDIR(mode):
        if is_too_wide(real):
            raise UnreadableFileError(str(real), "is too wide to open: choose a folder inside it.")
        return (real,)
    package = package_folder_of(real)
    if package is None:
        return (real,) if is_too_wide(real.parent) else (real.parent,)
    return _package_and_neighbours(package)


def package_folder_of(path: Path) -> Path | None:
    """Return the nearest folder at or above a path that holds a package.xml; never `/` or home."""
    for folder in (path, *path.parents):
        if is_too_wide(folder):
            return None
        if is_file(folder / "package.xml"):
            return folder
    return None


def is_too_wide(folder: Path) -> bool:
    """Whether a folder is the file system's root, the home folder, or holds it."""
    home = Path(os.path.realpath(os.path.expanduser("~")))  # noqa: PTH111 - `Path.home` may raise
    return folder == Path(folder.anchor) or is_below(home, folder)


def _package_and_neighbours(package: Path) -> tuple[Path, ...]:
    levels: list[Path] = []
    for folder in package.parents[:_MARKER_LEVELS]:
        if is_too_wide(folder):
            break
        levels.append(folder)
    marked = _marked(package, levels)
    if marked is not None:
        return (marked,)
    beside = _child_packages(levels[0]) if levels else []
    return (package, *(one for one in beside if one != package))


def _marked(package: Path, levels: list[Path]) -> Path | None:
    """The `src` of a workspace wins over `.git`: packages of several repositories lie in one src.

    The package may be a whole repository itself, and still need those beside it in `src`.
    """
    source = next((one for one in levels if one.name == "src"), None)
    if source is not None:
        return source
    return next((one for one in (package, *levels) if is_there(one / ".git")), None)


def _child_packages(folder: Path) -> list[Path]:
    try:
        with os.scandir(folder) as entries:
            names = sorted(one.name for one in entries if one.is_dir(follow_symlinks=False))
    except OSError:
        return []
    return [folder / name for name in names if is_file(folder / name / "package.xml")]


def _resolved(folders: Iterable[Path]) -> tuple[Path, ...]:
    return tuple(dict.fromkeys(Path(os.path.realpath(one)) for one in folders))


def _what_it_is(real: Path) -> str:
    if real.is_symlink():  # all links were followed, so this one never ends
        return "is a link that leads back to itself."
    if is_folder(real):
        return "is a folder, not a file."
    return "is no regular file but a pipe, device or socket, and was not read."


def _os_reason(error: OSError) -> str:
    if isinstance(error, FileNotFoundError | NotADirectoryError):
        return "does not exist."
    if isinstance(error, PermissionError):
        return "may not be read: its permissions forbid it."
    if error.errno == errno.ELOOP:  # a link that was none a moment ago
        return "was replaced while it was opened: try again."
    return f"cannot be read ({error.strerror or type(error).__name__})."


def _read_all(descriptor: int, path: str, limit_bytes: int) -> bytes:
    """Read to the end, counting: the size of a file under `/proc`, for example, is 0."""
    chunks: list[bytes] = []
    left = limit_bytes + 1
    while left > 0 and (chunk := os.read(descriptor, min(left, _CHUNK_BYTES))):
        chunks.append(chunk)
        left -= len(chunk)
    if left <= 0:
        limit_mb = limit_bytes / (1 << 20)
        raise UnreadableFileError(path, f"is larger than {limit_mb:.4g} MB and was not read.")
    return b"".join(chunks)
