"""Checks of what the build installs: launch files, robots and settings where ROS finds them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from studio.packages.edits import cmake_edits, setup_edits
from studio.packages.inspection.inspecting import LAUNCH_SUFFIXES, launch_format
from studio.packages.lint.checked import WARNING, found, safely
from studio.packages.shares import left_out
from studio.packages.sources.interfaces import KINDS

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.packages.lint.checked import CheckedPackage
    from studio.packages.sources.cmake import CMakeLists
    from studio.packages.sources.package_source import PackageSource
    from studio.packages.sources.setup_py import SetupPy
    from studio.problems import Fix, Problem

FOLDERS: Final = ("launch", "urdf", "config", "rviz", "meshes", "worlds", "maps", "params")
"""What packages install besides code."""


def findings(checked: CheckedPackage) -> Iterator[Problem]:
    """Yield the first file of each folder, and each launch file of the root, that is left out."""
    source = checked.source
    setup, lists = source.setup, source.cmake
    folders: tuple[str, ...] = ()
    if source.is_python and setup is not None:
        folders = (*FOLDERS, *KINDS)
    elif lists is not None and not lists.fault and source.build_type == "ament_cmake":
        folders = FOLDERS
    for folder in folders:
        left = left_out(source, (one for one in source.below(folder) if _is_wanted(source, one)))
        if left:
            yield from _problem(source, left[0])
    for name in source.names if source.is_python else ():
        if "/" not in name and launch_format(name):
            yield from not_installed(source, name)


def _is_wanted(source: PackageSource, name: str) -> bool:
    """Whether a file is one that others look for: of Python's folder `launch`, a launch file."""
    if name.endswith((".pyc", "/__init__.py")):
        return False
    return not source.is_python or not name.startswith("launch/") or bool(launch_format(name))


def not_installed(source: PackageSource, name: str) -> Iterator[Problem]:
    """Yield the finding that the build does not install a file of a package, if it does not.

    Nothing is told of a package that builds nothing yet, or that computes what it installs.
    """
    if left_out(source, [name]):
        yield from _problem(source, name)


def _problem(source: PackageSource, name: str) -> Iterator[Problem]:
    setup, lists = source.setup, source.cmake
    if setup is not None and (source.is_python or lists is None):
        if setup.call is not None:  # else a finding of `entries`
            yield _of_setup(source, setup, name)
    elif lists is not None:
        yield _of_cmake(lists, name)


def _sentence(name: str, mend: str) -> str:
    return f"{name} is not installed, so ROS does not find it after the build: {mend}."


def _of_setup(source: PackageSource, setup: SetupPy, name: str) -> Problem:
    folder, _, _ = name.rpartition("/")
    top = name.partition("/")[0]
    pattern = _pattern(source, name)
    fix: Fix | None = None
    if folder in {"", top}:
        label = f"Install {top}"
        fix = safely(label, lambda: setup_edits.data_files_added(setup, [(folder, pattern)]))
    try:
        row = setup_edits.data_files_row(setup, folder, pattern)
    except ValueError:
        mend = "data_files in setup.py has to name it"
    else:
        mend = f"add {row} to data_files in setup.py"
        if "glob(" in row and not setup_edits.imports_glob(setup):
            mend = (
                f"write from glob import glob at the top of setup.py, and add {row} to its "
                "data_files"
            )
    node = setup.keyword("data_files")
    at = setup.python.span(node)[0] if node else 0
    code = "folder-not-installed" if folder else "launch-not-installed"
    return found(WARNING, code, _sentence(name, mend), setup.source, at, fix)


def _pattern(source: PackageSource, name: str) -> str:
    """Return a pattern for the files of a folder that are left out, or one file's name.

    A pattern of all files would match folders, too, at which setuptools stops.
    """
    folder, _, last = name.rpartition("/")
    if not folder:
        return last
    left = left_out(source, source.below(folder))
    for ending in LAUNCH_SUFFIXES:
        if all(one.endswith(ending) for one in left):
            return f"*{ending}"
    return last if any("/" in one[len(folder) + 1 :] for one in source.below(folder)) else "*"


def _of_cmake(lists: CMakeLists, name: str) -> Problem:
    folder, slash, _ = name.partition("/")
    what = f"DIRECTORY {folder}" if slash else f"FILES {name}"
    line = f"install({what} DESTINATION share/${{PROJECT_NAME}})"
    fix: Fix | None = None
    if slash:
        fix = safely(f"Install {folder}", lambda: cmake_edits.installed_folder(lists, folder))
    sentence = _sentence(name, f"add {line} to CMakeLists.txt, before ament_package()")
    return found(WARNING, "cmake-folder-not-installed", sentence, lists.source, 0, fix)


_SEEN: Final = {
    "en": "ros2 launch and get_package_share_directory see what was installed, not the source.",
    "de": "ros2 launch und get_package_share_directory sehen das Installierte, nicht die Quellen.",
}
WHY: Final = {
    "launch-not-installed": {
        "en": "ros2 launch sees what was installed, not the source.",
        "de": "ros2 launch sieht das Installierte, nicht die Quellen.",
    },
    "folder-not-installed": _SEEN,
    "cmake-folder-not-installed": _SEEN,
}
"""By code and language: why a finding matters, as the page explains it."""
