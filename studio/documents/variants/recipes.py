"""Recipes: the arguments and texts of a state of a document, on top of its files."""

from __future__ import annotations

import asyncio
import os
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Final

from studio.description.editing.edits import difference
from studio.description.editing.variants import NamedTexts, TextName, Variant, texts_by_file
from studio.errors import EditError, PackageError
from studio.packages.roots import package_folder_of
from studio.packages.uris import resolve_uri

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from studio.description.editing.sources import Sources
    from studio.description.values import Edit
    from studio.packages.workspace import Location

_PACKAGE: Final = "package://"


@dataclass(frozen=True, slots=True)
class Recipe:
    """One state: all arguments passed to xacro, and the texts that differ from those on disk."""

    arguments: dict[str, str]
    texts: dict[TextName, str] = field(default_factory=dict[TextName, str])
    edited_otherwise: tuple[str, ...] = ()
    """Files with unsaved edits beyond the values of texts: no variant holds those."""


@dataclass(frozen=True, slots=True)
class _Unread:
    """A file whose texts are to be read: of its bytes on disk, unless they are known, and now."""

    path: str
    file: str
    disk: bytes
    now: bytes
    known: NamedTexts | None


class RecipeBook:
    """Reads recipes out of a document's sources, and writes them into texts.

    Args:
        sources: The texts of the document.
        location: The folders of its files at present.

    Arguments given when the document was opened count as saved.
    """

    def __init__(self, sources: Sources, location: Callable[[], Location]) -> None:
        self._sources, self._location = sources, location
        self._opened_with = sources.arguments
        self._texts: dict[str, NamedTexts] = {}

    def saved(self) -> Recipe:
        """Return the state on disk, with the arguments that the document was opened with."""
        return Recipe(dict(self._opened_with))

    @property
    def is_saved(self) -> bool:
        """Whether the document is in its saved state."""
        same = self._sources.arguments == self._opened_with
        return same and not self._sources.unsaved_files

    async def read(self, variants: Iterable[Variant] = ()) -> None:
        """Read the texts that differ from the disk or that variants name, in another thread.

        What is asked then takes little time, if nothing is awaited before: a text of a megabyte
        is read for a second.
        """
        files = {name.file for one in variants for name in one.texts}
        while unread := self._unread(files):
            self._texts |= await asyncio.to_thread(_read, unread)

    def present(self) -> Recipe:
        """Return the document as it is now."""
        texts: dict[TextName, str] = {}
        others: list[str] = []
        for path in self._sources.unsaved_files:
            now, named = self._sources.text(path), self._named(path)
            differing = named.differing(now)
            texts |= differing
            if named.with_texts(differing)[0] != now:
                others.append(path)
        return Recipe(self._sources.arguments, texts, tuple(others))

    def of_variant(self, variant: Variant) -> Recipe:
        """Return the recipe of a variant, on the files as they are on disk now."""
        arguments = {**self._opened_with, **variant.arguments}
        passed = {name: value for name, value in arguments.items() if value is not None}
        texts = {
            name: text
            for name, text in variant.texts.items()
            if self.saved_text(name) not in (None, text)
        }
        return Recipe(passed, texts)

    def as_variant(self, name: str, note: str, recipe: Recipe) -> Variant:
        """Return a variant that comes to a recipe, whatever the robot is opened with next time."""
        taken_back = dict.fromkeys(self._opened_with.keys() - recipe.arguments.keys())
        arguments = dict(sorted({**recipe.arguments, **taken_back}.items()))
        return Variant(name, note, arguments, dict(sorted(recipe.texts.items())))

    def saved_text(self, name: TextName) -> str | None:
        """Return a text as it is on disk; None if there is none of that name."""
        named = self._find(name.file)
        return None if isinstance(named, str) else named.saved_text(name)

    def place_of(self, name: TextName) -> tuple[str, int]:
        """File and line where the disk has a text; line 0 when it has none."""
        named = self._find(name.file)
        return (name.file, 0) if isinstance(named, str) else (named.path, named.line_of(name))

    def overlay(self, recipe: Recipe) -> dict[str, bytes]:
        """Return the texts of a recipe by path, for a run that reads all else from the disk."""
        found: dict[str, bytes] = {}
        for file, texts in texts_by_file(recipe.texts).items():
            named = self._find(file)
            if not isinstance(named, str):
                found[named.path] = named.with_texts(texts)[0]
        return found

    def disk(self) -> dict[str, bytes]:
        """Return the bytes on disk of all files held, to detect an outdated run."""
        return {path: self._sources.saved(path) for path in self._sources.files}

    def edits_to(self, variant: Variant) -> tuple[tuple[Edit, ...], tuple[str, ...]]:
        """Return the edits from the present texts to a variant's, and what found no place.

        Edits that are no value of a text stay as they are.
        """
        wanted = texts_by_file(variant.texts)
        wanted |= {self._file(path): {} for path in self._sources.unsaved_files} | wanted
        edits: list[Edit] = []
        left_out: list[str] = []
        for file, texts in wanted.items():
            named = self._find(file)
            if isinstance(named, str):
                left_out.append(named)
                continue
            placed = named.edits_to(self._sources.text(named.path), texts)
            edits += placed.edits
            left_out += placed.left_out
        return tuple(edits), tuple(left_out)

    def edits_to_saved(self) -> tuple[Edit, ...]:
        """Return the edits that give up everything that is not saved."""
        sources = self._sources
        found = (
            difference(path, sources.text(path), sources.saved(path))
            for path in sources.unsaved_files
        )
        return tuple(edit for edit in found if edit is not None)

    def _find(self, file: str) -> NamedTexts | str:
        """Return the texts of a file as a variant names it; a sentence when it cannot be had."""
        try:
            return self._named(self._path(file))
        except (PackageError, EditError) as error:
            return str(error)

    def _named(self, path: str) -> NamedTexts:
        disk = self._sources.saved(path)
        known = self._texts.get(path)
        if known is None or known.disk != disk:
            known = self._texts[path] = NamedTexts(self._file(path), path, disk)
        return known

    def _unread(self, files: Iterable[str]) -> list[_Unread]:
        """Return the names that `read` has to read: unsaved files, and those in variants."""
        found: list[_Unread] = []
        for path in dict.fromkeys((*self._sources.unsaved_files, *self._paths(files))):
            now, disk = self._sources.text(path), self._sources.saved(path)
            known = self._texts.get(path)
            known = known if known is not None and known.disk == disk else None
            if known is None or not known.has_read(now):
                found.append(_Unread(path, self._file(path), disk, now, known))
        return found

    def _paths(self, files: Iterable[str]) -> Iterator[str]:
        for file in files:
            try:
                path = self._path(file)
                self._sources.saved(path)
            except PackageError:  # reported when its texts are read
                continue
            yield path

    def _file(self, path: str) -> str:
        """Return a file's name in a variant: what lies in another package goes by that."""
        entry, package = self._entry, package_folder_of(Path(path))
        if package is not None and package != package_folder_of(entry):
            for one in self._location().index.packages:
                if one.folder == package:
                    return f"{_PACKAGE}{one.name}/{Path(path).relative_to(package).as_posix()}"
        return Path(os.path.relpath(path, entry.parent)).as_posix()

    def _path(self, file: str) -> str:
        """Return the path of a variant's file; PackageError if it is missing or not readable."""
        location = self._location()
        if file.startswith(_PACKAGE):
            return str(resolve_uri(file, self._entry, location.index, location.served))
        return str(location.served.resolve(self._entry.parent / file))

    @property
    def _entry(self) -> Path:
        entry = self._location().entry
        assert entry is not None
        return entry


def _read(unread: Iterable[_Unread]) -> dict[str, NamedTexts]:
    """Return the texts of files, by path."""
    found: dict[str, NamedTexts] = {}
    for one in unread:
        named = one.known or NamedTexts(one.file, one.path, one.disk)
        named.read(one.now)
        found[one.path] = named
    return found
