"""The folder of a copy: what the last run of the original read, as it is edited now.

Packages lie in its `src` under their names, files of no package below `src/files`. Meshes are links
to the originals, each of which is served by itself: a copy reads those, its own files, and nothing
else, whatever its texts ask for.
"""

from __future__ import annotations

import contextlib
import os
import shutil
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Final, TypeAlias

from studio.documents.side_file import SideFile
from studio.errors import CommandError, DataFolderError, PackageError
from studio.files import is_file, write_whole
from studio.packages.manifest import FILE_NAME
from studio.packages.packing import companions
from studio.packages.roots import ServedRoots, package_folder_of
from studio.packages.workspace import Location, open_location

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

TEXTS_MAX_BYTES: Final = 2 << 20
"""Of all texts of a copy together."""
FILES_MAX: Final = 200
Size: TypeAlias = tuple[int, int]
"""Files and bytes."""
_SOURCE: Final = "src"
_OUTSIDE: Final = "files"


@dataclass(frozen=True, slots=True)
class Original:
    """What is copied.

    Attributes:
        entry: The entry file.
        texts: Bytes of each file of the last run, as edited, by its path.
        meshes: The files of its meshes.
        location: Its folders.
    """

    entry: Path
    texts: Mapping[str, bytes]
    meshes: tuple[Path, ...]
    location: Location
    beside: Size = (0, 0)
    """What the person has already, of other documents."""


def size_of(folder: Path) -> Size:
    """Return how many files of their own the copies below a folder have, and their bytes."""
    files = [one for one in folder.glob(f"*/{_SOURCE}/**/*") if not one.is_symlink()]
    sizes = [one.stat().st_size for one in files if one.is_file()]
    return len(sizes), sum(sizes)


def make_folder(original: Original, folder: Path) -> tuple[str, tuple[str, ...]]:
    """Write the folder of a copy; in another thread, for it may be many files.

    Returns:
        The entry file below the folder, and the originals of the meshes.

    Raises:
        CommandError: It is larger than a copy may be.
        DataFolderError: The disk refuses it.
    """
    files = original.beside[0] + len(original.texts)
    size = original.beside[1] + sum(map(len, original.texts.values()))
    if size > TEXTS_MAX_BYTES or files > FILES_MAX:
        raise CommandError(
            f"The copies of one person have {FILES_MAX} files of {TEXTS_MAX_BYTES >> 20} MB at "
            f"most, and these would be {files} of {size / (1 << 20):.1f} MB: discard another one."
        )
    places = _Places(original.texts, folder / _SOURCE)
    try:
        for above in (folder.parent.parent, folder.parent, folder):
            above.mkdir(mode=0o700, exist_ok=True)
        for path, data in original.texts.items():
            _write(places.of(Path(path)), data)
        _write_beside(original, places)
        meshes = _link_meshes(original, places)
    except OSError as error:
        shutil.rmtree(folder, ignore_errors=True)
        raise DataFolderError(str(folder), error.strerror or "not writable") from error
    return str(places.of(original.entry).relative_to(folder)), meshes


def location_of(folder: Path, entry: str, meshes: Iterable[str], data_folder: Path) -> Location:
    """Return what a document of the copy needs: its own files to write, the meshes to read.

    Raises:
        PackageError: The folder is gone.
    """
    found = open_location(folder / entry, (folder / _SOURCE,), data_folder, {})
    there = [Path(one) for one in meshes if is_file(Path(one))]
    served = ServedRoots((folder / _SOURCE,), there)
    return replace(found, root=folder / _SOURCE, served=served)


class _Places:
    """Where each file of the original is in the copy."""

    def __init__(self, files: Iterable[str], source: Path) -> None:
        self._source = source
        outside = [path for path in map(Path, files) if package_folder_of(path) is None]
        parents = [str(path.parent) for path in outside]
        self._top = Path(os.path.commonpath(parents)) if parents else None

    def of(self, path: Path) -> Path:
        """Return the place of a file; that of one far from all others is beside them."""
        package = package_folder_of(path)
        if package is not None:
            return self._source / package.name / path.relative_to(package)
        if self._top is not None and path.is_relative_to(self._top):
            return self._source / _OUTSIDE / path.relative_to(self._top)
        return self._source / _OUTSIDE / path.name


def _write(target: Path, data: bytes) -> None:
    target.parent.mkdir(parents=True, exist_ok=True)
    write_whole(target, data)


def _write_beside(original: Original, places: _Places) -> None:
    """Copy the manifests of its packages, and the variants and poses beside the entry file."""
    served = original.location.served
    files = {*map(Path, original.texts), *original.meshes}
    packages = {package for path in files if (package := package_folder_of(path)) is not None}
    entry = original.entry
    named = [package / FILE_NAME for package in packages]
    named += [SideFile(entry, kind, served).path for kind in ("variants", "poses")]
    for path in named:
        if is_file(path):
            with contextlib.suppress(PackageError):  # it is not served, or too large
                _write(places.of(path), served.read(path, TEXTS_MAX_BYTES))


def _link_meshes(original: Original, places: _Places) -> tuple[str, ...]:
    served = original.location.served
    found: dict[Path, None] = {}
    for mesh in original.meshes:
        found |= dict.fromkeys((mesh, *companions(mesh, served)))
    for path in found:
        target = places.of(path)
        target.parent.mkdir(parents=True, exist_ok=True)
        with contextlib.suppress(FileExistsError):
            target.symlink_to(path)
    return tuple(map(str, found))
