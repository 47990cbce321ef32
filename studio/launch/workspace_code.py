"""Python packages of the workspace, which launch files import helpers from."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.files import is_file, is_folder

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.packages.index import PackageIndex


def module_folders(index: PackageIndex) -> Callable[[str], str | None]:
    """Return a function that gives the folder in which a workspace's module lies; None: in none."""

    def folder_of(name: str) -> str | None:
        if name not in index:
            return None
        for one in index.packages:
            if one.name != name or one.folder.parent.name == "share":
                continue
            for root in (one.folder, one.folder / "src"):
                if is_folder(root / name) and is_file(root / name / "__init__.py"):
                    return str(root)
        return None

    return folder_of
