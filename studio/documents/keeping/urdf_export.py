"""The expanded URDF for other programs: where its meshes are named, and copies of them."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Final
from xml.etree import ElementTree

from studio.errors import PackageError
from studio.packages.companions import companions
from studio.packages.packing import PackedFile
from studio.packages.roots import package_folder_of
from studio.packages.uris import resolve_uri
from studio.robot.xml_tree import parse_tree

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.packages.workspace import Location

_NAMES_FILE: Final = ("mesh", "texture")
_MESHES: Final = "meshes"


def with_absolute_paths(urdf: str, location: Location) -> str:
    """The URDF with the place of each mesh on this machine; what is not found stays as it is."""
    return _renamed(urdf, location, lambda _, file: file.as_uri())


def with_copied_meshes(urdf: str, location: Location) -> tuple[str, list[PackedFile]]:
    """The URDF with meshes named beside it, and these with all that they draw on."""
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
    """The URDF with other names for the files that are there."""
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
        """The name of a copy; the same for the same file."""
        if file not in self.names:
            package = package_folder_of(file)
            inside = file.relative_to(package) if package else Path(file.name)
            folder = package.name if package else file.parent.name
            wanted = f"{_MESHES}/{folder}/{inside.as_posix()}"
            self.names[file] = self._free(wanted)
        return self.names[file]

    def beside(self, file: Path, mesh: Path) -> str:
        """The name of what a mesh draws on: where the mesh looks for it."""
        folder = self.names[mesh].rpartition("/")[0]
        return f"{folder}/{file.relative_to(mesh.parent).as_posix()}"

    def _free(self, wanted: str) -> str:
        """Two folders of one name, say: the second gets a number."""
        taken, number, name = set(self.names.values()), 2, wanted
        while name in taken:
            head, _, tail = wanted.partition(f"{_MESHES}/")[2].partition("/")
            name, number = f"{_MESHES}/{head}_{number}/{tail}", number + 1
        return name
