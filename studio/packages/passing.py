"""Packages that are passed on to the processes of a user's programs, in a variable."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Final

from studio.packages.index import Rank

if TYPE_CHECKING:
    from collections.abc import Mapping

    from studio.packages.index import PackageIndex

VARIABLE: Final = "STUDIO_PACKAGES"
"""`name=folder` of source packages, separated as in PATH."""
_LENGTH_MAX: Final = 100_000
"""Linux takes no longer variable than 128 KiB."""


def environment_of(index: PackageIndex, asking: Path) -> dict[str, str]:
    """Return the variable for a program that lies at `asking`; the nearest packages come first.

    Installed packages are left out: their prefixes are in AMENT_PREFIX_PATH. So are the farthest
    where there are more than a variable holds.
    """
    installed = {one.folder for one in index.packages if one.rank is Rank.INSTALLED}
    found = ((name, index.best(name, asking)) for name in sorted(index.names))
    named = [(name, folder) for name, folder in found if folder not in installed]
    named.sort(key=lambda one: -_shared_steps(one[1], asking))
    rows: list[str] = []
    length = 0
    for name, folder in named:
        row = f"{name}={folder}"
        length += len(row.encode(errors="replace")) + 1
        if length > _LENGTH_MAX:
            break
        if os.pathsep not in row:
            rows.append(row)
    return {VARIABLE: os.pathsep.join(rows)} if rows else {}


def _shared_steps(folder: Path, asking: Path) -> int:
    steps = zip(folder.parts, asking.parts, strict=False)
    return next(
        (count for count, (one, other) in enumerate(steps) if one != other), len(folder.parts)
    )


def passed_packages(environment: Mapping[str, str] = os.environ) -> dict[str, Path]:
    """Return the folders of packages that were passed on, by name; the first of a name counts."""
    found: dict[str, Path] = {}
    for row in filter(None, environment.get(VARIABLE, "").split(os.pathsep)):
        name, equals, folder = row.partition("=")
        if equals:
            found.setdefault(name, Path(folder))
    return found
