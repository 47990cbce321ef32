"""The packages that a command sees (of its folder, opened last, of ROS), and what they start."""

from __future__ import annotations

import importlib.util
import os
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING

import studio
from studio.files import is_file
from studio.packages.discovery import discover
from studio.packages.environment import RosEnvironment, is_workspace_install
from studio.packages.executables import executables_of
from studio.packages.folder_memory import FolderMemory
from studio.packages.index import Indexed, PackageIndex, Rank
from studio.packages.manifest import FILE_NAME
from studio.packages.recent import last_opened
from studio.packages.roots import ServedRoots, is_too_wide, package_folder_of, served_roots_for
from studio.settings import data_folder, repository_or_wheel

if TYPE_CHECKING:
    import argparse
    from collections.abc import Iterable


_MEMORY = "package_index/commands"
ENTRIES_MAX = 2_000
"""Limit of entries: a folder with more is no workspace, and takes too long to search."""


def add_package_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of every verb that finds packages."""
    parser.add_argument(
        "--package-path",
        action="append",
        default=[],
        metavar="DIR",
        help="find packages here, too; may be given again",
    )
    parser.add_argument("--data-dir", type=Path, metavar="DIR", help="where caches live")


def opened_packages(options: argparse.Namespace) -> PackageIndex:
    """Find the packages of `--package-path`, the current workspace, the last one and ROS."""
    folder = data_folder(options.data_dir)
    given = [Path(part) for one in options.package_path for part in one.split(os.pathsep) if part]
    named = [Path(os.path.realpath(one.expanduser())) for one in given]
    roots = dict.fromkeys([*named, *_workspace_of(Path.cwd()), *_last(folder)])
    environment = RosEnvironment.from_variables(os.environ)
    prefixes = environment.prefixes
    own = (repository_or_wheel("models"),)
    served = ServedRoots((*roots, *environment.folders, *own))
    memory = FolderMemory(folder / _MEMORY, served)
    found = [
        *_found([*roots, *own, *environment.sources], memory, is_prefix=False),
        *_found(prefixes, memory, is_prefix=True),
    ]
    memory.save()
    return PackageIndex({one.folder: one for one in reversed(found)}.values())


def _found(folders: Iterable[Path], memory: FolderMemory, *, is_prefix: bool) -> list[Indexed]:
    return [
        Indexed.found(package, order=order)
        for order, folder in enumerate(folders)
        if not is_too_wide(folder)
        for package in discover(folder, memory, is_prefix=is_prefix).packages
    ]


def _workspace_of(folder: Path) -> tuple[Path, ...]:
    """Return packages around a folder: beside the one it is in, below its `src`, or in it."""
    if is_too_wide(folder):
        return ()
    package = package_folder_of(folder)
    if package is not None:
        return served_roots_for(package / FILE_NAME)
    if folder.name == "src":
        return (folder,)
    if (folder / "src").is_dir():
        return (folder / "src",)
    return _packages_in(folder)


def _packages_in(folder: Path) -> tuple[Path, ...]:
    """Return the packages right in a folder, which may be any: one of downloads, or of pictures."""
    try:
        with os.scandir(folder) as entries:
            found = list(islice(entries, ENTRIES_MAX + 1))
            names = sorted(one.name for one in found)
    except OSError:
        return ()
    if len(found) > ENTRIES_MAX:
        return ()
    return tuple(folder / name for name in names if is_file(folder / name / FILE_NAME))


def _last(data: Path) -> tuple[Path, ...]:
    last = last_opened(data)
    return _workspace_of(Path(last.path).parent) if last is not None else ()


def executables_of_all(index: PackageIndex) -> dict[str, dict[str, str]]:
    """Return by package and name the file or module of all that can be started."""
    found = demo_executables()
    for name in index.names:
        own = executables_of(index.best(name, Path.cwd()), name)
        if workspace_folder(index, name) is not None:
            found.pop(name, None)
        if own:
            found[name] = {**own, **found.get(name, {})}
    return found


def workspace_folder(index: PackageIndex, name: str) -> Path | None:
    """Return the folder of a package that the user's workspace holds: it comes before a demo's.

    None where the name is unknown, or known only of a ROS that was installed as a whole.
    """
    if name not in index:
        return None
    folder = index.best(name, Path.cwd())
    ranks = [one.rank for one in index.packages if one.folder == folder]
    is_source = any(rank is not Rank.INSTALLED for rank in ranks)
    return folder if is_source or is_workspace_install(folder) else None


def demo_packages() -> set[str]:
    """Name the packages whose nodes the studio itself has."""
    return set(demo_executables())


def demo_executables() -> dict[str, dict[str, str]]:
    """Return the modules of the studio's own nodes by package and executable."""
    from studio.course.demos import executables

    found: dict[str, dict[str, str]] = {}
    for (package, name), module in executables().items():
        found.setdefault(package, {})[name] = module
    return found


def demo_folder(package: str) -> Path:
    """Return the folder that holds the code of a package of demos, which is one of the studio's."""
    module = next(iter(demo_executables()[package].values()))
    found = importlib.util.find_spec(module.rpartition(".")[0])
    return Path(next(iter((found and found.submodule_search_locations) or [""])))


def demo_manifest(package: str) -> str:
    """Write the package.xml that a package of demos would have; empty for any other."""
    names = ", ".join(sorted(demo_executables().get(package, {})))
    if not names:
        return ""
    return (
        '<?xml version="1.0"?>\n'
        "<!-- Written by the studio: these nodes come with it, in no package of their own. -->\n"
        '<package format="3">\n'
        f"  <name>{package}</name>\n"
        f"  <version>{studio.__version__}</version>\n"
        f"  <description>Demo nodes of the studio: {names}.</description>\n"
        '  <maintainer email="none@invalid">the studio</maintainer>\n'
        "  <license>Apache-2.0</license>\n"
        "</package>\n"
    )
