"""Looks at the packages below a folder: reads their files, bounded, and runs nothing."""

from __future__ import annotations

import os
import re
from collections import defaultdict
from pathlib import Path
from typing import TYPE_CHECKING, Final

from studio.packages.discovery import FOLDER_LIMIT, Origin, Package, discover
from studio.packages.executables import executables
from studio.packages.folder_memory import FolderMemory
from studio.packages.inspection.dependencies import dependency_graph
from studio.packages.inspection.inspected import (
    Dependency,
    InspectedPackage,
    InspectedWorkspace,
    InterfaceFile,
    LaunchFile,
    ParameterFile,
    Presence,
    RobotFile,
)
from studio.packages.known import Known
from studio.packages.robot_files import robot_candidates
from studio.packages.roots import ServedRoots
from studio.packages.ros_packages import is_system_key
from studio.packages.shares import left_out
from studio.packages.sources.interfaces import ENDINGS, interface_files
from studio.packages.sources.package_source import PackageSource

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping


PACKAGES_MAX: Final = 300
INTERFACES_MAX: Final = 500
LAUNCH_SUFFIXES: Final = {
    ".launch.py": "python",
    ".launch.xml": "xml",
    ".launch.yaml": "yaml",
    ".launch.yml": "yaml",
    "_launch.py": "python",
    "_launch.xml": "xml",
    "_launch.yaml": "yaml",
}
_PARAMETERS: Final = re.compile(rb"^([ \t]*)ros__parameters[ \t]*:", re.MULTILINE)
_KEY: Final = re.compile(rb"""^([ \t]*)["']?([^\s"'#:][^"'#:]*)["']?[ \t]*:[ \t]*(?:#.*)?$""")
_PARAMETER_FILES_MAX: Final = 100


class PackagesFound:
    """The packages below a folder with their sources, for one look at them.

    Args:
        root: The folder.
        memory: What is known of its folders from earlier; None: nothing.
        read: Returns the bytes of a file as they are edited now, None to read the disk.
    """

    def __init__(
        self,
        root: Path,
        memory: FolderMemory | None = None,
        read: Callable[[Path], bytes | None] | None = None,
    ) -> None:
        self.root = Path(os.path.realpath(root))
        self.roots = ServedRoots([self.root])
        self.memory = memory or FolderMemory(None, self.roots)
        found = discover(self.root, self.memory)
        own = [one for one in found.packages if one.origin is not Origin.INSTALLED]
        own += _nameless(self.root, self.memory, {one.folder for one in found.packages})
        self.packages: tuple[Package, ...] = tuple(own[:PACKAGES_MAX])
        self.sources = {one.folder: PackageSource(one.folder, read) for one in self.packages}
        self.left_out: list[str] = []
        if len(own) > PACKAGES_MAX:
            self.left_out.append(
                f"{self.root} holds {len(own)} packages: the first {PACKAGES_MAX} are looked at, "
                "open a folder inside it for the others."
            )
        if not found.complete:
            self.left_out.append(f"{self.root} has too many folders to look into all of them.")

    @property
    def names(self) -> frozenset[str]:
        """The names of the packages."""
        return frozenset(one.name for one in self.packages)


def _nameless(root: Path, memory: FolderMemory, named: set[Path]) -> list[Package]:
    """Return the folders whose package.xml names no package, called as the folder is.

    colcon passes over them, and their owner wants to know why.
    """
    found: list[Package] = []
    waiting = [str(root)]
    for _ in range(FOLDER_LIMIT):
        if not waiting:
            break
        folder = waiting.pop()
        facts = memory.facts(folder)
        if facts is None or facts.ignored or facts.is_install_space:
            continue
        path = Path(folder)
        if facts.has_manifest and path not in named:
            found.append(Package(path.name, path, Origin.SOURCE))
        inner = (one for one in facts.subfolders if one not in {"build", "install", "log", "devel"})
        waiting += [f"{folder}{os.sep}{one}" for one in inner]
    return sorted(found, key=lambda one: one.folder)


def inspect_workspace(found: PackagesFound, known: Known | None = None) -> InspectedWorkspace:
    """Return what a folder of packages holds."""
    known = known or Known()
    robots = _robots_by_package(found)
    packages = tuple(
        _inspected(package, found, known, robots.get(package.folder, ()))
        for package in found.packages
    )
    return InspectedWorkspace(
        found.root, packages, dependency_graph(packages), tuple(found.left_out)
    )


def _inspected(
    package: Package, found: PackagesFound, known: Known, robots: tuple[RobotFile, ...]
) -> InspectedPackage:
    source = found.sources[package.folder]
    manifest = source.manifest
    fault = ""
    if manifest.fault:
        reason = f"{manifest.fault} (line {manifest.fault_line})"
        fault = f"package.xml was read as far as its fault: {reason}."
    elif not manifest.name:
        fault = "Its package.xml names no package, or cannot be read: colcon passes over it."
    readmes = (one for one in source.names if re.fullmatch(r"(?i)readme(\.\w+)?", one))
    readme = next(readmes, None)
    return InspectedPackage(
        name=package.name,
        folder=package.folder,
        path=package.folder.relative_to(found.root).as_posix(),
        build_type=source.build_type,
        version=manifest.text_of("version"),
        description=" ".join(manifest.text_of("description").split()),
        licenses=tuple(one.text for one in manifest.of("license")),
        maintainers=tuple(_person(one.text, one.attributes) for one in manifest.of("maintainer")),
        dependencies=tuple(_dependencies(source, found.names, known)),
        executables=executables(source, with_faults=True),
        interfaces=interfaces(source, known),
        launch_files=tuple(_launch_files(source)),
        robots=robots,
        rviz_configs=tuple(source.path(one) for one in source.below("", ".rviz")),
        parameter_files=tuple(_parameter_files(source)),
        readme=source.path(readme) if readme else None,
        is_nested=package.origin is Origin.NESTED,
        fault=fault,
        is_complete=source.is_complete,
    )


