"""The packages that a command sees: of its folder, opened last, of ROS."""

from __future__ import annotations

import os
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING

from studio.files import is_file
from studio.packages.discovery import discover
from studio.packages.environment import RosEnvironment
from studio.packages.folder_memory import FolderMemory
from studio.packages.index import Indexed, PackageIndex
from studio.packages.manifest import FILE_NAME
from studio.packages.recent import last_opened
from studio.packages.roots import (
    ServedRoots,
    is_below,
    is_too_wide,
    package_folder_of,
    served_roots_for,
)
from studio.packages.run_folders import is_received
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


def opened_packages(options: argparse.Namespace, *, to_run: bool = False) -> PackageIndex:
    """Find the packages of `--package-path`, the current workspace, the last one and ROS.

    Args:
        options: Those of `add_package_options`.
        to_run: Leaves out what came in an archive or from others, unless its own folder is named
            or is the current one: who looks at a zip has not asked for its nodes.
    """
    folder = data_folder(options.data_dir)
    given = [Path(part) for one in options.package_path for part in one.split(os.pathsep) if part]
    named = [Path(os.path.realpath(one.expanduser())) for one in given]
    asked = dict.fromkeys([*named, *_workspace_of(Path.cwd())])
    roots = dict.fromkeys([*asked, *_last(folder)])
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
    index = PackageIndex({one.folder: one for one in reversed(found)}.values())
    if not to_run:
        return index
    own = [one for one in asked if is_received(one, folder)]
    return index.without(
        lambda one: is_received(one, folder) and not any(is_below(one, root) for root in own)
    )


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
