"""Where the variants of a document are kept: a YAML file beside its entry, else this session."""

from __future__ import annotations

import contextlib
import os
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Final

from studio.description.editing.variants_file import SIZE_LIMIT_BYTES, read_variants, write_variants
from studio.errors import NotSavedError, PackageError, VariantsFileError
from studio.packages.presence import is_there

if TYPE_CHECKING:
    from collections.abc import Sequence

    from studio.description.editing.variants import Variant
    from studio.packages.roots import ServedRoots

_ENDINGS: Final = (".urdf.xacro", ".xacro", ".urdf", ".xml")


class VariantShelf:
    """Reads and writes one file of variants; what cannot be written is kept for the session."""

    def __init__(self, entry: Path, served: ServedRoots) -> None:
        self.path = entry.with_name(f"{_stem(entry.name)}.variants.yaml")
        self._entry, self._served = entry, served
        self._data = b""
        self._here: tuple[Variant, ...] | None = None
        """The variants of this session, once they could not be written."""
        self.variants: tuple[Variant, ...] = ()
        self._fault: VariantsFileError | PackageError | None = None
        """What is wrong with the file; the last good variants stay."""

    @property
    def only_here(self) -> str:
        """Why variants are kept for this session only; empty: they are saved."""
        if self._served.may_write(self.path):
            return ""
        return f"the folder {self.path.parent} may only be read here."

    @property
    def trouble(self) -> str:
        """What is wrong with the file, in a sentence."""
        return str(self._fault or "")

    def look(self) -> bool:
        """Read the file; whether anything changed."""
        before = self.variants, self.trouble
        if self._here is None:
            try:
                data = self._read()
                if data != self._data or self._fault is not None:
                    self._data = data
                    self.variants, self._fault = read_variants(str(self.path), data), None
            except (VariantsFileError, PackageError) as error:
                self._fault = error
        return before != (self.variants, self.trouble)

    def put(self, variants: Sequence[Variant]) -> None:
        """Keep these from now on.

        Raises:
            VariantsFileError: The file as it is cannot be read: it is not overwritten.
            PackageError: It leads out of the opened folders, or is no file.
            NotSavedError: The disk refused it.
        """
        self.look()
        if self._fault is not None:
            raise self._fault
        if self._here is not None or self.only_here:
            self._here = self.variants = tuple(variants)
            return
        data = write_variants(str(self.path), self._entry.name, self._data, variants)
        self._write(data)
        self._data, self.variants = data, tuple(variants)

    def _read(self) -> bytes:
        if not is_there(self.path):
            return b""
        return self._served.read(self.path, SIZE_LIMIT_BYTES)

    def _write(self, data: bytes) -> None:
        """Whole or not at all: beside it, then renamed over it. A symlink stays."""
        target = self._served.resolve(self.path)
        temporary: Path | None = None
        try:
            handle, name = tempfile.mkstemp(prefix=f".{target.name}.", dir=target.parent)
            temporary = Path(name)
            with os.fdopen(handle, "wb") as stream:
                stream.write(data)
                stream.flush()
                os.fsync(stream.fileno())
            temporary.chmod(target.stat().st_mode & 0o777 if is_there(target) else 0o644)
            temporary.replace(target)
        except OSError as error:
            if temporary is not None:
                with contextlib.suppress(OSError):
                    temporary.unlink(missing_ok=True)
            reason = error.strerror or "the disk refused it"
            raise NotSavedError(str(self.path), reason) from error


def _stem(name: str) -> str:
    return next((name.removesuffix(end) for end in _ENDINGS if name.endswith(end)), name)
