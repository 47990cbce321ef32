"""Finds programs: by package and executable, by file, and by the words of a command line."""

from __future__ import annotations

import os
import stat
import sys
from dataclasses import replace
from difflib import get_close_matches
from pathlib import Path
from typing import TYPE_CHECKING, Final

from studio.errors import CompiledProgramError, ProgramNotFoundError
from studio.files import is_file
from studio.packages.environment import is_workspace_install
from studio.packages.executables import executables, executables_of
from studio.packages.index import Rank
from studio.packages.passing import environment_of
from studio.packages.sources.package_source import PackageSource
from studio.programs.entry_points import find_entry_point
from studio.programs.own import COMMANDS, own_executables, own_file, own_module
from studio.programs.program import RUNNER, Program, studio_command
from studio.system import python_command

if TYPE_CHECKING:
    from collections.abc import Sequence

    from studio.packages.index import PackageIndex

_PYTHONS: Final = frozenset({"python", "python3"})


def find_program(
    index: PackageIndex, package: str, executable: str, *, demo: bool = False
) -> Program:
    """Find what `ros2 run PACKAGE EXECUTABLE` would start.

    A package of the user's workspace comes before the studio's own nodes of that name, and those
    before what is installed as a whole ROS; `demo` asks for the studio's own.

    Raises:
        ProgramNotFoundError: Nothing has that name; the sentence says what there is instead.
        CompiledProgramError: It is compiled from a source, and was not built.
        EntryPointError: The package's files do not start it, as they would not in ROS 2.
    """
    own = _own_program(package, executable)
    if demo:
        if own is None:
            raise ProgramNotFoundError(
                package,
                executable,
                f"The studio has no node {package} {executable}: studio demos lists them.",
            )
        return own
    folder = workspace_folder(index, package)
    if folder is not None:
        return _of_workspace(index, folder, package, executable)
    if own is not None:
        return own
    return _installed(index, package, executable) or _not_found(index, package, executable)


def file_program(path: Path, index: PackageIndex | None = None) -> Program:
    """Find what `python3 FILE.py` would start; `index` has the packages that it may import.

    Raises:
        ProgramNotFoundError: There is no such file, or it is no Python file.
    """
    file = Path(os.path.abspath(path))  # noqa: PTH100 - links stay, as Python keeps them
    if not is_file(file):
        raise ProgramNotFoundError("", path.name, f"{path}: there is no such file.")
    if file.suffix != ".py":
        raise ProgramNotFoundError(
            "", path.name, f"{path}: its name does not end in .py, so it is not run as Python."
        )
    environment = {} if index is None else environment_of(index, file)
    command = python_command(RUNNER, "file", str(path))
    return Program("", path.name, "workspace", command, file, environment)


def command_program(index: PackageIndex, words: Sequence[str]) -> Program | None:
    """Find what a command line starts that the studio can start; None for any other.

    `ros2 run`, `ros2 launch`, `ros2 bag`, `rviz2`, `xacro` and `python3 FILE.py` are known. The
    words that belong to the program are part of its command.

    Raises:
        ProgramError: `find_program` or `file_program` refuse it.
    """
    match [os.path.basename(words[0]), *words[1:]] if words else []:  # noqa: PTH119 - a word
        case ["ros2", "run", package, executable, *rest]:
            return _with_words(find_program(index, package, executable), rest)
        case ["ros2", "bag" | "launch" as command, *rest]:
            return Program("", "ros2", "command", studio_command((command, *rest)))
        case ["rviz2", *rest]:
            return Program("rviz2", "rviz2", "command", studio_command(("open", *rest)))
        case ["xacro", *rest]:
            return Program("xacro", "xacro", "command", studio_command(("xacro", *rest)))
        case [python, file, *rest] if python in _PYTHONS and file.endswith(".py"):
            return _with_words(file_program(Path(file), index), rest)
        case _:
            return None


def executables_of_all(index: PackageIndex) -> dict[str, dict[str, str]]:
    """Return by package and name the file or module of all that can be started."""
    found = own_executables()
    for name in index.names:
        known = executables_of(index.best(name, Path.cwd()), name)
        if workspace_folder(index, name) is not None:
            found.pop(name, None)
        if known:
            found[name] = {**known, **found.get(name, {})}
    return found


def workspace_folder(index: PackageIndex, name: str) -> Path | None:
    """Return the folder of a package that the user's workspace holds: it comes before a demo's.

    None where the name is unknown, or known only of a ROS that was installed as a whole.
    """
    if name not in index:
        return None
    folder = index.best(name, Path.cwd())
    ranks = [one.rank for one in index.packages if one.folder == folder]
    is_source = any(rank is not Rank.INSTALLED for rank in ranks)
    return folder if is_source or is_workspace_install(folder) else None


