"""Types of one's own, read where they lie: a package's folder, a folder of packages, or a file."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

from studio.errors import StudioError, UnreadableFileError, WireSettingsError
from studio.packages.manifest import FILE_NAME, SIZE_LIMIT_BYTES, package_name
from studio.packages.roots import ServedRoots, package_folder_of
from studio.ros.names import KINDS
from studio.ros.types.folders import InterfaceTexts, texts_of_package

if TYPE_CHECKING:
    from collections.abc import Mapping

    from studio.ros.types.library import TypeLibrary

VARIABLE = "STUDIO_INTERFACES"
"""Of the environment: paths as PATH has them, whose types every node of the process knows."""


def take_own_types(library: TypeLibrary, environment: Mapping[str, str] = os.environ) -> None:
    """Take up the types that the environment names; why a text is not one, the library says.

    Raises:
        WireSettingsError: One of the paths is not there, or holds no types.
    """
    for path in filter(None, environment.get(VARIABLE, "").split(os.pathsep)):
        try:
            library.add_sound_texts(texts_at(Path(path).expanduser().absolute()))
        except StudioError as error:
            raise WireSettingsError(f"{VARIABLE}: {error}") from None


def texts_at(path: Path) -> InterfaceTexts:
    """Read the texts at a path.

    Raises:
        UnreadableFileError: Nothing is there, or it holds no types.
        RosNameError: A package has a name that none may have.
    """
    if path.is_file():
        package = package_folder_of(path)
        owner = _name_of(package) if package else path.parent.parent.name
        return _text_of_file(owner, path)
    folders = [path] if _holds_types(path) else [one for one in path.glob("*") if _holds_types(one)]
    if not folders:
        raise UnreadableFileError(
            str(path), "holds no msg, srv or action folder: name a package's folder or one file."
        )
    return InterfaceTexts.of_all(
        texts_of_package(folder, _name_of(folder)) for folder in sorted(folders)
    )


def _holds_types(folder: Path) -> bool:
    return any((folder / kind).is_dir() for kind in KINDS)


def _name_of(folder: Path) -> str:
    """The name in the package.xml, else that of the folder."""
    manifest = folder / FILE_NAME
    if not manifest.is_file():
        return folder.name
    return package_name(ServedRoots([folder]).read(manifest, SIZE_LIMIT_BYTES)) or folder.name


def _text_of_file(package: str, path: Path) -> InterfaceTexts:
    if path.suffix.removeprefix(".") not in KINDS:
        raise UnreadableFileError(str(path), "defines no type: name a .msg, .srv or .action file.")
    found = InterfaceTexts()
    found.take(package, path)
    return found
