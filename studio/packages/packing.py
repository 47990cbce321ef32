"""Zips made while they are sent: never whole in memory or on disk, and nothing unserved in them."""

from __future__ import annotations

import os
import zipfile
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Final

from studio.errors import ExportError, OutsideRootsError, UnreadableFileError
from studio.files import is_temporary
from studio.packages.presence import is_file
from studio.settings import MESH_SIZE_LIMIT_BYTES, ZIP_SIZE_LIMIT_BYTES

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from studio.packages.roots import ServedRoots

FILE_LIMIT: Final = 20_000
_LEFT_OUT: Final = frozenset({".git", ".svn", ".hg", "__pycache__", ".cache"})
_FIRST_YEAR: Final = 1980
"""A zip knows no earlier one."""


@dataclass(frozen=True, slots=True)
class PackedFile:
    """One file of a zip: its name there, steps divided by `/`, and a file or the bytes it holds."""

    name: str
    source: Path | bytes


def package_files(folder: Path, name: str, served: ServedRoots) -> list[PackedFile]:
    """Every file of a folder, as `name/...`; links to what is not served are left out.

    Links to folders are not followed. Version control, caches and what a killed studio left are
    left out.

    Raises:
        ExportError: There are too many files.
    """
    files: list[PackedFile] = []
    for path, folders, names in os.walk(folder):
        folders[:] = sorted(one for one in folders if one not in _LEFT_OUT)
        inside = Path(path).relative_to(folder)
        for one in sorted(name for name in names if not is_temporary(name)):
            real = _served_file(Path(path) / one, served)
            if real is not None:
                files.append(PackedFile((Path(name) / inside / one).as_posix(), real))
        if len(files) > FILE_LIMIT:
            raise ExportError(str(folder), f"it holds more than {FILE_LIMIT:,} files")
    return files


def _served_file(path: Path, served: ServedRoots) -> Path | None:
    try:
        real = served.resolve(path)
    except (OutsideRootsError, UnreadableFileError):
        return None
    return real if is_file(real) else None


def check_size(files: Iterable[PackedFile], what: str) -> None:
    """See that a zip does not come to more than is ever packed.

    Raises:
        ExportError: It would.
    """
    total = 0
    for one in files:
        total += _size_of(one.source)
        if total > ZIP_SIZE_LIMIT_BYTES:
            limit_mb = ZIP_SIZE_LIMIT_BYTES >> 20
            raise ExportError(what, f"its files are more than {limit_mb} MB together")


def _size_of(source: Path | bytes) -> int:
    try:
        return len(source) if isinstance(source, bytes) else source.stat().st_size
    except OSError:
        return 0  # it went meanwhile, and will be left out


def zip_chunks(files: Iterable[PackedFile], served: ServedRoots) -> Iterator[bytes]:
    """The zip piece by piece; a file that went meanwhile is left out."""
    sink = _Sink()
    with zipfile.ZipFile(sink, "w", zipfile.ZIP_DEFLATED) as archive:
        for one in files:
            try:
                data, date = _read(one, served)
            except (OutsideRootsError, UnreadableFileError):
                continue
            entry = zipfile.ZipInfo(_spelled(one.name), date)
            entry.external_attr = 0o644 << 16
            archive.writestr(entry, data, zipfile.ZIP_DEFLATED)
            yield from sink.taken()
    yield from sink.taken()


def _spelled(name: str) -> str:
    """A name that a zip can hold: bytes that are no letters on this disk become question marks."""
    return name.encode("utf-8", "replace").decode()


_Date = tuple[int, int, int, int, int, int]


def _read(one: PackedFile, served: ServedRoots) -> tuple[bytes, _Date]:
    if isinstance(one.source, bytes):
        return one.source, _date(datetime.now(UTC))
    data = served.read(one.source, MESH_SIZE_LIMIT_BYTES)
    try:
        changed_s = one.source.stat().st_mtime
    except OSError:
        changed_s = 0.0
    return data, _date(datetime.fromtimestamp(changed_s, UTC))


def _date(when: datetime) -> _Date:
    year = max(when.year, _FIRST_YEAR)
    return (year, when.month, when.day, when.hour, when.minute, when.second)


class _Sink:
    """What a zip is written to: it keeps the bytes until they are taken."""

    def __init__(self) -> None:
        self._chunks: list[bytes] = []

    def write(self, data: bytes) -> int:
        """Keep bytes."""
        self._chunks.append(bytes(data))
        return len(data)

    def flush(self) -> None:
        """Nothing waits here."""

    def close(self) -> None:
        """What was written is taken all the same."""

    def taken(self) -> list[bytes]:
        """What was written since the last time."""
        chunks, self._chunks = self._chunks, []
        return chunks
