"""Unpacks a zip that may be hostile: only files, only below one folder, only so many bytes."""

from __future__ import annotations

import os
import shutil
import stat
import struct
import zipfile
import zlib
from pathlib import Path, PurePosixPath
from typing import IO, TYPE_CHECKING, Final

from studio.errors import UnsafeArchiveError
from studio.files import is_file, is_folder

if TYPE_CHECKING:
    from collections.abc import Callable

ENTRY_LIMIT: Final = 100_000
RATIO_LIMIT: Final = 200
"""Unpacked over packed size of the whole; deflate of real packages stays below 20."""
_SMALL_BYTES: Final = 50 << 20
"""Below this the ratio does not count: a small file of zeros is no bomb."""
_CHUNK_BYTES: Final = 1 << 18
_SYSTEM_FOLDERS: Final = frozenset({"__MACOSX"})
_METHODS: Final = frozenset({zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED})
_DIRECTORY_LIMIT_BYTES: Final = 64 << 20
_END: Final = struct.Struct("<4s8xII2x")
"""The end record: signature, size of the list of entries, its offset."""
_END64: Final = struct.Struct("<4s36xQ8x")
_LOCATOR64_BYTES: Final = 20
_DAMAGED: Final = (
    zipfile.BadZipFile,
    zlib.error,
    EOFError,
    ValueError,
    RuntimeError,  # and with it NotImplementedError: what the zipfile module does not know
    struct.error,
)


def unpack_zip(
    zip_path: Path,
    into: Path,
    limit_bytes: int,
    progress: Callable[[int, int], None] | None = None,
) -> Path:
    """Unpack into a folder that must not exist yet; it appears only when all went well.

    Returns the folder to open: the single folder at the top, when there is nothing beside it.
    `progress` is called with (bytes written, bytes to write).

    Raises:
        UnsafeArchiveError: A name leads outside, an entry is no plain file, the whole is too large
            or too many files, it is encrypted or damaged. Nothing is left behind.
    """
    partial = into.with_name(f"{into.name}.partial-{os.getpid()}")
    try:
        _check_directory(zip_path)
        partial.mkdir(parents=True)
        with zipfile.ZipFile(zip_path) as archive:
            _Unpacking(zip_path, partial, limit_bytes, progress).run(archive)
        partial.rename(into)
    except _DAMAGED as error:
        raise UnsafeArchiveError(str(zip_path), f"it is damaged ({error}).") from error
    except OSError as error:
        reason = error.strerror or type(error).__name__
        raise UnsafeArchiveError(str(zip_path), f"the system refused ({reason}).") from error
    finally:
        shutil.rmtree(partial, ignore_errors=True)
    return folder_to_open(into)


def _check_directory(zip_path: Path) -> None:
    """Refuse a list of entries that would fill the memory when the zipfile module reads it."""
    if not is_file(zip_path):
        raise UnsafeArchiveError(str(zip_path), "it is no file.")
    size = zip_path.stat().st_size
    with zip_path.open("rb") as file:
        file.seek(max(0, size - (1 << 16) - _END.size - _LOCATOR64_BYTES - _END64.size))
        tail = file.read()
    at = tail.rfind(b"PK\x05\x06")
    if at < 0 or len(tail) - at < _END.size:
        raise UnsafeArchiveError(str(zip_path), "it is no zip.")
    _, directory_bytes, _ = _END.unpack_from(tail, at)
    at64 = at - _LOCATOR64_BYTES - _END64.size
    if at64 >= 0 and tail.startswith(b"PK\x06\x06", at64):
        directory_bytes = max(directory_bytes, _END64.unpack_from(tail, at64)[1])
    if directory_bytes > min(size, _DIRECTORY_LIMIT_BYTES):
        raise UnsafeArchiveError(str(zip_path), "its list of files is damaged or far too long.")


def folder_to_open(unpacked: Path) -> Path:
    """Enter the single folder at the top of what was unpacked."""
    inside = [one for one in unpacked.iterdir() if not one.name.startswith(".")]
    return inside[0] if len(inside) == 1 and is_folder(inside[0]) else unpacked


