"""Entry points of Python packages: followed from setup.py to the function that is run."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from studio.errors import EntryPointError
from studio.packages.sources.entries import faults_of

if TYPE_CHECKING:
    from pathlib import Path

    from studio.packages.sources.package_source import PackageSource


@dataclass(frozen=True, slots=True)
class EntryPoint:
    """What an executable of a Python package runs.

    Attributes:
        module: Its dotted name.
        function: The function in it, which may be dotted.
        file: The module's file.
        root: The folder that has to be on the path for the module to be found.
    """

    name: str
    module: str
    function: str
    file: Path
    root: Path


def find_entry_point(source: PackageSource, executable: str) -> EntryPoint | None:
    """Find what an executable of a package runs; None where no setup file names it.

    Raises:
        EntryPointError: It would not start in ROS 2, or its entry is hidden: the finding of
            `studio pkg check` that says so.
    """
    fault = next(faults_of(source, executable), None)
    if fault is not None:
        # Checks are imported only where there is something to tell: a node starts without them.
        from studio.packages.lint.entries import problem_of  # noqa: PLC0415

        raise EntryPointError(problem_of(source, fault))
    script = source.script(executable)
    found = source.module(script.module) if script else None
    if script is None or found is None:
        return None
    root, file = found
    path = source.path(root).resolve()
    return EntryPoint(executable, script.module, script.function, source.path(file), path)
