"""The packages of a ROS that was sourced in the shell: read, never written."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Final

from studio.files import is_file, is_folder, is_there
from studio.packages.folder_memory import INSTALL_MARKERS
from studio.packages.roots import is_too_wide

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

_COLCON_LAYOUT: Final = ".colcon_install_layout"
_INSTALL_LEVELS: Final = 5
"""install/<package>/share/<package>/urdf and the file below it."""


@dataclass(frozen=True, slots=True)
class RosEnvironment:
    """Existing folders of the environment's variables, in order; earlier prefixes win."""

    prefixes: tuple[Path, ...]
    sources: tuple[Path, ...]

    @classmethod
    def from_variables(cls, variables: Mapping[str, str]) -> RosEnvironment:
        """Read AMENT_PREFIX_PATH, COLCON_PREFIX_PATH and ROS_PACKAGE_PATH.

        ROS_PACKAGE_PATH names folders of sources, and the `share` folder of a prefix.
        """
        named = _folders(variables.get("ROS_PACKAGE_PATH", ""))
        shares = [one.parent for one in named if one.name == "share"]
        prefixes = [
            *_folders(variables.get("AMENT_PREFIX_PATH", "")),
            *_folders(variables.get("COLCON_PREFIX_PATH", "")),
            *shares,
        ]
        sources = [one for one in named if one.name != "share"]
        return cls(_unique(map(_whole_prefix, prefixes)), _unique(sources))

    @property
    def folders(self) -> tuple[Path, ...]:
        """All folders to serve, with the sources behind a symlink install."""
        beside = [one.parent / "src" for one in self.prefixes if is_folder(one.parent / "src")]
        return _unique([*self.prefixes, *self.sources, *beside])


def is_install_space(folder: Path) -> bool:
    """Whether colcon or catkin installed into this folder."""
    return any(is_there(folder / marker) for marker in INSTALL_MARKERS)


def is_installed(path: Path) -> bool:
    """Whether a path is an install space or lies in one."""
    return any(is_install_space(one) for one in (path, *path.parents[:_INSTALL_LEVELS]))


def is_workspace_install(path: Path) -> bool:
    """Whether a path lies where colcon installed a workspace, not in a ROS installed as a whole."""
    return any(is_file(one / _COLCON_LAYOUT) for one in path.parents[:_INSTALL_LEVELS])


def _folders(variable: str) -> list[Path]:
    """Return a variable's folders without relative ones, which nobody chose."""
    named = [Path(one) for one in variable.split(os.pathsep) if Path(one).is_absolute()]
    real = (Path(os.path.realpath(one)) for one in named)
    return [one for one in real if is_folder(one) and not is_too_wide(one)]


def _whole_prefix(prefix: Path) -> Path:
    """An isolated workspace names the prefix of each package; they have one folder in common."""
    layout = prefix.parent / _COLCON_LAYOUT
    return prefix.parent if is_file(layout) else prefix


def _unique(folders: Iterable[Path] | Iterator[Path]) -> tuple[Path, ...]:
    return tuple(dict.fromkeys(folders))
