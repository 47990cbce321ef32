"""The folder `share/PACKAGE` of a package that is not built, for launch files."""

from __future__ import annotations

import os
import re
from typing import TYPE_CHECKING

from studio.errors import PackageError
from studio.launch.vocabulary.temporary import folder as temporary_folder
from studio.packages.manifest import FILE_NAME, package_name
from studio.packages.roots import ServedRoots, package_folder_of
from studio.packages.shares import share_of
from studio.packages.sources.package_source import PackageSource

if TYPE_CHECKING:
    from pathlib import Path

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

    It is what `studio pkg check` finds; nothing is told of what is no package to build yet.
    """
    folder = package_folder_of(file.parent)
    if folder is None or folder.parent.name == "share":
        return ""
    name = name_of_package_in(folder)
    if not name:
        return ""
    # Imported where a file of a package is named: most of a plan are names of nodes.
    from studio.packages.lint.installed_files import not_installed  # noqa: PLC0415

    source = PackageSource(folder, name=name)
    found = not_installed(source, file.relative_to(folder).as_posix())
    return next((one.sentence.removesuffix(".") for one in found), "")


def name_of_package_in(folder: Path) -> str:
    """Return the name in a folder's package.xml; empty where it has none that can be read."""
    try:
        return package_name(ServedRoots([folder]).read(folder / FILE_NAME)) or ""
    except PackageError:
        return ""
