"""Files that were compressed whole, unpacked into the data folder: bounded, and kept a while."""

from __future__ import annotations

import contextlib
import hashlib
import os
import shutil
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from studio.bags.compression import decompress_file
from studio.errors import BagNotReadableError, DamagedPartError
from studio.files import stamp_of, temporary_beside

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

FOLDER: Final = "bag-files"
FILE_BYTES_MAX: Final = 64 * 2**30
KEPT_BYTES_MAX: Final = 20 * 2**30
FREE_BYTES_MIN: Final = 2**30
"""So much of the disk is left free."""


@dataclass(frozen=True, slots=True)
class UnpackedFiles:
    """Keeps unpacked files in a folder; the oldest go when they take too much.

    Attributes:
        folder: Where they are kept; is made.
        file_bytes_max: A file holds at most so many.
        kept_bytes_max: All take at most so many, beside the newest.
    """

    folder: Path
    file_bytes_max: int = FILE_BYTES_MAX
    kept_bytes_max: int = KEPT_BYTES_MAX

    def unpacked(self, source: Path, progress: Callable[[float], None] | None = None) -> Path:
        """Return the unpacked file of one that ends with `.zstd`.

        Raises:
            BagNotReadableError: It is damaged, holds too much, or the disk cannot take it.
        """
        stamp = stamp_of(source)
        if stamp is None:
            raise BagNotReadableError(str(source), "it is not there")
        key = hashlib.blake2b(f"{source.resolve()}\0{stamp}".encode(), digest_size=16).hexdigest()
        target = self.folder / key / source.name.removesuffix(".zstd")
        if stamp_of(target) is not None:
            with contextlib.suppress(OSError):
                os.utime(target)
            return target
        try:
            self._unpack(source, target, stamp[1], progress)
        except DamagedPartError as error:
            raise BagNotReadableError(str(source), error.reason) from None
        except OSError as error:
            reason = f"{self.folder} cannot take what it holds ({error.strerror or error})"
            raise BagNotReadableError(str(source), reason) from None
        self._sweep(target.parent)
        return target

    def _unpack(
        self, source: Path, target: Path, size: int, progress: Callable[[float], None] | None
    ) -> None:
        target.parent.mkdir(parents=True, exist_ok=True)
        free = shutil.disk_usage(target.parent).free - FREE_BYTES_MIN
        if size > free:
            raise DamagedPartError(f"the disk of {self.folder} has too little room to unpack it")
        handle, temporary = temporary_beside(target)
        try:
            with os.fdopen(handle, "wb") as stream:
                decompress_file(
                    source,
                    stream,
                    min(self.file_bytes_max, free),
                    lambda read: progress(read / max(1, size)) if progress else None,
                )
            temporary.replace(target)
        finally:
            temporary.unlink(missing_ok=True)

    def _sweep(self, newest: Path) -> None:
        """Remove the folders of the oldest files; open files stay readable."""
        kept = [
            (about, one.parent)
            for one in self.folder.glob("*/*")
            if one.parent != newest and (about := stamp_of(one))
        ]
        total = 0
        for about, folder in sorted(kept, reverse=True):
            total += about[1]
            if total > self.kept_bytes_max:
                shutil.rmtree(folder, ignore_errors=True)
