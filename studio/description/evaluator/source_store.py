"""The texts of one open description: read with a check of their roots, edited in memory.

A file is identified by its absolute path with symlinks resolved.
"""

from __future__ import annotations

import glob
import os
import re
from itertools import islice
from typing import TYPE_CHECKING, Any, Final, Protocol

from studio.description.faults import Fault, Refusal, misnamed
from studio.description.syntax.recovery import RECOVERABLE, recover
from studio.description.syntax.source_tree import SourceError, SourceTree, parse_source
from studio.description.syntax.yaml_reading import read_yaml
from studio.errors import EditError, OutsideRootsError, UnreadableFileError

if TYPE_CHECKING:
    from collections.abc import Mapping

    from studio.description.syntax.source_tree import SourceTree
    from studio.description.syntax.xml_faults import XmlFault

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping
    from pathlib import Path

    from studio.description.values import Edit

_MAGIC: Final = re.compile(r"[*[?]")
_NAMES_MAX: Final = 2_000
"""Limit for a folder, in search of the name that was meant."""
WILDCARD_LEVELS: Final = 3
"""Links that lead back to their own folder make each further one many times as slow."""


class Roots(Protocol):
    """The files that may be read, as `studio.packages.roots.ServedRoots`."""

    def resolve(self, path: Path | str) -> Path:
        """Follow symlinks; OutsideRootsError when it leads out."""
        ...

    def read(self, path: Path | str) -> bytes:
        """Return a regular file whole; UnreadableFileError or OutsideRootsError."""
        ...


class SourceStore:
    """Bytes and trees of all files read so far, kept between runs until a reload."""

    def __init__(self, roots: Roots, overlay: Mapping[str, bytes]) -> None:
        self._roots = roots
        self._real: dict[str, str] = {}
        self._data: dict[str, bytes] = {}
        self._trees: dict[str, SourceTree] = {}
        self._yaml: dict[str, tuple[bytes, Any]] = {}
        self.asked: dict[str, None] = {}
        """Every file that the current run asked for, in order, whether it was there or not."""
        for path, data in overlay.items():
            self._data[self.resolve(path)] = data

    def begin_run(self) -> None:
        """Forget what the last run asked for, and what it did not find."""
        self.asked = {}

    def resolve(self, path: str) -> str:
        """Return the name under which a file is known here.

        Raises:
            Refusal: It lies outside the roots.
            Fault: It cannot be a file name.
        """
        real = self._real.get(path)
        if real is None:
            try:
                real = self._real[path] = str(self._roots.resolve(path))
            except OutsideRootsError as error:
                raise Refusal("outside-roots", str(error), unreadable=True) from None
            except UnreadableFileError as error:
                raise Fault("file-unreadable", str(error), unreadable=True) from None
        return real

    def read(self, path: str) -> tuple[str, bytes]:
        """Return a file's resolved path and bytes as edited.

        Raises:
            Refusal: It lies outside the roots.
            Fault: It is missing, no regular file, or too large; `unreadable` is set.
        """
        real = self.resolve(path)
        self.asked[real] = None
        data = self._data.get(real)
        if data is None:
            try:
                data = self._data[real] = self._roots.read(real)
            except UnreadableFileError as error:
                self._real.pop(path, None)  # it may come back as a link to elsewhere
                raise _unreadable(real, f"The file {error.path} {error.reason}") from None
            except OutsideRootsError as error:
                raise Refusal("outside-roots", str(error), unreadable=True) from None
        return real, data

    def tree(self, path: str) -> SourceTree:
        """Return a file parsed.

        Raises:
            Fault: As `read`, or it is no XML that may be read; the place is then in that file.
        """
        real, data = self.read(path)
        tree = self._trees.get(real)
        if tree is None or tree.data is not data:
            try:
                tree = self._trees[real] = parse_source(real, data)
            except SourceError as error:
                fault = Fault(error.code, error.sentence)
                fault.place = error.place
                raise fault from None
        return tree

    def yaml(self, path: str, evaluate: Callable[[str], Any]) -> tuple[str, bytes, Any]:
        """Return a YAML file's resolved path, bytes and plain values, which must not be changed.

        Raises:
            Fault: As `read`, or it is no YAML; the place is then in that file.
        """
        real, data = self.read(path)
        known = self._yaml.get(real)
        if known is None or known[0] is not data:
            known = self._yaml[real] = (data, read_yaml(real, data, evaluate))
        return real, data, known[1]

    def glob(self, pattern: str) -> list[str]:
        """Return files that a pattern with `*`, `?` or `[` matches, sorted.

        Raises:
            Refusal: Its folder lies outside the roots, it climbs after its first wildcard, or it
                has too many of them.
        """
        magic = _MAGIC.search(pattern)
        fixed = pattern[: magic.start()] if magic else pattern
        if ".." in pattern[len(fixed) :].split("/"):
            raise Refusal("outside-roots", f'"{pattern}" climbs out with ".." behind a wildcard.')
        if sum(bool(_MAGIC.search(part)) for part in pattern.split("/")) > WILDCARD_LEVELS:
            sentence = f'"{pattern}" has wildcards in more than {WILDCARD_LEVELS} folders.'
            raise Refusal("too-many-wildcards", sentence)
        self.resolve(os.path.dirname(fixed) or ".")  # noqa: PTH120 - a text, not a Path
        found = glob.glob(pattern)  # noqa: PTH207 - as xacro does it
        return sorted(one for one in found if _is_text(one))

    def edit(self, edits: Iterable[Edit]) -> None:
        """Apply edits in order; either all or none.

        Raises:
            EditError: A span does not lie in its file, or the file was never read.
        """
        changed: dict[str, bytes] = {}
        for one in edits:
            real = self.resolve(one.file)
            data = changed.get(real, self._data.get(real))
            if data is None or not 0 <= one.start <= one.end <= len(data):
                raise EditError(f"{one.file} has no bytes {one.start} to {one.end} to edit.")
            changed[real] = data[: one.start] + one.new + data[one.end :]
        self._data.update(changed)

    def held(self, path: str) -> tuple[SourceTree | None, Any | None]:
        """Return a file's tree or YAML values of the last run, while they are valid."""
        data, tree = self._data.get(path), self._trees.get(path)
        known = self._yaml.get(path)
        return (
            tree if tree is not None and tree.data is data else None,
            known[1] if known is not None and known[0] is data else None,
        )

    def keep(self, path: str, data: bytes) -> None:
        """Take new bytes of a file, to which its tree or its values were changed already."""
        tree, known = self.held(path)
        self._data[path] = data
        if tree is not None:
            tree.data = data
        if known is not None:
            self._yaml[path] = (data, known)

    def restore(self, path: str, data: bytes) -> None:
        """Take other bytes of a file, and forget what was parsed of it."""
        self._data[path] = data
        self._trees.pop(path, None)
        self._yaml.pop(path, None)

    def reload(self, files: Iterable[str], overlay: Mapping[str, bytes]) -> None:
        """Take these files from the overlay, else from disk at their next read."""
        for path in files:
            real = self._real.pop(path, path)
            self._data.pop(real, None)
            self._trees.pop(real, None)
        self._real.clear()
        for path, data in overlay.items():
            self._data[self.resolve(path)] = data

    def kept(self, before: SourceStore | None) -> SourceStore:
        """Return a copy of the store, which edits of this one do not reach.

        What `before`, an earlier one, has parsed of unchanged texts need not be parsed again.
        """
        kept = SourceStore(self._roots, {})
        kept._data = dict(self._data)
        if before is not None:
            kept._trees, kept._yaml = before._trees, before._yaml
        return kept

    def trees(self, paths: Iterable[str]) -> dict[str, SourceTree]:
        """Trees already parsed, of those paths that have one."""
        return {path: self._trees[path] for path in paths if path in self._trees}


