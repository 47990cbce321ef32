"""The folder `share/PACKAGE` of a package that is not built, for launch files."""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import TYPE_CHECKING

from studio.errors import PackageError
from studio.launch.vocabulary.temporary import folder as temporary_folder
from studio.packages.inspection.inspecting import LAUNCH_SUFFIXES
from studio.packages.manifest import FILE_NAME, package_name
from studio.packages.roots import ServedRoots, package_folder_of
from studio.packages.shares import installed_files, share_of
from studio.packages.sources.package_source import PackageSource

if TYPE_CHECKING:
    from studio.packages.index import PackageIndex


class Shares:
    """Finds the folder of a package's shared files; see `studio.packages.shares`."""

    def __init__(self, index: PackageIndex, asking: Path) -> None:
        self._index, self._asking = index, asking
        self._known: dict[str, Path] = {}

    def share_of(self, package: str) -> Path:
        """Return the folder.

        Raises:
            PackageNotFoundError: No package has that name.
        """
        if package not in self._known:
            folder = self._index.best(package, self._asking)
            self._known[package] = share_of(folder, package, links_folder)
        return self._known[package]


_LINKS: list[Path] = []


def links_folder() -> Path:
    """Return the folder of this process for folders of links."""
    if not _LINKS:
        _LINKS.append(temporary_folder() / "install")
    return _LINKS[0]


def real_paths(text: str) -> str:
    """Return a text with paths in folders of links as those of the sources."""
    root = str(_LINKS[0]) if _LINKS else ""
    if not root or root not in text:
        return text
    return re.sub(re.escape(root) + r"[^\s'\",;:]*", lambda found: os.path.realpath(found[0]), text)


def why_not_installed(file: Path) -> str:
    """Return why `ros2 launch` would not find a file of a package's sources; empty: it would.

    It tells nothing of packages that install nothing at all: those are no packages to build yet.
    """
    folder = package_folder_of(file.parent)
    if folder is None or folder.parent.name == "share":
        return ""
    has_setup, has_cmake = (folder / "setup.py").is_file(), (folder / "CMakeLists.txt").is_file()
    if not (folder / FILE_NAME).is_file() or not (has_setup or has_cmake):
        return ""
    name = name_of_package_in(folder)
    relative = file.relative_to(folder).as_posix()
    if not name or any(source == relative for _, source in installed_files(folder, name)):
        return ""
    mend = _cmake_mend(relative) if has_cmake else _setup_mend(folder, name, relative)
    return f"{relative} of {name} is not installed, so ros2 launch would not find it: {mend}"


def _cmake_mend(relative: str) -> str:
    inside = Path(relative).parent.as_posix()
    what = f"FILES {relative}" if inside == "." else f"DIRECTORY {inside}"
    install = f"install({what} DESTINATION share/${{PROJECT_NAME}})"
    return f"add {install} to CMakeLists.txt, before ament_package()"


def _setup_mend(folder: Path, name: str, relative: str) -> str:
    """Return a row for data_files that builds as it stands, and what it needs to be imported.

    A pattern of all files of a folder would match its folders, too, at which setuptools stops.
    """
    setup = PackageSource(folder, name=name).setup
    inside = Path(relative).parent.as_posix()
    below = "" if inside == "." else f"/{inside}"
    share = f"'share/{name}{below}'"
    if setup is not None and "package_name" in setup.constants:
        share = "'share/' + package_name" + (f" + '{below}'" if below else "")
    ending = next((one for one in LAUNCH_SUFFIXES if relative.endswith(one)), "")
    if not below or not ending:
        return f"add ({share}, ['{relative}']) to data_files in setup.py"
    row = f"({share}, glob('{inside}/*{ending}'))"
    if setup is None or setup.imports("glob", "glob"):
        return f"add {row} to data_files in setup.py"
    return f"write from glob import glob at the top of setup.py, and add {row} to its data_files"


def name_of_package_in(folder: Path) -> str:
    """Return the name in a folder's package.xml; empty where it has none that can be read."""
    try:
        return package_name(ServedRoots([folder]).read(folder / FILE_NAME)) or ""
    except PackageError:
        return ""
