"""Files sent by a browser: stored whole or not at all, and put where descriptions find them."""

from __future__ import annotations

import hashlib
import itertools
import os
import re
import shutil
from collections import Counter
from contextlib import suppress
from datetime import UTC, datetime
from pathlib import Path, PurePosixPath
from typing import IO, TYPE_CHECKING, Final, NamedTuple

import msgspec

from studio.errors import UploadError
from studio.files import is_there
from studio.packages.archive import is_plain_step
from studio.packages.folder_memory import is_robot_name
from studio.packages.manifest import FILE_NAME, SIZE_LIMIT_BYTES, package_name
from studio.packages.workspace import UPLOADS, folder_bytes
from studio.settings import SOURCE_SIZE_LIMIT_BYTES, UPLOADS_QUOTA_BYTES, ZIP_SIZE_LIMIT_BYTES

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

FILE_LIMIT: Final = 10_000
MANIFEST_LIMIT_BYTES: Final = 4 << 20
_PATH_LIMIT_BYTES: Final = 1000
_STEP_LIMIT_BYTES: Final = 200
_STAGING: Final = ".sending-"
_FORGOTTEN_AFTER_S: Final = 24 * 3600
"""A staging folder this old was left behind by a studio that was killed."""
_COUNT: Final = itertools.count(1)
_IN_PACKAGE: Final = re.compile(
    r"(?:(?:package|model)://|\$\(find(?:-pkg-share)?\s+)([A-Za-z0-9_.-]{1,200})\)?/"
    r"([^\"'<>\r\n${}]{1,500}\.\w{1,10})"
)
_BESIDE: Final = re.compile(r"filename\s*=\s*[\"']([^\"'<>:${}\r\n]{1,500}\.\w{1,10})[\"']")
_REFERENCES_READ: Final = 20_000


