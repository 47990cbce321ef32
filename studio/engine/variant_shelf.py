"""Where the variants of a document are kept: a YAML file beside its entry, else this session."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.description.editing.variants_file import SIZE_LIMIT_BYTES, read_variants, write_variants
from studio.engine.side_file import SideFile
from studio.errors import PackageError, VariantsFileError

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from studio.description.editing.variants import Variant
    from studio.packages.roots import ServedRoots


class VariantShelf:
    """Reads and writes one file of variants; what cannot be written is kept for the session."""

    def __init__(self, entry: Path, served: ServedRoots) -> None:
        self._entry = entry
        self._file = SideFile(entry, "variants", served)
        self.path = self._file.path
        self._data = b""
        self._here: tuple[Variant, ...] | None = None
        """The variants of this session, once they could not be written."""
        self.variants: tuple[Variant, ...] = ()
        self._fault: VariantsFileError | PackageError | None = None
        """What is wrong with the file; the last good variants stay."""

    @property
    def only_here(self) -> str:
        """Why variants are kept for this session only; empty: they are saved."""
        return self._file.only_here

    @property
    def trouble(self) -> str:
        """What is wrong with the file, in a sentence."""
        return str(self._fault or "")

    def look(self) -> bool:
        """Read the file; whether anything changed."""
        before = self.variants, self.trouble
        if self._here is None:
            try:
                data = self._file.read(SIZE_LIMIT_BYTES)
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
        self._file.write(data)
        self._data, self.variants = data, tuple(variants)