class _Unpacking:
    """One unpacking; `written` counts real bytes, as the sizes in a zip may lie."""

    def __init__(
        self,
        zip_path: Path,
        into: Path,
        limit_bytes: int,
        progress: Callable[[int, int], None] | None,
    ) -> None:
        self._zip, self._into, self._progress = zip_path, into, progress
        packed = zip_path.stat().st_size
        self._limit = min(limit_bytes, max(_SMALL_BYTES, packed * RATIO_LIMIT))
        self._written = self._total = 0

    def run(self, archive: zipfile.ZipFile) -> None:
        entries = [entry for entry in archive.infolist() if not _is_system(entry)]
        if len(entries) > ENTRY_LIMIT:
            raise self._unsafe(f"it holds more than {ENTRY_LIMIT:,} files.")
        targets = [(entry, self._target(entry)) for entry in entries]
        self._refuse_clashes([target for entry, target in targets if not entry.is_dir()])
        self._total = sum(entry.file_size for entry in entries)
        if self._total > self._limit:
            raise self._too_large()
        for entry, target in targets:
            self._unpack(archive, entry, target)

    def _target(self, entry: zipfile.ZipInfo) -> Path:
        """Return the path of an entry, after everything about it was found harmless."""
        if entry.flag_bits & 0x1:
            raise self._unsafe("it is encrypted: unpack it by hand and open the folder.")
        if entry.compress_type not in _METHODS:
            raise self._unsafe(f'"{entry.filename}" is packed in a way that is not supported.')
        kind = stat.S_IFMT(entry.external_attr >> 16)
        if kind not in (0, stat.S_IFREG, stat.S_IFDIR):
            what = "a link" if kind == stat.S_IFLNK else "a device or pipe"
            raise self._unsafe(f'"{entry.filename}" is {what}, which is never unpacked.')
        name = entry.orig_filename.replace("\\", "/")  # some programs of Windows write these
        steps = PurePosixPath(name).parts
        if not steps or name.startswith("/") or not all(map(is_plain_step, steps)):
            raise self._unsafe(f'the name "{name}" leads outside or is no file name.')
        return self._into.joinpath(*steps)

    def _refuse_clashes(self, targets: list[Path]) -> None:
        seen: set[Path] = set()
        for target in targets:
            if target in seen:
                name = target.relative_to(self._into)
                raise self._unsafe(f'the name "{name}" is in it more than once.')
            seen.add(target)

    def _unpack(self, archive: zipfile.ZipFile, entry: zipfile.ZipInfo, target: Path) -> None:
        if entry.is_dir():
            target.mkdir(parents=True, exist_ok=True)
            return
        target.parent.mkdir(parents=True, exist_ok=True)
        with archive.open(entry) as packed, target.open("xb") as file:
            self._copy(packed, file)

    def _copy(self, packed: IO[bytes], file: IO[bytes]) -> None:
        while chunk := packed.read(_CHUNK_BYTES):
            self._written += len(chunk)
            if self._written > self._limit:
                raise self._too_large()
            file.write(chunk)
            if self._progress is not None:
                self._progress(self._written, self._total)

    def _too_large(self) -> UnsafeArchiveError:
        return self._unsafe(f"it would unpack to more than {self._limit / (1 << 20):.4g} MB.")

    def _unsafe(self, reason: str) -> UnsafeArchiveError:
        return UnsafeArchiveError(str(self._zip), reason)


def _is_system(entry: zipfile.ZipInfo) -> bool:
    return PurePosixPath(entry.filename).parts[:1] in {(name,) for name in _SYSTEM_FOLDERS}


def is_plain_step(step: str) -> bool:
    """Whether one step of a name stays a name: no `..`, drive, stream or control character."""
    forbidden = ':<>"|?*' if os.name == "nt" else ""
    return step != ".." and step.isprintable() and not any(one in step for one in forbidden)