def _with_words(program: Program, words: Sequence[str]) -> Program:
    return replace(program, command=(*program.command, *words))


def _own_program(package: str, executable: str) -> Program | None:
    command = COMMANDS.get((package, executable))
    if command is not None:
        return Program(package, executable, "command", studio_command((command,)))
    module = own_module(package, executable)
    if module is None:
        return None
    return Program(package, executable, "studio", python_command(module), own_file(module))


def _of_workspace(index: PackageIndex, folder: Path, package: str, executable: str) -> Program:
    """Find an executable of a package of the user's.

    Raises:
        ProgramError: It is not started so.
    """
    source = PackageSource(folder, name=package)
    point = find_entry_point(source, executable)
    environment = environment_of(index, folder / "setup.py")
    name = f"{folder}/lib/{package}/{executable}"
    if point is not None:
        place = f"{point.module}:{point.function}"
        command = python_command(RUNNER, "entry", str(point.root), place, name)
        return Program(package, executable, "workspace", command, point.file, environment)
    declared = {one.name: one for one in executables(source)}.get(executable)
    installed = _installed(index, package, executable)
    if declared is None:
        return installed or _not_of_workspace(index, folder, package, executable)
    file = declared.file
    if file is not None and _is_python(file) and (installed is None or installed.file != file):
        command = python_command(RUNNER, "file", str(file))
        return Program(package, executable, "workspace", command, file, environment)
    if installed is not None:
        return installed
    if file is None and declared.place and "$" not in declared.place:
        raise ProgramNotFoundError(
            package,
            executable,
            f"{declared.declared_in}:{declared.line}: {executable} is to be made of "
            f"{declared.place}, and {folder} has no such file: write it, or name the right one.",
        )
    raise CompiledProgramError(package, executable, str(file or declared.place or folder))


def _is_python(file: Path) -> bool:
    """Whether a program is Python by its name, or by its first line."""
    if file.suffix == ".py":
        return True
    try:
        with file.open("rb") as opened:
            first = opened.readline(200)
    except OSError:
        return False
    return first.startswith(b"#!") and b"python" in first


def _installed(index: PackageIndex, package: str, executable: str) -> Program | None:
    """Find an executable where colcon or ROS installed it."""
    folders = [index.best(package, Path.cwd())] if package in index else []
    folders += [one.folder for one in index.packages if one.name == package]
    for folder in dict.fromkeys(folders):
        if folder.parent.name != "share":
            continue
        file = folder.parent.parent / "lib" / package / executable
        if os.path.basename(executable) == executable and _is_executable(file):  # noqa: PTH119
            return Program(package, executable, "installed", (str(file),), file)
    return None


def _is_executable(file: Path) -> bool:
    try:
        mode = file.stat().st_mode
    except (OSError, ValueError):
        return False
    return stat.S_ISREG(mode) and (os.access(file, os.X_OK) or sys.platform == "win32")


def _not_found(index: PackageIndex, package: str, executable: str) -> Program:
    known = dict(own_executables().get(package, {}))
    if package in index:
        known = executables_of(index.best(package, Path.cwd()), package) | known
    if known:
        text = f'{package} has no executable "{executable}": it has {", ".join(sorted(known))}.'
    elif package in index:
        text = f"{package} ({index.best(package, Path.cwd())}) starts nothing."
    else:
        near = get_close_matches(package, sorted({*index.names, *own_executables()}), 1)
        mend = f"did you mean {near[0]}?" if near else "studio pkg executables lists what there is."
        text = f'No package "{package}" is known: {mend}'
    raise ProgramNotFoundError(package, executable, text)


def _not_of_workspace(index: PackageIndex, folder: Path, package: str, executable: str) -> Program:
    known = executables_of(folder, package)
    if known:
        text = (
            f'Your workspace has the package {package} ({folder}), which has no executable "'
            f'{executable}": it has {", ".join(sorted(known))}; a new one is a line of '
            f"console_scripts in {folder / 'setup.py'}."
        )
        if not is_file(folder / "setup.py"):
            text = text.partition("; a new one")[0] + "."
    else:
        text = (
            f"Your workspace has the package {package} ({folder}), which starts nothing: no "
            'entry in console_scripts of its setup.py, no install to "lib/${PROJECT_NAME}" in its '
            "CMakeLists.txt."
        )
    if own_module(package, executable) is not None:
        text += f" The studio's demo of that name: studio run --demo {package} {executable}"
    raise ProgramNotFoundError(package, executable, text)
