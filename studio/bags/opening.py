"""Opening a bag: which files belong to it, and what reads each."""

from __future__ import annotations

import contextlib
import os
import re
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Final

from studio.bags import index_cache, queries, unpacking
from studio.bags.bag import Bag
from studio.bags.blocks import Outline
from studio.bags.bounded_cache import BoundedCache
from studio.bags.compression import ZSTD_MAGIC
from studio.bags.index_cache import IndexCache
from studio.bags.mcap_file import McapFile, opened
from studio.bags.mcap_index import McapIndex, read_summary
from studio.bags.mending import rebuilt_index
from studio.bags.metadata import METADATA_NAME, BagMetadata, read_metadata
from studio.bags.sqlite_file import SqliteFile
from studio.bags.unpacking import UnpackedFiles
from studio.errors import BagNotReadableError, DamagedPartError, DataFolderError
from studio.files import is_file, is_folder, stamp_of
from studio.settings import data_folder

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from studio.bags.blocks import BlockFile
    from studio.files import Stamp

CHUNK_CACHE_BYTES: Final = 64 * 2**20
INDEX_CACHE_BYTES: Final = 32 * 2**20
STORAGES: Final = {".mcap": "mcap", ".db3": "sqlite3"}
ZSTD: Final = ".zstd"
KEPT_AFTER_S: Final = 0.03
"""An index that took longer to make is kept in the data folder."""


def open_bag(
    path: Path,
    progress: Callable[[float], None] | None = None,
    *,
    kept_in: Path | None = None,
    by_files: bool = False,
) -> Bag:
    """Open a bag.

    For a bag of any size, decompressed chunks take 64 MB of memory, and the indexes of their
    messages 32 MB, unless one chunk alone is larger. Besides, each chunk of a file takes 41 bytes,
    and 20 for each topic in it.

    Args:
        path: A folder of rosbag2, its `metadata.yaml`, or one `.mcap` or `.db3` file.
        progress: Is told the share that is done, 0 to 1, while an index has to be made.
        kept_in: The folder where indexes and unpacked files are kept; None: the studio's.
        by_files: Whether the files that lie in the folder are read, whatever its metadata names.

    Raises:
        BagNotReadableError: There is no bag, or nothing of it can be read.
    """
    found = _found(path, by_files=by_files)
    reading = _Reading(_kept_in(kept_in), found, progress)
    files: list[BlockFile] = []
    sources: list[Path] = []
    troubles = list(found.troubles)
    for one in found.files:
        try:
            files.append(reading.opened(one))
            sources.append(one)
        except BagNotReadableError as error:
            troubles.append(f"{one.name} is left out: {error.reason}.")
    if not files:
        reason = " ".join(troubles).removesuffix(".") or "it holds no files of a bag"
        raise BagNotReadableError(str(path), reason)
    return Bag(path, found.storage, files, sources, found.metadata, troubles)


def open_together(paths: Sequence[Path]) -> Bag:
    """Open bags as one, with all their topics and messages by time.

    Raises:
        BagNotReadableError: One of them cannot be read.
    """
    with contextlib.ExitStack() as stack:
        bags = [stack.enter_context(contextlib.closing(open_bag(one))) for one in paths]
        stack.pop_all()
    return bags[0] if len(bags) == 1 else Bag.together(bags)


def _kept_in(chosen: Path | None) -> Path:
    """Return the folder for what is kept; where the studio has none, one of the system's."""
    try:
        return data_folder(chosen)
    except DataFolderError:
        return Path(tempfile.gettempdir()) / "studio-bags"


