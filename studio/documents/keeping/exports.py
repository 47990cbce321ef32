"""The robot for other programs: as URDF, as its packages with the edits, as a page of its own."""

from __future__ import annotations

import asyncio
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Final, Literal, TypeAlias

from studio.documents.keeping.urdf_export import with_absolute_paths, with_copied_meshes
from studio.errors import CommandError, ExportError
from studio.packages.packing import PackedFile, check_size, package_files, zip_chunks
from studio.packages.roots import package_folder_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from studio.documents.document import Document
    from studio.packages.roots import ServedRoots

MeshNames: TypeAlias = Literal["package", "absolute", "copied"]

_ENDINGS: Final = (".xacro", ".urdf", ".xml")
_ZIP: Final = "application/zip"


@dataclass(frozen=True, slots=True)
class Download:
    """A file that is given out: its name, its kind, and its bytes, made as they are taken."""

    name: str
    media_type: str
    chunks: Iterable[bytes]


class ExportDesk:
    """Makes downloads of a document as it is now, with its unsaved edits."""

    def __init__(self, document: Document) -> None:
        self._document = document

    async def urdf(self, meshes: MeshNames) -> Download:
        """The expanded URDF; with `copied` a zip that holds its meshes, too.

        Raises:
            CommandError: There was no good run yet.
            ExportError: It comes to too much.
        """
        location, name = self._document.location, self._name
        text = await self._document.urdf()
        if meshes == "copied":
            return await asyncio.to_thread(self._with_meshes, text)
        if meshes == "absolute":
            text = await asyncio.to_thread(with_absolute_paths, text, location)
        return Download(f"{name}.urdf", "application/xml", (text.encode(),))

    async def package(self, *, all_used: bool) -> Download:
        """The package of the entry file, or every one that the robot uses, with the edits.

        Raises:
            ExportError: It comes to too much.
        """
        files = await asyncio.to_thread(self._packages, self._edited(), all_used=all_used)
        name = files[0].name.partition("/")[0] if files else self._name
        served = self._document.location.served
        return Download(f"{name}.zip", _ZIP, zip_chunks(files, served))

    async def page(self, *, dark: bool) -> Download:
        """The 3D view as one page that opens from the disk, with the robot as it stands.

        Raises:
            CommandError: There is no robot to show.
        """
        document = self._document
        if document.expansion is None:
            raise CommandError(f"{document.title} has no robot to show yet: mend its problems.")
        await document.opened()
        make = document.scene.standalone_page(title=self._name, dark=dark)
        page = await asyncio.to_thread(make)
        return Download(f"{self._name}.html", "text/html; charset=utf-8", (page,))

    @property
    def _name(self) -> str:
        name = self._document.title
        for ending in _ENDINGS:
            name = name.removesuffix(ending)
        return name or "robot"

    def _with_meshes(self, text: str) -> Download:
        name, location = self._name, self._document.location
        urdf, copies = with_copied_meshes(text, location)
        own = PackedFile(f"{name}/{name}.urdf", urdf.encode())
        files = [own, *(PackedFile(f"{name}/{one.name}", one.source) for one in copies)]
        check_size(files, name)
        return Download(f"{name}.zip", _ZIP, zip_chunks(files, location.served))

    def _edited(self) -> dict[Path, bytes]:
        sources = self._document.sources
        return {Path(file): sources.text(file) for file in sources.unsaved_files}

    def _packages(self, edited: dict[Path, bytes], *, all_used: bool) -> list[PackedFile]:
        document = self._document
        served = document.location.served
        own = package_folder_of(document.entry)
        folders = [own] if own else []
        if all_used:
            used = map(Path, document.packages_used().values())
            folders += [one for one in used if one != own]
        files = list(_files_of(folders, served))
        if own is None:
            files += self._loose_files()
        check_size(files, document.title)
        if not files:
            raise ExportError(document.title, "it lies in no package")
        return [
            PackedFile(one.name, edited.get(one.source, one.source))
            if isinstance(one.source, Path)
            else one
            for one in files
        ]

    def _loose_files(self) -> list[PackedFile]:
        """Of an entry file in no package: what the run read below its folder."""
        folder = self._document.entry.parent
        read = (Path(file) for file in self._document.files_read)
        return [
            PackedFile(f"{self._name}/{file.relative_to(folder).as_posix()}", file)
            for file in read
            if file.is_relative_to(folder) and file.is_file()
        ]


def _files_of(folders: Iterable[Path], served: ServedRoots) -> Iterator[PackedFile]:
    """The files of packages, each below its folder's name; a second one of a name is numbered."""
    taken: set[str] = set()
    for folder in folders:
        name, number = folder.name, 2
        while name in taken:
            name, number = f"{folder.name}_{number}", number + 1
        taken.add(name)
        yield from package_files(folder, name, served)
