"""Indexes that took long to make, kept in the data folder: by path, time and size of the file."""

from __future__ import annotations

import contextlib
import hashlib
import io
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Final
from zipfile import BadZipFile

import msgspec
import numpy as np

from studio.bags.blocks import Definition
from studio.bags.mcap_index import McapBlocks, McapIndex
from studio.bags.mcap_records import ChannelRecord  # noqa: TC001 - msgspec reads it
from studio.files import Stamp, stamp_of, write_whole

if TYPE_CHECKING:
    from pathlib import Path

FOLDER: Final = "bag-indexes"
_FILES_MAX: Final = 100
_BYTES_MAX: Final = 256 * 2**20
"""A larger index is not kept, and not read."""
_DIGEST_BYTES: Final = 32
_ABOUT: Final = "about"


class _About(msgspec.Struct):
    """What is no array in an index, and of which file it is."""

    path: str
    stamp: Stamp
    schemas: dict[int, tuple[str, str, str]]
    channels: dict[int, ChannelRecord]
    counts: dict[int, int]
    metadata: dict[str, str]
    troubles: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class IndexCache:
    """Keeps indexes in a folder. One that cannot be read or written is made anew from its bag."""

    folder: Path

    def get(self, file: Path) -> McapIndex | None:
        """Return the index of a file as it is now; None: there is none, or it is damaged."""
        try:
            kept = self._place(file)
            if kept.stat().st_size > _BYTES_MAX:
                return None
            return _read(kept.read_bytes(), file)
        except (OSError, ValueError, KeyError, EOFError, BadZipFile, msgspec.MsgspecError):
            return None
        except TypeError:  # another version of the studio kept it, of other arrays
            return None

    def keep(self, file: Path, stamp: Stamp | None, index: McapIndex) -> None:
        """Keep the index of a file that had this stamp when it was read."""
        if stamp is None:
            return
        data = _written(file, stamp, index)
        if len(data) > _BYTES_MAX:
            return
        with contextlib.suppress(OSError):
            self.folder.mkdir(parents=True, exist_ok=True)
            write_whole(self._place(file), data)
            self._sweep()

    def _place(self, file: Path) -> Path:
        name = hashlib.blake2b(str(file.resolve()).encode(), digest_size=16).hexdigest()
        return self.folder / f"{name}.index"

    def _sweep(self) -> None:
        """Remove the oldest where there are too many."""
        kept = sorted(self.folder.glob("*.index"), key=lambda one: one.stat().st_mtime)
        for one in kept[:-_FILES_MAX]:
            one.unlink(missing_ok=True)


def _written(file: Path, stamp: Stamp, index: McapIndex) -> bytes:
    about = _About(
        str(file.resolve()),
        stamp,
        {key: (one.type_name, one.encoding, one.text) for key, one in index.schemas.items()},
        index.channels,
        index.counts,
        index.metadata,
        index.troubles,
    )
    arrays = {
        **asdict(index.blocks),
        _ABOUT: np.frombuffer(msgspec.msgpack.encode(about), np.uint8),
    }
    stream = io.BytesIO()
    np.savez(stream, allow_pickle=False, **arrays)
    data = stream.getvalue()
    return hashlib.blake2b(data, digest_size=_DIGEST_BYTES).digest() + data


def _read(kept: bytes, file: Path) -> McapIndex | None:
    digest, data = kept[:_DIGEST_BYTES], kept[_DIGEST_BYTES:]
    if hashlib.blake2b(data, digest_size=_DIGEST_BYTES).digest() != digest:
        return None
    with np.load(io.BytesIO(data), allow_pickle=False) as arrays:
        parts = {name: arrays[name] for name in arrays.files}
    about = msgspec.msgpack.decode(parts.pop(_ABOUT).tobytes(), type=_About)
    if about.path != str(file.resolve()) or about.stamp != stamp_of(file):
        return None
    return McapIndex(
        McapBlocks(**parts),
        {key: Definition(*one) for key, one in about.schemas.items()},
        about.channels,
        about.counts,
        about.metadata,
        about.troubles,
    )
