"""Checks of packages: whether one of the opened folders has problems."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Protocol

from studio.documents.lessons.verdict import HOLDS, Verdict, missing
from studio.packages.roots import is_below
from studio.problems import Severity

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from studio.packages.inspection.inspected import InspectedWorkspace
    from studio.problems import Problem


class InspectedFolder(Protocol):
    """A folder of packages that was read."""

    @property
    def workspace(self) -> InspectedWorkspace:
        """What it holds."""
        ...

    @property
    def problems(self) -> tuple[Problem, ...]:
        """What is wrong in it."""
        ...


def package_verdict(values: Mapping[str, str], folders: Iterable[InspectedFolder]) -> Verdict:
    """Return how a check of a package stands.

    Args:
        values: What fills its form.
        folders: The opened ones; who reads is told a count alone, for not all may see these files.
    """
    for folder in folders:
        for package in folder.workspace.packages:
            if package.name == values["name"]:
                count = sum(_concerns(one, package.folder) for one in folder.problems)
                return missing("package.problems", count=count) if count else HOLDS
    return missing("package.none")


def _concerns(problem: Problem, folder: Path) -> bool:
    """Whether a problem is more than a remark, and about a file of the package."""
    is_grave = problem.severity in {Severity.ERROR, Severity.WARNING}
    return is_grave and problem.place is not None and is_below(Path(problem.place.file), folder)
