"""RunFolders: the one place that decides which files may be run, planned and edited as programs."""

from __future__ import annotations

import os
import re
import stat
from pathlib import Path
from typing import TYPE_CHECKING, Final

from studio.errors import NotRunnableError
from studio.files import is_there
from studio.packages.examples import COPIES_FOLDER as EXAMPLES
from studio.packages.roots import is_below
from studio.packages.skeleton import ROBOTS

if TYPE_CHECKING:
    from collections.abc import Iterable

_OWN: Final = (EXAMPLES, ROBOTS)
"""Folders in the data folder whose packages the owner made; all else there came from others."""
_CODE: Final = frozenset({".py", ".pyw", ".pth", ".sh", ".bash", ".zsh", ".bat", ".ps1"})
_YAML: Final = frozenset({".yaml", ".yml"})
_LAUNCH: Final = frozenset({".xml", *_YAML})
_ROS_1: Final = ".launch"
_LAUNCH_FOLDER: Final = "launch"
_NAMED: Final = frozenset({"setup.cfg", "pyproject.toml", "cmakelists.txt"})
"""They say which code an executable is; the last is a program of the build, too."""
_READ_BYTES: Final = 1 << 14
_BEGINS: Final = re.compile(
    rb"""\A(?:\xef\xbb\xbf)?(?>(?:\s|<\?.*?\?>|<!--.*?-->|<![A-Z][^>]*>)*)<launch\b""", re.DOTALL
)
_HAS_KEY: Final = re.compile(rb"""^[ \t{"']*launch["']?[ \t]*:""", re.MULTILINE)
"""What launch files have that are not known by their names: others include them."""
_NOT_ALLOWED: Final = "start the studio with --allow-run {folder} to run what lies there"


def is_launch_file(path: Path | str) -> bool:
    """Whether a file is a launch file by its name: `x.launch.py`, or `x.xml` in a launch folder.

    `x.launch` is one, too: that is what ROS 1 called them, and it is read as XML.
    """
    name, parent = os.path.basename(path).lower(), os.path.dirname(path)  # noqa: PTH119, PTH120
    stem, ending = os.path.splitext(name)  # noqa: PTH122 - of many files
    if ending not in _LAUNCH and ending != ".py":
        return ending == _ROS_1
    named = stem.endswith((".launch", "_launch")) or stem == "launch"
    return named or (_LAUNCH_FOLDER in Path(parent).parts and ending in _LAUNCH)


def is_program(path: Path | str) -> bool:
    """Whether a file is a program, or says what a program does: writing it is as good as running.

    What a name does not say, the file does: by `#!`, as a build installs it for a program, or as a
    launch file in any folder. Without an ending, one that the system would execute is one; with an
    ending that bit says nothing, for many repositories have it on their xacro files.
    """
    real = Path(path)
    if real.suffix.lower() in _CODE or real.name.lower() in _NAMED or is_launch_file(real):
        return True
    try:
        mode = real.stat().st_mode
        if not stat.S_ISREG(mode):
            return False
        if not real.suffix and mode & stat.S_IXUSR:
            return True
        with real.open("rb") as opened:
            beginning = opened.read(_READ_BYTES)
    except (OSError, ValueError):
        return False
    is_yaml = real.suffix.lower() in _YAML
    launches = (_HAS_KEY.search if is_yaml else _BEGINS.match)(beginning)
    return beginning.startswith(b"#!") or launches is not None


def is_received(real: Path, data_folder: Path) -> bool:
    """Whether a path, symlinks resolved, was unpacked, pasted, received, or copied for a member."""
    if not is_below(real, data_folder):
        return False
    return not any(is_below(real, data_folder / one) for one in _OWN)


class RunFolders:
    """The folders of `--allow-run`; without one, nothing may be run.

    What was unpacked, pasted, received, or copied for a member of a class lies in the data folder,
    and is refused even where a folder that was named holds that.

    Attributes:
        folders: As named, symlinks resolved.
    """

    def __init__(self, folders: Iterable[Path] = (), data_folder: Path = Path()) -> None:
        self.folders = tuple(dict.fromkeys(Path(os.path.realpath(one)) for one in folders))
        self._data = Path(os.path.realpath(data_folder)) if data_folder != Path() else None

    @property
    def is_on(self) -> bool:
        """Whether anything may be run."""
        return bool(self.folders)

    def resolve(self, path: Path | str) -> Path:
        """Return the real path of a file or folder that may be run.

        Raises:
            NotRunnableError: It may not, or is not there.
        """
        real = self._real(path)
        if not any(is_below(real, one) for one in self.folders):
            folder = real if real.is_dir() else real.parent
            raise NotRunnableError(str(path), _NOT_ALLOWED.format(folder=folder))
        if self.is_received(real):
            raise NotRunnableError(
                str(path),
                "it came in an archive, from ROS or from a class, and such files are never run: "
                "save it into a folder of your own first",
            )
        if not is_there(real):
            raise NotRunnableError(str(path), "it is not there: choose another file")
        return real

    def is_received(self, real: Path) -> bool:
        """Whether a path, symlinks resolved, is never run: the owner did not make it."""
        return self._data is not None and is_received(real, self._data)

    def folder_of(self, path: Path) -> Path:
        """Return the innermost of the folders that holds a path which `resolve` gave."""
        return max(
            (one for one in self.folders if is_below(path, one)), key=lambda one: len(one.parts)
        )

    def allows(self, path: Path | str) -> bool:
        """Whether `resolve` lets it through."""
        try:
            self.resolve(path)
        except NotRunnableError:
            return False
        return True

    def may_edit(self, path: Path | str) -> bool:
        """Whether `check_edit` lets it through."""
        try:
            self.check_edit(path)
        except NotRunnableError:
            return False
        return True

    def check_edit(self, path: Path | str) -> None:
        """Pass unless a file is a program that may not be run; it need not be there yet.

        Raises:
            NotRunnableError: Whoever changes it could have it run.
        """
        real = self._real(path)
        if not is_program(real):
            return
        self.resolve(real if is_there(real) else real.parent)

    def _real(self, path: Path | str) -> Path:
        try:
            return Path(os.path.realpath(path))
        except (OSError, ValueError) as error:
            raise NotRunnableError(repr(str(path)), "it is no file name") from error
