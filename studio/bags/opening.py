"""Opening a bag: which files belong to it, and what reads each."""

from __future__ import annotations

import os
import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from studio.bags.bag import Bag
from studio.bags.bounded_cache import BoundedCache
from studio.bags.mcap_file import McapFile, opened
from studio.bags.mcap_index import read_summary
from studio.bags.metadata import METADATA_NAME, BagMetadata, read_metadata
from studio.errors import BagNotReadableError, DamagedPartError
from studio.files import is_file, is_folder, stamp_of

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from studio.bags.blocks import BlockFile

CHUNK_CACHE_BYTES: Final = 64 * 2**20
INDEX_CACHE_BYTES: Final = 32 * 2**20
STORAGES: Final = {".mcap": "mcap", ".db3": "sqlite3"}
ZSTD: Final = ".zstd"


def open_bag(path: Path, progress: Callable[[float], None] | None = None) -> Bag:
    """Open a bag.

    Args:
        path: A folder of rosbag2, its `metadata.yaml`, or one `.mcap` or `.db3` file.
        progress: Is told the share that is done, 0 to 1, while an index has to be made.

    Raises:
        BagNotReadableError: There is no bag, or nothing of it can be read.
    """
    found = _found(path)
    caches = (BoundedCache[bytes](CHUNK_CACHE_BYTES), BoundedCache[object](INDEX_CACHE_BYTES))
    files: list[BlockFile] = []
    troubles = list(found.troubles)
    for one in found.files:
        try:
            files.append(_opened(one, caches))
        except BagNotReadableError as error:
            troubles.append(f"{one.name} is left out: {error.reason}.")
    if not files:
        raise BagNotReadableError(str(path), " ".join(troubles) or "it holds no files of a bag")
    return Bag(path, found.storage, files, found.files, found.metadata, troubles)


@dataclass(frozen=True, slots=True)
class _Found:
    """What belongs to a bag."""

    storage: str
    files: tuple[Path, ...]
    metadata: BagMetadata | None = None
    troubles: tuple[str, ...] = ()


def _found(path: Path) -> _Found:
    if path.name == METADATA_NAME and is_file(path):
        return _of_folder(path.parent)
    if is_folder(path):
        return _of_folder(path)
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


def _of_folder(folder: Path) -> _Found:
    """Find the files of a folder by its `metadata.yaml` or, without a sound one, by name."""
    listed = sorted(
        (one for one in folder.iterdir() if _storage_of(one) and is_file(one)), key=_natural
    )
    try:
        metadata = read_metadata(folder / METADATA_NAME)
    except BagNotReadableError as error:
        if not listed:
            raise BagNotReadableError(str(folder), "it holds no file of a bag") from None
        storage = _storage_of(listed[0]) or ""
        kept = tuple(one for one in listed if _storage_of(one) == storage)
        return _Found(storage, kept, None, (_without_metadata(folder, error),))
    files = tuple(folder / name for name in metadata.files)
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


def _opened(file: Path, caches: tuple[BoundedCache[bytes], BoundedCache[object]]) -> BlockFile:
    stamp = stamp_of(file)
    handle = opened(file)
    try:
        index = read_summary(handle, os.fstat(handle).st_size)
    except DamagedPartError as error:
        raise BagNotReadableError(str(file), error.reason) from None
    except OSError as error:
        raise BagNotReadableError(str(file), error.strerror or "the disk fails") from None
    finally:
        os.close(handle)
    return McapFile(file, index, stamp, caches)
