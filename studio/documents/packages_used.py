"""Which packages the files of a document lie in: looked up when the files change, not per edit."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from studio.packages.roots import package_folder_of

if TYPE_CHECKING:
    from collections.abc import Iterable

    from studio.packages.workspace import Location


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