class _Reading:
    """Opens the files of one bag, which share what is kept of them."""

    def __init__(
        self, folder: Path, found: _Found, progress: Callable[[float], None] | None
    ) -> None:
        self._found, self._progress = found, progress
        self._kept = IndexCache(folder / index_cache.FOLDER)
        self._unpacked = UnpackedFiles(folder / unpacking.FOLDER)
        self._chunks = BoundedCache[bytes](CHUNK_CACHE_BYTES)
        self._indexes = BoundedCache[object](INDEX_CACHE_BYTES)
        self._done = 0

    def opened(self, file: Path) -> BlockFile:
        """Open one file.

        Raises:
            BagNotReadableError: Nothing of it can be read.
        """
        if file.name.endswith(ZSTD):
            file = self._unpacked.unpacked(file, self._told)
        if file.name.endswith(".db3"):
            made = SqliteFile(file, self._indexes, self._told)
        else:
            made = self._mcap(file)
        self._done += 1
        made.compresses_messages = self._compresses(made)
        return made

    def _told(self, share: float) -> None:
        if self._progress is not None:
            self._progress((self._done + share) / len(self._found.files))

    def _compresses(self, file: McapFile | SqliteFile) -> bool:
        """Whether each message was compressed; without `metadata.yaml` the first one tells."""
        metadata = self._found.metadata
        if metadata is not None:
            return metadata.compression_mode == "message"
        for key in file.table.presence:
            for sample in queries.newest(file, {key: Outline("", b"")}, 2**63 - 1, 1, -(2**63)):
                return sample.payload.startswith(ZSTD_MAGIC)
        return False

    def _mcap(self, file: Path) -> McapFile:
        stamp = stamp_of(file)
        handle = opened(file)
        try:
            index = self._index(file, handle, stamp)
        except DamagedPartError as error:
            raise BagNotReadableError(str(file), error.reason) from None
        except OSError as error:
            raise BagNotReadableError(str(file), error.strerror or "the disk fails") from None
        finally:
            os.close(handle)
        return McapFile(file, index, stamp, (self._chunks, self._indexes))

    def _index(self, file: Path, handle: int, stamp: Stamp | None) -> McapIndex:
        try:
            return read_summary(handle, os.fstat(handle).st_size)
        except DamagedPartError as error:
            reason = error.reason
        kept = self._kept.get(file)
        if kept is not None:
            return kept
        begun_s = time.monotonic()
        made = rebuilt_index(handle, file.name, reason, self._told)
        if time.monotonic() - begun_s > KEPT_AFTER_S:
            self._kept.keep(file, stamp, made)
        return made


@dataclass(frozen=True, slots=True)
class _Found:
    """What belongs to a bag."""

    storage: str
    files: tuple[Path, ...]
    metadata: BagMetadata | None = None
    troubles: tuple[str, ...] = ()


def _found(path: Path, *, by_files: bool) -> _Found:
    if path.name == METADATA_NAME and is_file(path):
        return _of_folder(path.parent, by_files=by_files)
    if is_folder(path):
        return _of_folder(path, by_files=by_files)
    if not is_file(path):
        raise BagNotReadableError(str(path), "it is not there")
    storage = _storage_of(path)
    if storage is None:
        raise BagNotReadableError(str(path), "a bag is a folder, or a file named .mcap or .db3")
    return _Found(storage, (path,))


def _storage_of(file: Path) -> str | None:
    return next(
        (name for end, name in STORAGES.items() if file.name.endswith((end, end + ZSTD))), None
    )


def _of_folder(folder: Path, *, by_files: bool) -> _Found:
    """Find the files of a folder by its `metadata.yaml` or, without a sound one, by name."""
    try:
        listed = sorted(
            (one for one in folder.iterdir() if _storage_of(one) and is_file(one)), key=_natural
        )
    except OSError as error:
        raise BagNotReadableError(str(folder), error.strerror or "the disk fails") from None
    try:
        metadata = read_metadata(folder / METADATA_NAME)
    except BagNotReadableError as error:
        if not listed:
            raise BagNotReadableError(str(folder), "it holds no file of a bag") from None
        storage = _storage_of(listed[0]) or ""
        kept = tuple(one for one in listed if _storage_of(one) == storage)
        return _Found(storage, kept, None, (_without_metadata(folder, error),))
    files = tuple(listed) if by_files else tuple(folder / name for name in metadata.files)
    missing = [one.name for one in files if not is_file(one)]
    troubles = (
        (f"{', '.join(missing)}: named in {METADATA_NAME}, and not there.",) if missing else ()
    )
    present = tuple(one for one in files if is_file(one))
    return _Found(metadata.storage, present, metadata, troubles)


def _without_metadata(folder: Path, error: BagNotReadableError) -> str:
    if is_file(folder / METADATA_NAME):
        return f"{METADATA_NAME} cannot be read: {error.reason}."
    return f"{METADATA_NAME} is missing: the recording was not finished."


def _natural(file: Path) -> list[tuple[int, str]]:
    """Sort bag_10 after bag_9."""
    return [
        (int(part), "") if part.isdigit() else (-1, part)
        for part in re.split(r"(\d{1,9})", file.name)
    ]
