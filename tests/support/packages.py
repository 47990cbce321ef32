"""Makes small ROS packages and workspaces of real files."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path


def write_package(
    folder: Path, name: str | None = None, files: dict[str, str] | None = None
) -> Path:
    """A package folder with its package.xml and these files; named like the folder by default."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "package.xml").write_text(
        f'<?xml version="1.0"?>\n<package format="3">\n  <name>{name or folder.name}</name>\n'
        "  <version>0.1.0</version>\n</package>\n"
    )
    for path, text in (files or {}).items():
        target = folder / path
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(text)
    return folder


def write_install(folder: Path, names: list[str], *, isolated: bool = True) -> Path:
    """An install space as colcon leaves it, one prefix for each package or one for all."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / ".colcon_install_layout").write_text("isolated\n" if isolated else "merged\n")
    (folder / "COLCON_IGNORE").touch()
    for name in names:
        write_package((folder / name if isolated else folder) / "share" / name)
    return folder
