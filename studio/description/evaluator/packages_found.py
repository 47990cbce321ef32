"""`$(find name)` without ROS: folders given by name, the nearest one when there are several."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from studio.description.faults import misnamed
from studio.packages.near_files import is_misspelt

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence


def find_package(packages: Mapping[str, tuple[str, ...]], name: str, asking_file: str) -> str:
    """The folder of a package: of several, the one that shares the longest path with the asker.

    Raises:
        Fault: There is none of that name; its fix is to write one that is near, or to choose the
            folder.
    """
    folders = packages.get(name, ())
    if not folders:
        sentence = f'The package "{name}" was not found'
        otherwise = "choose its folder or give --package-path."
        # A word that many packages end with, as _description, makes no two of them alike.
        alike = [one for one in packages if is_misspelt(name, one)]
        fault = misnamed("package-not-found", sentence, name, alike, otherwise)
        fault.package = name
        raise fault
    if len(folders) == 1:
        return folders[0]
    asking = Path(asking_file).parts
    return max(folders, key=lambda folder: _shared(Path(folder).parts, asking))


def _shared(left: Sequence[str], right: Sequence[str]) -> int:
    count = 0
    for one, other in zip(left, right, strict=False):
        if one != other:
            break
        count += 1
    return count