def _unreadable(path: str, sentence: str) -> Fault:
    """A file cannot be read; one beside it may have been meant."""
    folder, _, name = path.rpartition("/")
    try:
        with os.scandir(folder) as found:
            names = [one.name for one in islice(found, _NAMES_MAX)]
    except OSError:
        names = []
    if not names or name in names:
        return Fault("file-unreadable", sentence, unreadable=True)
    reason = sentence.removesuffix(".")
    fault = misnamed("file-unreadable", reason, name, names, "look for it there.")
    if fault.misnamed is None:
        fault = Fault("file-unreadable", sentence)
    fault.unreadable = True
    return fault


def _is_text(path: str) -> bool:
    """Whether a message can carry a path: Linux allows names of any bytes."""
    return path == path.encode("utf-8", "replace").decode()


class RecoveringStore(SourceStore):
    """The texts of another store, of which it reads the broken ones, too."""

    def __init__(self, store: SourceStore) -> None:
        super().__init__(store._roots, {})
        self._data, self._trees = dict(store._data), dict(store._trees)
        self.faults: dict[str, tuple[XmlFault, ...]] = {}
        """What is wrong, by file."""

    def tree(self, path: str) -> SourceTree:
        """As `SourceStore.tree`, but without a fault when the XML is broken."""
        try:
            return super().tree(path)
        except Fault as fault:
            if fault.code not in RECOVERABLE:
                raise
            return self._recovered(path, fault)

    def _recovered(self, path: str, fault: Fault) -> SourceTree:
        real, data = self.read(path)
        try:
            recovered = recover(real, data)
        except SourceError:
            raise fault from None
        self.faults[real] = recovered.faults
        self._trees[real] = recovered.tree
        return recovered.tree
