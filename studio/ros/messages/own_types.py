"""Types of one's own, read where they lie: a package's folder, a folder of packages, or a file."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

from studio.errors import RosNameError, StudioError, UnreadableFileError, WireSettingsError
from studio.packages.manifest import FILE_NAME, SIZE_LIMIT_BYTES, package_name
from studio.packages.roots import ServedRoots, package_folder_of
from studio.ros.names import KINDS, split_type_name
from studio.ros.types.folders import read_text, texts_of_package

if TYPE_CHECKING:
    from collections.abc import Mapping

    from studio.ros.types.library import TypeLibrary

VARIABLE = "STUDIO_INTERFACES"
"""Of the environment: paths as PATH has them, whose types every node of the process knows."""


def take_own_types(library: TypeLibrary, environment: Mapping[str, str] = os.environ) -> None:
    """Take up the types that the environment names.

    Raises:
        WireSettingsError: One of the paths is not there, or holds no sound types.
    """
    for path in filter(None, environment.get(VARIABLE, "").split(os.pathsep)):
        try:
            library.add_texts(texts_at(Path(path).expanduser().absolute()))
        except StudioError as error:
            raise WireSettingsError(f"{VARIABLE}: {error}") from None


def texts_at(path: Path) -> dict[str, str]:
    """Read the texts at a path by the full names of their types.

    Raises:
        UnreadableFileError: Nothing is there, or it holds no types.
        RosNameError: A package has a name that none may have.
    """
    if path.is_file():
        package = package_folder_of(path)
        owner = _name_of(package) if package else path.parent.parent.name
        return {_type_name(owner, path): read_text(path)}
    folders = [path] if _holds_types(path) else [one for one in path.glob("*") if _holds_types(one)]
    if not folders:
        raise UnreadableFileError(
            str(path), "holds no msg, srv or action folder: name a package's folder or one file."
        )
    return {
        name: text
        for folder in sorted(folders)
        for name, text in texts_of_package(folder, _name_of(folder)).items()
    }


def _holds_types(folder: Path) -> bool:
    return any((folder / kind).is_dir() for kind in KINDS)


def _name_of(folder: Path) -> str:
    """The name in the package.xml, else that of the folder."""
    manifest = folder / FILE_NAME
    if not manifest.is_file():
        return folder.name
    return package_name(ServedRoots([folder]).read(manifest, SIZE_LIMIT_BYTES)) or folder.name


def _type_name(package: str, path: Path) -> str:
    name = f"{package}/{path.suffix.removeprefix('.')}/{path.stem}"
    try:
        split_type_name(name)
    except RosNameError as error:
        raise UnreadableFileError(str(path), f"defines no type ({error.reason}).") from None
    return name