class SentFile(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """One file as announced: its path below what was dropped, and its size in bytes."""

    path: str
    size: int


_MANIFEST: Final = msgspec.json.Decoder(list[SentFile])


def read_manifest(line: bytes) -> tuple[SentFile, ...]:
    """Return the announced files, each under a name that stays below its folder.

    Raises:
        UploadError: It is no such list, or a file is not accepted; the sentence says why.
    """
    try:
        files = tuple(_MANIFEST.decode(line))
    except (msgspec.MsgspecError, UnicodeDecodeError) as error:
        raise UploadError("the list of files cannot be read.") from error
    if not files:
        raise UploadError("there is no file: choose a .xacro, a .urdf, a .zip or a folder.")
    if len(files) > FILE_LIMIT:
        raise UploadError(f"there are {len(files):,} files, more than {FILE_LIMIT:,}.")
    for one in files:
        _check(one)
    _refuse_clashes([one.path for one in files])
    if len(files) > 1 and any(is_zip(one) for one in files):
        raise UploadError("a .zip is opened by itself: drop it alone.")
    return files


def is_zip(file: SentFile) -> bool:
    """Whether it is to be unpacked."""
    return file.path.lower().endswith(".zip")


class Upload:
    """One upload, in a folder that nothing serves; use it as a context.

    `write` takes the bytes of all files in their order, in chunks of any size. Unless `finish` was
    reached, nothing is left behind.
    """

    def __init__(
        self,
        data_folder: Path,
        files: Sequence[SentFile],
        reserved_bytes: int = 0,
        quota_bytes: int = UPLOADS_QUOTA_BYTES,
    ) -> None:
        self._uploads, self._files = data_folder / UPLOADS, files
        self._reserved_bytes, self._quota_bytes = reserved_bytes, quota_bytes
        self.size_bytes = sum(one.size for one in files)
        self._staging = self._uploads / f"{_STAGING}{os.getpid()}-{next(_COUNT)}"
        self._digest = hashlib.sha256()
        self._left: Iterator[SentFile] = iter(())
        self._file: IO[bytes] | None = None
        self._missing_bytes = 0
        """Of the file that is being written."""

    def __enter__(self) -> Upload:
        """Make room.

        Raises:
            UploadError: It is too large, the quota is used up, or the disk is full.
        """
        if self.size_bytes > ZIP_SIZE_LIMIT_BYTES:
            raise UploadError(
                f"{_mb(self.size_bytes)} are more than {_mb(ZIP_SIZE_LIMIT_BYTES)}: "
                "open what is larger by its path, with `studio open PATH`."
            )
        _sweep(self._uploads)
        used = folder_bytes(self._uploads) + self._reserved_bytes
        if used + self.size_bytes > self._quota_bytes:
            raise UploadError(
                f"{_mb(self.size_bytes)} more would pass the {_mb(self._quota_bytes)} that uploads "
                f"may take: delete folders in {self._uploads} that you need no more."
            )
        try:
            self._staging.mkdir(parents=True)
        except OSError as error:
            raise _refused(error) from error
        self._left = iter(self._files)
        return self

    def __exit__(self, *_: object) -> None:
        """Take away what was not finished."""
        if self._file is not None:
            with suppress(OSError):  # what could not be written cannot be flushed either
                self._file.close()
        shutil.rmtree(self._staging, ignore_errors=True)

    def write(self, chunk: bytes) -> None:
        """Take the next bytes.

        Raises:
            UploadError: More came than was announced, or the disk is full.
        """
        rest = memoryview(chunk)
        try:
            while rest:
                self._go_on()
                part = rest[: self._missing_bytes]
                self._put(part)
                rest = rest[len(part) :]
        except OSError as error:
            raise _refused(error) from error

    def finish(self) -> Path:
        """Return the folder with all files, after everything was sent.

        Raises:
            UploadError: Less came than was announced, or the disk is full.
        """
        try:
            while self._missing_bytes == 0 and self._next():
                pass  # empty files
            if self._missing_bytes:
                raise UploadError("the sending broke off: drop the files again.")
            if self._file is not None:
                self._file.close()
                self._file = None
        except OSError as error:
            raise _refused(error) from error
        return self._staging

    def keep(self) -> tuple[Path, bool]:
        """Move what was sent to its lasting place; whether it is a new one.

        The same files sent again lead to the folder of the first time, edits and all.

        Raises:
            UploadError: It cannot be moved.
        """
        lasting = self._uploads / self._digest.hexdigest()[:20]
        if is_there(lasting):
            return lasting, False
        try:
            self._staging.rename(lasting)
        except OSError as error:
            if is_there(lasting):  # the same files, sent twice at once
                return lasting, False
            raise _refused(error) from error
        return lasting, True

    def _go_on(self) -> None:
        while self._missing_bytes == 0:
            if not self._next():
                raise UploadError("more was sent than announced.")

    def _next(self) -> bool:
        """Begin the next file; False when there is none."""
        if self._file is not None:
            self._file.close()
            self._file = None
        announced = next(self._left, None)
        if announced is None:
            return False
        target = self._staging.joinpath(*PurePosixPath(announced.path).parts)
        target.parent.mkdir(parents=True, exist_ok=True)
        self._file = target.open("xb")
        self._missing_bytes = announced.size
        self._digest.update(msgspec.json.encode(announced))
        return True

    def _put(self, part: memoryview) -> None:
        assert self._file is not None
        self._file.write(part)
        self._digest.update(part)
        self._missing_bytes -= len(part)


def _check(file: SentFile) -> None:
    steps = file.path.split("/")
    shown = file.path[:120]
    if not all(_is_step(step) for step in steps) or len(file.path.encode()) > _PATH_LIMIT_BYTES:
        raise UploadError(f'"{shown}" is no file name that can be kept.')
    if file.size < 0:
        raise UploadError(f'"{shown}" has no size.')
    if is_robot_name(steps[-1]) and file.size > SOURCE_SIZE_LIMIT_BYTES:
        raise UploadError(
            f'"{shown}" has {_mb(file.size)}, and a description may have '
            f"{_mb(SOURCE_SIZE_LIMIT_BYTES)}: put large data into meshes."
        )


def _is_step(step: str) -> bool:
    try:
        length = len(step.encode())
    except UnicodeEncodeError:  # half a surrogate pair
        return False
    return (
        0 < length <= _STEP_LIMIT_BYTES and step != "." and "\\" not in step and is_plain_step(step)
    )


def _refuse_clashes(paths: Sequence[str]) -> None:
    """No name twice, and none that is a folder elsewhere; systems that fold case count, too."""
    seen: set[str] = set()
    for path in paths:
        if path.casefold() in seen:
            raise UploadError(f'"{path[:120]}" is among the files more than once.')
        seen.add(path.casefold())
    for path in paths:
        for folder in PurePosixPath(path).parents:
            if str(folder).casefold() in seen:
                raise UploadError(f'"{folder}" is a file and a folder at once.')


def _sweep(uploads: Path) -> None:
    """Delete what a studio that was killed left behind."""
    with suppress(OSError):
        for left in uploads.glob(f"{_STAGING}*"):
            age_s = datetime.now(UTC).timestamp() - left.stat().st_mtime
            if age_s > _FORGOTTEN_AFTER_S:
                shutil.rmtree(left, ignore_errors=True)


def _mb(size_bytes: int) -> str:
    return f"{size_bytes / (1 << 20):,.4g} MB"


def _refused(error: OSError) -> UploadError:
    return UploadError(f"the data folder cannot take it ({error.strerror or 'not writable'}).")


class Reference(NamedTuple):
    """A file that a description names; with an empty `package` it is relative."""

    package: str
    inside: str
    """Its path in the package, or relative to the folder of the description."""


def arrange(folder: Path) -> dict[str, Path]:
    """Move the files of a folder to where descriptions expect them.

    A browser sends only names, so a robot and its meshes, dropped together, lie side by side,
    where `package://my_robot/meshes/base.stl` finds nothing. Each file that is named, is missing,
    and exists elsewhere under the same name is moved to its place.

    Returns:
        For each package without a package.xml its folder, relative to `folder`.
    """
    return _Arranging(folder).run()


class _Arranging:
    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._files = {one: one.relative_to(folder) for one in _files_below(folder)}
        self._moved: dict[Path, Path] = {}

    def run(self) -> dict[str, Path]:
        texts = [one for one in self._files if is_robot_name(one.name)]
        named = {one: _references(one) for one in texts}
        known = self._packages()
        wanted = _by_package(named.values(), known)
        chosen = {name: self._stand_in(name, inside) for name, inside in wanted.items()}
        for file, references in named.items():
            folder = self._moved.get(file, file).parent
            for one in references:
                if one.package == "":
                    self._bring(folder, one.inside)
        return {name: found for name, found in chosen.items() if found is not None}

    def _packages(self) -> set[str]:
        manifests = (one for one in self._files if one.name == FILE_NAME)
        return {package_name(_start_of(one, SIZE_LIMIT_BYTES)) or "" for one in manifests}

    def _stand_in(self, package: str, wanted: dict[str, None]) -> Path | None:
        """Return the folder with most of the wanted files, or one to put them into."""
        holding = Counter(folder for one in wanted for folder in self._holders(one))
        if holding:
            return holding.most_common(1)[0][0]
        if not is_plain_step(package):
            return None
        brought = [self._bring(self._folder / package, one) for one in wanted]
        return Path(package) if any(brought) else None

    def _holders(self, inside: str) -> Iterator[Path]:
        """Folders in which a file lies at this path; not the folder of all, for a bare name."""
        steps = PurePosixPath(inside).parts
        for path in self._files.values():
            if len(steps) > 1 and path.parts[-len(steps) :] == steps:
                yield Path(*path.parts[: -len(steps)])

    def _bring(self, folder: Path, inside: str) -> bool:
        """Move the one file of this name to where it is expected, unless something is there."""
        target = Path(os.path.normpath(folder / inside.lstrip("/")))
        steps = target.parts[len(self._folder.parts) :]
        is_below = target.parts[: len(self._folder.parts)] == self._folder.parts
        if not is_below or not all(map(is_plain_step, steps)) or target in self._files:
            return target in self._files
        named = [one for one in self._files if one.name == target.name]
        if len(named) != 1 or any(parent in self._files for parent in target.parents):
            return False
        target.parent.mkdir(parents=True, exist_ok=True)
        named[0].rename(target)
        del self._files[named[0]]
        self._files[target] = target.relative_to(self._folder)
        self._moved[named[0]] = target
        return True


def _by_package(
    named: Iterable[tuple[Reference, ...]], known: set[str]
) -> dict[str, dict[str, None]]:
    """Return the missing files of each package that is not among the files."""
    wanted: dict[str, dict[str, None]] = {}
    for one in (reference for references in named for reference in references):
        if one.package and one.package not in known:
            wanted.setdefault(one.package, {})[one.inside] = None
    return wanted


def _references(file: Path) -> tuple[Reference, ...]:
    text = _start_of(file, SOURCE_SIZE_LIMIT_BYTES).decode("utf-8", "replace")
    found = {Reference(one[1], one[2]): None for one in _IN_PACKAGE.finditer(text)}
    found |= {Reference("", one[1]): None for one in _BESIDE.finditer(text)}
    return tuple(found)[:_REFERENCES_READ]


def _start_of(file: Path, limit_bytes: int) -> bytes:
    with file.open("rb") as opened:
        return opened.read(limit_bytes)


def _files_below(folder: Path) -> Iterator[Path]:
    for path, _, names in os.walk(folder):
        for name in names:
            yield Path(path, name)
