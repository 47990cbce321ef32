"""What a workspace of packages holds, as values: what the inspector shows.

Files are absolute paths; lines are 1-based, 0 where unknown.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path

    from studio.packages.executables import Executable


class Presence(StrEnum):
    """Where a package is that another one depends on."""

    WORKSPACE = "workspace"
    """Its source is among the inspected packages."""
    INSTALLED = "installed"
    """In a ROS that was sourced, or another opened folder."""
    ROS = "ros"
    """Part of ROS 2; the studio knows its name, and perhaps its types."""
    SYSTEM = "system"
    """By its name, something of the operating system, which rosdep installs: `python3-numpy`."""
    UNKNOWN = "unknown"
    """None of these: a package that is to be fetched, or a misspelt name."""


@dataclass(frozen=True, slots=True)
class Dependency:
    """One package that is depended on, with every tag that says so."""

    name: str
    kinds: tuple[str, ...]
    """Tags of package.xml, in the order of the file: `depend`, `exec_depend`, ..."""
    presence: Presence
    line: int = 0
    """Of the first tag."""


@dataclass(frozen=True, slots=True)
class InterfaceFile:
    """A message, service or action that the package defines."""

    name: str
    """In full: `my_interfaces/srv/AddPoints`."""
    kind: str
    """`msg`, `srv` or `action`."""
    file: Path
    is_generated: bool
    """Whether a `rosidl_generate_interfaces` of the CMakeLists.txt lists it."""
    fault: str = ""
    """Why it defines no type, a sentence; empty if it does."""
    line: int = 0
    """Of the fault."""


@dataclass(frozen=True, slots=True)
class LaunchFile:
    """A launch file of the package."""

    file: Path
    format: str
    """`python`, `xml` or `yaml`."""
    is_installed: bool
    """Whether setup.py or CMakeLists.txt installs it, so that `ros2 launch` finds it."""


@dataclass(frozen=True, slots=True)
class RobotFile:
    """A file that is, or might be taken for, a robot description."""

    file: Path
    title: str
    openable: bool
    reason: str = ""
    """Why it cannot be opened as a robot."""


@dataclass(frozen=True, slots=True)
class ParameterFile:
    """A YAML file with parameters of nodes."""

    file: Path
    nodes: tuple[str, ...]
    """Names as written, wildcards too: `/turtlesim`, `/**`."""


@dataclass(frozen=True, slots=True)
class InspectedPackage:
    """A package as its source shows it."""

    name: str
    folder: Path
    path: str
    """Folder below the workspace, with `/`; `.` when it is the workspace itself."""
    build_type: str
    """`ament_python`, `ament_cmake`, `cmake`, ...; as colcon takes it when none is exported."""
    version: str = ""
    description: str = ""
    licenses: tuple[str, ...] = ()
    maintainers: tuple[str, ...] = ()
    dependencies: tuple[Dependency, ...] = ()
    executables: tuple[Executable, ...] = ()
    interfaces: tuple[InterfaceFile, ...] = ()
    launch_files: tuple[LaunchFile, ...] = ()
    robots: tuple[RobotFile, ...] = ()
    rviz_configs: tuple[Path, ...] = ()
    parameter_files: tuple[ParameterFile, ...] = ()
    readme: Path | None = None
    is_nested: bool = False
    """It lies inside another package: colcon does not build it."""
    fault: str = ""
    """Why its package.xml was not read whole, a sentence."""
    is_complete: bool = True
    """False: it has more files than are looked at."""


@dataclass(frozen=True, slots=True)
class DependencyEdge:
    """One package of the workspace needs another one."""

    package: str
    needs: str
    kinds: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class DependencyNode:
    """A package in the graph: one of the workspace, or one that these need."""

    name: str
    presence: Presence


@dataclass(frozen=True, slots=True)
class DependencyGraph:
    """Who needs whom. Nodes of the workspace come first, in the order in which colcon builds."""

    nodes: tuple[DependencyNode, ...] = ()
    edges: tuple[DependencyEdge, ...] = ()
    cycles: tuple[tuple[str, ...], ...] = ()
    """Names of packages that need each other, so that colcon can build none of them first."""


@dataclass(frozen=True, slots=True)
class InspectedWorkspace:
    """All packages below a folder; `left_out` says in sentences what was not looked at."""

    root: Path
    packages: tuple[InspectedPackage, ...] = ()
    graph: DependencyGraph = DependencyGraph()
    left_out: tuple[str, ...] = ()

    def package(self, name: str) -> InspectedPackage | None:
        """Return a package by its name; of several, the first."""
        return next((one for one in self.packages if one.name == name), None)
