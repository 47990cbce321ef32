"""The robot for other programs: as URDF, as its packages with the edits, as a page of its own."""

from __future__ import annotations

import asyncio
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Final, Literal, TypeAlias
from xml.etree import ElementTree

from studio.errors import CommandError, ExportError, PackageError
from studio.packages.packing import PackedFile, check_size, companions, package_files, zip_chunks
from studio.packages.roots import package_folder_of
from studio.packages.uris import resolve_uri
from studio.robot.xml_tree import parse_tree

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable, Iterable, Iterator, Mapping

    from studio.documents.runs import LastRun
    from studio.documents.urdf import UrdfText
    from studio.documents.workspace import Workspace
    from studio.packages.roots import ServedRoots
    from studio.packages.workspace import Location
    from studio.scene import DocumentScene


_NAMES_FILE: Final = ("mesh", "texture")
_MESHES: Final = "meshes"


def with_absolute_paths(urdf: str, location: Location) -> str:
    """Return the URDF with absolute paths of meshes; what is not found stays as it is."""
    return _renamed(urdf, location, lambda _, file: file.as_uri())


def with_copied_meshes(urdf: str, location: Location) -> tuple[str, list[PackedFile]]:
    """Return the URDF with meshes named beside it, and these with all that they draw on."""
    copies = _Copies()
    text = _renamed(urdf, location, lambda _, file: copies.name_of(file))
    beside = [
        PackedFile(copies.beside(file, mesh), file)
        for mesh in copies.names
        for file in companions(mesh, location.served)
    ]
    files = [PackedFile(name, file) for file, name in copies.names.items()]
    return text, list({one.name: one for one in (*beside, *files)}.values())


def _renamed(urdf: str, location: Location, name_of: Callable[[str, Path], str]) -> str:
    """Return the URDF with other names for the files that are there."""
    assert location.entry is not None
    root = parse_tree(urdf)
    for element in (one for tag in _NAMES_FILE for one in root.iter(tag)):
        uri = element.get("filename", "")
        try:
            file = resolve_uri(uri, location.entry, location.index, location.served)
        except PackageError:
            continue
        element.set("filename", name_of(uri, file))
    text = ElementTree.tostring(root, encoding="unicode")
    return f'<?xml version="1.0" ?>\n{text}\n'


@dataclass(slots=True)
class _Copies:
    """A place below `meshes/` for each file: its package's name and its path there."""

    names: dict[Path, str] = field(default_factory=dict[Path, str])

    def name_of(self, file: Path) -> str:
        """Return the name of a copy; the same for the same file."""
        if file not in self.names:
            package = package_folder_of(file)
            inside = file.relative_to(package) if package else Path(file.name)
            folder = package.name if package else file.parent.name
            wanted = f"{_MESHES}/{folder}/{inside.as_posix()}"
            self.names[file] = self._free(wanted)
        return self.names[file]

    def beside(self, file: Path, mesh: Path) -> str:
        """Return the name of a file that a mesh uses, so that the mesh finds it."""
        folder = self.names[mesh].rpartition("/")[0]
        return f"{folder}/{file.relative_to(mesh.parent).as_posix()}"

    def _free(self, wanted: str) -> str:
        """Return `wanted` or, if it is taken, the name with a number."""
        taken, number, name = set(self.names.values()), 2, wanted
        while name in taken:
            head, _, tail = wanted.partition(f"{_MESHES}/")[2].partition("/")
            name, number = f"{_MESHES}/{head}_{number}/{tail}", number + 1
        return name


MeshNames: TypeAlias = Literal["package", "absolute", "copied"]

_ENDINGS: Final = (".xacro", ".urdf", ".xml")
_ZIP: Final = "application/zip"


@dataclass(frozen=True, slots=True)
class Download:
    """A file that is given out: its name, its kind, and its bytes, made as they are taken."""

    name: str
    media_type: str
    chunks: Iterable[bytes]


