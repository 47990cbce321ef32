"""All checks of packages: what would fail when they are built, started or called."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from functools import cache
from typing import TYPE_CHECKING, Final, TypeAlias

from studio.packages import lint
from studio.packages.known import Known
from studio.packages.lint.checked import CheckedPackage, CheckedWorkspace
from studio.problems import Problem, Severity, modules_of

if TYPE_CHECKING:
    from studio.packages.inspection.inspecting import PackagesFound

Check: TypeAlias = Callable[["CheckedPackage"], Iterator["Problem"]]
ALIKE_AT_MOST: Final = 100
"""Findings of one code that are listed one by one."""
_ORDER: Final = (Severity.ERROR, Severity.WARNING, Severity.INFO)
_NOT_BUILT: Final = frozenset({"catkin"})
"""Build types of ROS 1: their packages keep to other rules."""


def check_packages(
    packages: PackagesFound, known: Known | None = None, names: Iterable[str] = ()
) -> tuple[Problem, ...]:
    """Return what is wrong with the packages below a folder, package by package, errors first.

    Args:
        packages: As they were found.
        known: What ROS and the studio have.
        names: Check these alone; the others are still what they may need.
    """
    by_name = {one.name: packages.sources[one.folder] for one in reversed(packages.packages)}
    workspace = CheckedWorkspace(by_name, known or Known())
    wanted = set(names)
    counts = Counter[str]()
    listed: list[Problem] = []
    for one in packages.packages:
        if wanted and one.name not in wanted:
            continue
        checked = CheckedPackage(packages.sources[one.folder], workspace)
        if checked.source.build_type in _NOT_BUILT:
            continue
        listed += sorted(package_findings(checked), key=_rank)
    kept: list[Problem] = []
    for one in dict.fromkeys(listed):
        counts[one.code] += 1
        if counts[one.code] <= ALIKE_AT_MOST:
            kept.append(one)
    more = {code: count - ALIKE_AT_MOST for code, count in counts.items() if count > ALIKE_AT_MOST}
    return (*kept, *(_more(code, count, kept) for code, count in more.items()))


def package_findings(checked: CheckedPackage) -> Iterator[Problem]:
    """Yield the findings of every check in one package."""
    for check in _checks():
        yield from check(checked)


def _rank(one: Problem) -> tuple[int, str, int]:
    place = one.place
    return _ORDER.index(one.severity), place.file if place else "", place.line if place else 0


def _more(code: str, count: int, kept: list[Problem]) -> Problem:
    severity = next(one.severity for one in kept if one.code == code)
    return Problem(
        severity,
        code,
        f'"{code}" was found {count:,} times more: mend those that are listed first.',
    )


@cache
def _checks() -> tuple[Check, ...]:
    """Return the function `findings` of every file in this folder that has one."""
    return tuple(one.findings for one in modules_of(lint) if hasattr(one, "findings"))
