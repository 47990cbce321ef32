"""`studio pkg inspect`: say what packages hold, and how they need each other."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

from studio.cli.terminal import harmless
from studio.errors import PackageNotFoundError, UnreadableFileError

if TYPE_CHECKING:
    import argparse
    from collections.abc import Iterator

    from studio.cli.verbs import Verbs
    from studio.packages.inspection.inspected import InspectedPackage, InspectedWorkspace
    from studio.packages.inspection.inspecting import PackagesFound
    from studio.packages.known import Known


def add(verbs: Verbs) -> None:
    """Add the verb and its options."""
    parser = verbs.add("inspect", _inspect, "say what packages hold, and what they need")
    parser.add_argument(
        "package_name",
        metavar="PACKAGE",
        nargs="?",
        help="one package in full, or a folder of packages",
    )
    add_folder(parser)
    parser.add_argument("--json", action="store_true", help="print it as JSON")


def add_folder(parser: argparse.ArgumentParser) -> None:
    """Add the option for the folder of packages."""
    parser.add_argument(
        "--folder",
        type=Path,
        default=None,
        metavar="DIR",
        help="the workspace; by default the one of the current folder",
    )


def found_packages(folder: Path | None) -> PackagesFound:
    """Find the packages of a folder, or of the workspace in which one stands.

    Raises:
        UnreadableFileError: It is no folder, or too wide to look into.
    """
    from studio.packages.inspection.inspecting import PackagesFound
    from studio.packages.roots import is_too_wide, served_roots_for

    root = Path(os.path.realpath((folder or _workspace(Path.cwd())).expanduser()))
    if not root.is_dir() or is_too_wide(root):
        served_roots_for(root)
        raise UnreadableFileError(str(root), "is no folder of packages.")
    return PackagesFound(root)


def _workspace(here: Path) -> Path:
    """Return the workspace around a folder: the `src` it is in or has, else itself."""
    from studio.packages.roots import package_folder_of

    package = package_folder_of(here)
    if package is not None:
        return package.parent if package.parent.name == "src" else package
    return here / "src" if (here / "src").is_dir() else here


def what_is_known() -> Known:
    """Return what ROS and the studio have."""
    from studio.live.known_packages import known_packages
    from studio.packages.discovery import discover
    from studio.packages.environment import RosEnvironment
    from studio.packages.folder_memory import FolderMemory
    from studio.packages.roots import ServedRoots
    from studio.ros.profiles import JAZZY
    from studio.ros.types.library import TypeLibrary

    environment = RosEnvironment.from_variables(os.environ)
    memory = FolderMemory(None, ServedRoots(environment.folders))
    installed = (
        one.name
        for prefix in environment.prefixes
        for one in discover(prefix, memory, is_prefix=True).packages
    )
    return known_packages(TypeLibrary(JAZZY.distro), installed)


def _inspect(options: argparse.Namespace) -> int:
    from studio.packages.inspection.inspecting import inspect_workspace

    name, folder = options.package_name, options.folder
    here: Path | None = None
    if name is not None and folder is None and _is_folder(name):
        here = Path(os.path.realpath(Path(name).expanduser()))
        name, folder = None, _workspace(here)
    workspace = inspect_workspace(found_packages(folder), what_is_known())
    if here is not None:  # a folder that is a package is told in full
        name = next((one.name for one in workspace.packages if one.folder == here), None)
    if name is not None:
        package = workspace.package(name)
        if package is None:
            raise PackageNotFoundError(name, str(workspace.root))
        if options.json:
            _print_json(package)
        else:
            print(*map(harmless, _in_full(package)), sep="\n")
        return 0
    if options.json:
        _print_json(workspace)
    else:
        print(*map(harmless, _listed(workspace)), sep="\n")
    return 0


def _is_folder(word: str) -> bool:
    """Whether a word names a folder: `.` and `src/my_pkg` do, and `my_pkg` is a package."""
    return word in {".", ".."} or ("/" in word and Path(word).expanduser().is_dir())


def _print_json(value: object) -> None:
    import msgspec

    text = msgspec.json.encode(value, enc_hook=str)
    print(msgspec.json.format(text).decode())


def _listed(workspace: InspectedWorkspace) -> Iterator[str]:
    if not workspace.packages:
        yield f"{workspace.root} holds no package."
    for one in workspace.packages:
        counts = {
            "executable": len(one.executables),
            "interface": len(one.interfaces),
            "launch file": len(one.launch_files),
            "robot": sum(robot.openable for robot in one.robots),
        }
        has = ", ".join(f"{n} {what}{'s' * (n > 1)}" for what, n in counts.items() if n)
        needs = sorted(
            edge.needs
            for edge in workspace.graph.edges
            if edge.package == one.name and workspace.package(edge.needs)
        )
        behind = f"; needs {', '.join(needs)}" if needs else ""
        yield f"{one.name} ({one.build_type}, {one.path}): {has or 'no program'}{behind}"
    for cycle in workspace.graph.cycles:
        yield f"These need each other, so none can be built first: {', '.join(cycle)}."
    yield from workspace.left_out


def _in_full(package: InspectedPackage) -> Iterator[str]:
    yield f"{package.name} {package.version}".strip()
    yield f"  folder: {package.folder}"
    yield f"  build type: {package.build_type}"
    yield f"  description: {package.description}"
    yield f"  license: {', '.join(package.licenses)}"
    yield f"  maintainer: {', '.join(package.maintainers)}"
    if package.fault:
        yield f"  {package.fault}"
    rows: dict[str, list[str]] = {
        "depends on": [
            f"{one.name} ({', '.join(one.kinds)}; {one.presence})" for one in package.dependencies
        ],
        "executables": [
            f"{one.name}: {one.place}" + (f" - {one.fault}" if one.fault else "")
            for one in package.executables
        ],
        "interfaces": [
            one.name + (f" - {one.fault}" if one.fault else "") for one in package.interfaces
        ],
        "launch files": [
            _below(package, one.file) + ("" if one.is_installed else " - not installed")
            for one in package.launch_files
        ],
        "robots": [_below(package, one.file) for one in package.robots if one.openable],
        "RViz configs": [_below(package, one) for one in package.rviz_configs],
        "parameters": [
            f"{_below(package, one.file)}: {', '.join(one.nodes)}"
            for one in package.parameter_files
        ],
    }
    for what, lines in rows.items():
        if lines:
            yield f"  {what}:"
            yield from (f"    {one}" for one in lines)


def _below(package: InspectedPackage, file: Path) -> str:
    return file.relative_to(package.folder).as_posix()
