"""Where a document lies: what its worker may read, and which packages its files are in."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

from studio.description.values import ReadPolicy
from studio.documents.runs import Target
from studio.packages.roots import package_folder_of
from studio.settings import XACRO_ENVIRONMENT

if TYPE_CHECKING:
    from collections.abc import Iterable

    from studio.packages.workspace import Location


def target_of(location: Location, *, trusted: bool) -> Target:
    """The entry file of a location that has one, and the rules its expansion runs under.

    Trust shows the files the whole environment, and nothing else: expressions stay bounded, and
    what may be read is what is served. What came in an archive is never trusted.
    """
    assert location.entry is not None
    trusted = trusted and not location.is_unpacked
    environment = {
        name: value for name, value in os.environ.items() if trusted or name in XACRO_ENVIRONMENT
    }
    policy = ReadPolicy(
        roots=tuple(map(str, location.served.all)),
        packages=location.index.mapping_for(location.entry),
        environment=environment,
        trusted=trusted,
    )
    return Target(str(location.entry), policy)


class PackagesUsed:
    """Remembers what it answered last."""

    def __init__(self) -> None:
        self._asked: tuple[tuple[str, ...], Location] | None = None
        self._answer: dict[str, str] = {}

    def of(self, files: Iterable[str], location: Location) -> dict[str, str]:
        """Package name to the copy that is used; the same object while nothing changed."""
        asked = tuple(files)
        before = self._asked
        if before is None or before[0] != asked or before[1] is not location:
            self._asked = asked, location
            self._answer = _packages_of(asked, location)
        return self._answer


def _packages_of(files: tuple[str, ...], location: Location) -> dict[str, str]:
    folders = {package_folder_of(Path(folder)) for folder in {Path(one).parent for one in files}}
    packages = location.index.packages
    return {one.name: str(one.folder) for one in packages if one.folder in folders}
