"""What a folder of packages holds, and what is wrong in it: read in a thread."""

from __future__ import annotations

import os
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING

from studio.live.known_packages import known_packages
from studio.packages.discovery import discover
from studio.packages.environment import RosEnvironment
from studio.packages.folder_memory import FolderMemory
from studio.packages.inspection.inspecting import PackagesFound, inspect_workspace
from studio.packages.lint.package_checks import check_packages
from studio.packages.roots import ServedRoots
from studio.ros.profiles import JAZZY
from studio.ros.types.library import TypeLibrary

if TYPE_CHECKING:
    from pathlib import Path

    from studio.packages.inspection.inspected import InspectedWorkspace
    from studio.packages.known import Known
    from studio.problems import Problem


@dataclass(frozen=True, slots=True)
class Inspected:
    """A folder of packages, and the findings in it."""

    workspace: InspectedWorkspace
    problems: tuple[Problem, ...] = ()


@cache
def what_is_known() -> Known:
    """Return the types and packages that the studio has, and those of a ROS that was sourced."""
    environment = RosEnvironment.from_variables(os.environ)
    memory = FolderMemory(None, ServedRoots(environment.folders))
    installed = (
        one.name
        for prefix in environment.prefixes
        for one in discover(prefix, memory, is_prefix=True).packages
    )
    return known_packages(TypeLibrary(JAZZY.distro), installed)


def inspect(root: Path) -> Inspected:
    """Read all packages below a folder."""
    found, known = PackagesFound(root), what_is_known()
    return Inspected(inspect_workspace(found, known), check_packages(found, known))
