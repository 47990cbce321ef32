"""The types that a command knows: ROS's, the studio's, and those of opened packages."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

from studio.cli.opened import add_package_options, opened_packages
from studio.cli.pasted_types import is_pasted, pasted_texts
from studio.errors import RosNameError, StudioError, UnreadableFileError
from studio.packages.manifest import FILE_NAME, SIZE_LIMIT_BYTES, package_name
from studio.packages.roots import ServedRoots, package_folder_of
from studio.ros.names import KINDS, split_type_name
from studio.ros.types.folders import read_text, texts_of_package

if TYPE_CHECKING:
    import argparse

    from studio.ros.types.library import TypeLibrary


def add_type_options(parser: argparse.ArgumentParser) -> None:
    """Options of every verb that needs types."""
    parser.add_argument(
        "--interfaces",
        action="append",
        default=[],
        type=Path,
        metavar="PATH",
        help="take the types of a package's folder, a folder of packages, or of one "
        ".msg, .srv or .action file; - takes what is pasted, each text below a line such as "
        '"MSG: my_interfaces/Telemetry"; nothing is built; may be given again',
    )
    add_package_options(parser)


def known_types(options: argparse.Namespace, distro: str) -> TypeLibrary:
    """Make the library of a distribution with the user's own types.

    Raises:
        UnreadableFileError: What `--interfaces` names is not there, or holds no types.
        SettingsError: What was pasted does not say which types it defines.
        InterfaceTextError: A text given by `--interfaces` breaks a rule.
    """
    from studio.ros.types.library import TypeLibrary

    library = TypeLibrary(distro)
    index = opened_packages(options)
    for name in sorted(index.names):
        _take_if_sound(library, index.best(name, Path.cwd()), name)
    for path in options.interfaces:
        library.add_texts(
            pasted_texts(sys.stdin) if is_pasted(path) else _texts_at(path.expanduser().absolute())
        )
    return library


def _take_if_sound(library: TypeLibrary, folder: Path, name: str) -> None:
    """Take what an opened package defines; one that is not sound is nobody's question here."""
    if not any((folder / kind).is_dir() for kind in KINDS):
        return
    try:
        library.add_texts(texts_of_package(folder, name))
    except StudioError:
        return


def _texts_at(path: Path) -> dict[str, str]:
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