def _person(name: str, attributes: Mapping[str, str]) -> str:
    email = attributes.get("email", "")
    return f"{name} <{email}>" if email else name


def _dependencies(
    source: PackageSource, names: frozenset[str], known: Known
) -> Iterator[Dependency]:
    tags: dict[str, list[str]] = defaultdict(list)
    lines: dict[str, int] = {}
    for one in source.manifest.dependencies():
        if one.text:
            tags[one.text].append(one.tag)
            lines.setdefault(one.text, one.line)
    for name, kinds in tags.items():
        yield Dependency(
            name, tuple(dict.fromkeys(kinds)), presence_of(name, names, known), lines[name]
        )


def presence_of(name: str, names: frozenset[str], known: Known) -> Presence:
    """Return where a package is, seen from a workspace with these packages."""
    if name in names:
        return Presence.WORKSPACE
    if name in known.installed:
        return Presence.INSTALLED
    if known.has_package(name):
        return Presence.ROS
    return Presence.SYSTEM if is_system_key(name) else Presence.UNKNOWN


def interfaces(source: PackageSource, known: Known) -> tuple[InterfaceFile, ...]:
    """Return the messages, services and actions that a package defines."""
    listed = generated_names(source)
    found: list[InterfaceFile] = []
    for kind, name in interface_files(source):
        if name.count("/") != 1 or len(found) >= INTERFACES_MAX:
            continue
        full = f"{source.name}/{name.removesuffix(f'.{kind}')}"
        text = source.text(name)
        fault = known.type_fault(full, text.text) if text else None
        sentence, line = (fault.sentence, fault.line) if fault else ("", 0)
        path = source.path(name)
        found.append(InterfaceFile(full, kind, path, name in listed, sentence, line))
    return tuple(found)


def generated_names(source: PackageSource) -> frozenset[str]:
    """Return the interface files that CMakeLists.txt has generated, by their names as written."""
    lists = source.cmake
    if lists is None:
        return frozenset()
    calls = lists.of("rosidl_generate_interfaces", "set")
    values = {one for call in calls for one in call.values if one.endswith(ENDINGS)}
    globbed = {one for call in lists.of("file") for one in call.values if "*" in one}
    matched = {
        name for kind, name in interface_files(source) if any(f"{kind}/" in one for one in globbed)
    }
    return frozenset(values | matched)


def launch_format(name: str) -> str:
    """Return the format of a launch file by its name; empty if it is none by its name."""
    for suffix, form in LAUNCH_SUFFIXES.items():
        if name.endswith(suffix):
            return form
    if name.startswith("launch/") and name.count("/") == 1:
        return {"py": "python", "xml": "xml", "yaml": "yaml"}.get(name.rpartition(".")[2], "")
    return ""


def _launch_files(source: PackageSource) -> Iterator[LaunchFile]:
    files = {one: form for one in source.names if (form := launch_format(one))}
    left = left_out(source, files)
    for name, form in files.items():
        yield LaunchFile(source.path(name), form, name not in left)


def _parameter_files(source: PackageSource) -> Iterator[ParameterFile]:
    names = [*source.below("", ".yaml", ".yml")][:_PARAMETER_FILES_MAX]
    for name in names:
        data = source.data(name)
        if data is not None and (nodes := parameter_nodes(data)):
            yield ParameterFile(source.path(name), nodes)


def parameter_nodes(data: bytes) -> tuple[str, ...]:
    """Return the names of nodes above each `ros__parameters` of a YAML file, read line by line."""
    lines = data.splitlines()[:20_000]
    above: list[tuple[int, str]] = []
    found: dict[str, None] = {}
    for line in lines:
        if parameters := _PARAMETERS.match(line):
            indent = len(parameters[1])
            path = [name for width, name in above if width < indent]
            if path:
                found["/".join(path)] = None
        elif key := _KEY.match(line):
            indent = len(key[1])
            above = [row for row in above if row[0] < indent]
            above.append((indent, key[2].decode("utf-8", "replace").strip()))
    return tuple(found)


def _robots_by_package(found: PackagesFound) -> dict[Path, tuple[RobotFile, ...]]:
    by_folder: dict[Path, list[RobotFile]] = defaultdict(list)
    folders = sorted(found.sources, key=lambda one: -len(one.parts))
    for point in robot_candidates(found.root, found.roots, memory=found.memory):
        if point.kind == "urdf" and not point.openable and not point.path.name.endswith(".urdf"):
            continue
        parents = set(point.path.parents)
        folder = next((one for one in folders if one in parents), None)
        if folder is not None:
            by_folder[folder].append(
                RobotFile(point.path, point.title, point.openable, point.reason)
            )
    return {folder: tuple(robots) for folder, robots in by_folder.items()}
