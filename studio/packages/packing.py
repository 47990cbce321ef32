"""Zips made while they are sent, never whole in memory or on disk, and the files in them."""

from __future__ import annotations

import os
import re
import zipfile
from dataclasses import dataclass
from datetime import UTC, datetime
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Final
from urllib.parse import unquote

from studio.errors import ExportError, OutsideRootsError, UnreadableFileError
from studio.files import is_file, is_temporary
from studio.settings import MESH_SIZE_LIMIT_BYTES, ZIP_SIZE_LIMIT_BYTES

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from studio.packages.roots import ServedRoots

FILE_LIMIT: Final = 20_000
_LEFT_OUT: Final = frozenset({".git", ".svn", ".hg", "__pycache__", ".cache"})
_FIRST_YEAR: Final = 1980
"""A zip knows no earlier one."""
_Date = tuple[int, int, int, int, int, int]
# One way to match any text, without backtracking: a mesh may be megabytes of blanks.
_NAMED: Final = {
    ".obj": re.compile(rb"^[ \t]*mtllib[ \t]+([^\r\n]+)", re.MULTILINE),
    ".mtl": re.compile(
        rb"^[ \t]*(?:map_\w+|bump|disp|decal|refl)[ \t]+([^\r\n]+)", re.MULTILINE | re.IGNORECASE
    ),
    ".dae": re.compile(rb"<init_from>\s*+(?:<ref>)?+([^<]++)<"),
    ".gltf": re.compile(rb'"uri"\s*:\s*"([^"]+)"'),
}
_LIMIT: Final = 200
"""Of the files that one mesh names."""
_READ_LIMIT: Final = 2_000
"""Names that are searched, whether or not something is there."""
_NAME_LIMIT_BYTES: Final = 4096
_TEXT_LIMIT_BYTES: Final = 256 << 20


@dataclass(frozen=True, slots=True)
class PackedFile:
    """One file of a zip: its name there, with `/`, and a file or the bytes it holds."""

    name: str
    source: Path | bytes


def package_files(folder: Path, name: str, served: ServedRoots) -> list[PackedFile]:
    """Return every file of a folder, as `name/...`; links to what is not served are left out.

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
    """Check that a zip is not larger than allowed.

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
    """Yield the zip piece by piece; a file that went meanwhile is left out."""
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
    """Return a name for a zip: bytes that are not valid UTF-8 become question marks."""
    return name.encode("utf-8", "replace").decode()


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
        """Do nothing: there is no buffer."""

    def close(self) -> None:
        """Do nothing: what was written can still be taken."""

    def taken(self) -> list[bytes]:
        """Return what was written since the last call."""
        chunks, self._chunks = self._chunks, []
        return chunks


def companions(mesh: Path, served: ServedRoots) -> list[Path]:
    """Return served files that a mesh names, directly or by another, in or below its folder."""
    found: dict[Path, None] = {}
    waiting = [mesh]
    while waiting and len(found) < _LIMIT:
        for path in _named_in(waiting.pop(), served):
            if path not in found and path != mesh and path.is_relative_to(mesh.parent):
                found[path] = None
                waiting.append(path)
    return list(found)


def _named_in(file: Path, served: ServedRoots) -> list[Path]:
    pattern = _NAMED.get(file.suffix.lower())
    if pattern is None:
        return []
    try:
        data = served.read(file, _TEXT_LIMIT_BYTES)
    except (OutsideRootsError, UnreadableFileError):
        return []
    found = islice(pattern.finditer(data), _READ_LIMIT)
    written = {one[1][:_NAME_LIMIT_BYTES].decode("utf-8", "replace").strip() for one in found}
    # Several may be in one line, behind options; and a name may have a blank in it.
    names = {name for one in written for name in (one, *one.split())}
    looked_for = sorted(name for name in names if not name.startswith("data:"))[:_READ_LIMIT]
    paths = (_served(file, name, served) for name in looked_for)
    return [path for path in paths if path is not None]


def _served(file: Path, name: str, served: ServedRoots) -> Path | None:
    for spelled in (name, unquote(name)):
        try:
            path = served.resolve(file.parent / spelled.replace("\\", "/").removeprefix("./"))
        except (OutsideRootsError, UnreadableFileError):
            continue
        if is_file(path):
            return path
    return None