class Exports:
    """Makes downloads of a document as it is now, with its unsaved edits.

    Args:
        workspace: The files, and their texts as they are edited.
        last_run: Which files it read.
        urdf: The expanded URDF.
        scene: The 3D view.
        opened: Waits until its meshes are loaded.
        packages_used: The package of each file in use: its name, and its folder.
    """

    def __init__(
        self,
        workspace: Workspace,
        last_run: LastRun,
        urdf: UrdfText,
        scene: DocumentScene,
        opened: Callable[[], Awaitable[None]],
        packages_used: Callable[[], Mapping[str, str]],
    ) -> None:
        self._workspace, self._last_run, self._urdf = workspace, last_run, urdf
        self._scene, self._opened, self._packages_used = scene, opened, packages_used

    async def urdf(self, meshes: MeshNames) -> Download:
        """Return the expanded URDF; with `copied` a zip that holds its meshes, too.

        Raises:
            CommandError: There was no good run yet.
            ExportError: It comes to too much.
        """
        location, name = self._workspace.location, self._name
        text = await self._urdf.text()
        if meshes == "copied":
            return await asyncio.to_thread(self._with_meshes, text)
        if meshes == "absolute":
            text = await asyncio.to_thread(with_absolute_paths, text, location)
        return Download(f"{name}.urdf", "application/xml", (text.encode(),))

    async def package(self, *, all_used: bool) -> Download:
        """Return the package of the entry file, or every one that the robot uses, with the edits.

        Raises:
            ExportError: It comes to too much.
        """
        files = await asyncio.to_thread(self._packages, self._edited(), all_used=all_used)
        name = files[0].name.partition("/")[0] if files else self._name
        return Download(f"{name}.zip", _ZIP, zip_chunks(files, self._workspace.served))

    async def page(self, *, dark: bool) -> Download:
        """Return the 3D view as one page that opens from the disk, with the robot as it stands.

        Raises:
            CommandError: There is no robot to show.
        """
        if self._last_run.expansion is None:
            title = self._workspace.title
            raise CommandError(f"{title} has no robot to show yet: mend its problems.")
        await self._opened()
        make = self._scene.standalone_page(title=self._name, dark=dark)
        page = await asyncio.to_thread(make)
        return Download(f"{self._name}.html", "text/html; charset=utf-8", (page,))

    @property
    def _name(self) -> str:
        name = self._workspace.title
        for ending in _ENDINGS:
            name = name.removesuffix(ending)
        return name or "robot"

    def _with_meshes(self, text: str) -> Download:
        name, location = self._name, self._workspace.location
        urdf, copies = with_copied_meshes(text, location)
        own = PackedFile(f"{name}/{name}.urdf", urdf.encode())
        files = [own, *(PackedFile(f"{name}/{one.name}", one.source) for one in copies)]
        check_size(files, name)
        return Download(f"{name}.zip", _ZIP, zip_chunks(files, location.served))

    def _edited(self) -> dict[Path, bytes]:
        sources = self._workspace.sources
        return {Path(file): sources.text(file) for file in sources.unsaved_files}

    def _packages(self, edited: dict[Path, bytes], *, all_used: bool) -> list[PackedFile]:
        workspace, served = self._workspace, self._workspace.served
        own = package_folder_of(workspace.entry)
        folders = [own] if own else []
        if all_used:
            used = map(Path, self._packages_used().values())
            folders += [one for one in used if one != own]
        files = list(_files_of(folders, served))
        if own is None:
            files += self._loose_files()
        check_size(files, workspace.title)
        if not files:
            raise ExportError(workspace.title, "it lies in no package")
        return [
            PackedFile(one.name, edited.get(one.source, one.source))
            if isinstance(one.source, Path)
            else one
            for one in files
        ]

    def _loose_files(self) -> list[PackedFile]:
        """Return the files that the run read below an entry file in no package."""
        folder = self._workspace.entry.parent
        read = (Path(file) for file in self._last_run.files)
        return [
            PackedFile(f"{self._name}/{file.relative_to(folder).as_posix()}", file)
            for file in read
            if file.is_relative_to(folder) and file.is_file()
        ]


def _files_of(folders: Iterable[Path], served: ServedRoots) -> Iterator[PackedFile]:
    """Yield the files of packages below their folders' names, numbered if not unique."""
    taken: set[str] = set()
    for folder in folders:
        name, number = folder.name, 2
        while name in taken:
            name, number = f"{folder.name}_{number}", number + 1
        taken.add(name)
        yield from package_files(folder, name, served)
