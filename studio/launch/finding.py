"""Finds launch files: by package and name, as `ros2 launch` does, or by their path."""

from __future__ import annotations

import os
from difflib import get_close_matches
from pathlib import Path
from typing import TYPE_CHECKING, Final

from studio.errors import LaunchNotFoundError
from studio.files import is_file
from studio.packages.executables import executables_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.packages.index import PackageIndex

_SUFFIXES: Final = (".py", ".xml", ".yaml", ".yml", ".launch")
_FOLDERS_MAX: Final = 2_000
_PASSED: Final = frozenset(
    {"build", "install", "log", "__pycache__", "node_modules", "test", "tests"}
)


def launch_files(folder: Path) -> list[Path]:
    """Return the launch files below a package's folder, those in `launch/` first."""
    found = [path for path in _files(folder) if _is_launch_file(path)]
    return sorted(found, key=lambda path: ("launch" not in path.parts, str(path)))


def _is_launch_file(path: Path) -> bool:
    name = path.name
    if not name.endswith(_SUFFIXES):
        return False
    stem = name.rpartition(".")[0]
    return (
        stem.endswith((".launch", "_launch"))
        or name.endswith(".launch")
        or (
            path.parent.name == "launch"
            and name.endswith((".py", ".xml", ".yaml"))
            and name != "__init__.py"
        )
    )


def _files(folder: Path) -> Iterator[Path]:
    for count, (path, folders, names) in enumerate(os.walk(folder)):
        if count > _FOLDERS_MAX:
            return
        folders[:] = sorted(one for one in folders if one not in _PASSED and one[0] != ".")
        yield from (Path(path, name) for name in sorted(names))


def find_launch_file(index: PackageIndex, words: list[str]) -> Path:
    """Find the launch file that one word (a path) or two (package and name) mean.

    Raises:
        LaunchNotFoundError: There is none, or several; the sentence says what there is.
    """
    if len(words) == 1:
        return _of_path(index, words[0])
    package, name = words
    if package not in index:
        near = get_close_matches(package, sorted(index.names), 1)
        meant = (
            f": did you mean {near[0]}?"
            if near
            else ": open its workspace, or give --package-path."
        )
        raise LaunchNotFoundError(f'No package "{package}" is known{meant}')
    folder = index.best(package, Path.cwd())
    named = [path for path in _files(folder) if path.name == name or path == folder / name]
    in_launch = [path for path in named if path.parent.name == "launch"]
    if len(in_launch or named) > 1:
        listed = ", ".join(str(path) for path in (in_launch or named)[:4])
        raise LaunchNotFoundError(f"{package} has several files {name} ({listed}): give the path.")
    if named:
        return (in_launch or named)[0]
    raise LaunchNotFoundError(_not_in_package(folder, package, name))


def _not_in_package(folder: Path, package: str, name: str) -> str:
    if name in executables_of(folder, package):
        return (
            f"{name} is an executable of {package}, not a launch file: studio run {package} {name} "
            "starts it."
        )
    files = [path.name for path in launch_files(folder)]
    if not files:
        return f"{package} ({folder}) has no launch file: write launch/{name} in it."
    stems = {_stem(one): one for one in files}
    near = [stems[one] for one in get_close_matches(_stem(name), stems, 1)]
    meant = f" did you mean {near[0]}?" if near else ""
    mend = meant or " name one of these."
    return f"{package} has no launch file {name}, it has {', '.join(files[:8])}:{mend}"


def _stem(name: str) -> str:
    """Return a name without what all launch files' names end in, which makes them all alike."""
    return name.partition(".")[0].removesuffix("_launch")


def _of_path(index: PackageIndex, word: str) -> Path:
    path = Path(os.path.abspath(word))  # noqa: PTH100 - links stay, as ROS keeps them
    if is_file(path):
        return path
    if word in index:
        files = [one.name for one in launch_files(index.best(word, Path.cwd()))]
        have = f"it has {', '.join(files[:8])}" if files else "it has none"
        raise LaunchNotFoundError(f"{word} is a package: name its launch file, too ({have}).")
    if word.endswith(_SUFFIXES) or os.sep in word:
        raise LaunchNotFoundError(f"{path}: there is no such launch file.")
    owners = [
        name
        for name in sorted(index.names)
        if word in executables_of(index.best(name, Path.cwd()), name)
    ]
    if owners:
        raise LaunchNotFoundError(
            f"{word} is a node, and what is launched is a launch file (ros2 launch PACKAGE FILE): "
            f"studio run {owners[0]} {word} starts it."
        )
    raise LaunchNotFoundError(
        f'"{word}" is no launch file and no package that is known: write studio launch PACKAGE '
        "FILE, or the path of the file."
    )
