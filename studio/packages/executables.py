"""What a package starts by name, found in its files without running anything."""

from __future__ import annotations

import os
from dataclasses import dataclass, replace
from itertools import chain
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING, Final

from studio.packages.sources.entries import build_faults, stopping_faults
from studio.packages.sources.package_source import PackageSource

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.packages.sources.scripts import Script

_CPP: Final = frozenset({".cpp", ".cc", ".cxx", ".c", ".c++"})
EXECUTABLES_MAX: Final = 500


@dataclass(frozen=True, slots=True)
class Executable:
    """What `ros2 run` starts by a name."""

    name: str
    place: str
    """As declared: `package.module:function`, or a source file of a C++ program or script; the file
    itself where it is installed."""
    language: str
    """`python`, `c++`, `script` or `installed`."""
    file: Path | None
    """Where its code is; None: no file of the package has it."""
    declared_in: Path
    line: int = 0
    fault: str = ""
    """Why it would not start, a sentence; empty if nothing is known against it."""


def executables(source: PackageSource, *, with_faults: bool = False) -> tuple[Executable, ...]:
    """Return the executables of a package in the order in which they are declared.

    What is installed in `lib/PACKAGE` of the prefix of a `share/PACKAGE` comes last.

    Args:
        source: The package.
        with_faults: Follow entries of `console_scripts` to their functions, and say what is wrong.
    """
    found: list[Executable] = []
    for one in source.scripts:
        if one.name and one.place:
            fault = _fault(source, one) if with_faults else ""
            found.append(_python(source, one, fault))
    found += _of_cmake(source)
    return tuple([*found, *_installed(source)][:EXECUTABLES_MAX])


def executables_of(folder: Path, package: str) -> dict[str, str]:
    """Return the place of each executable of a package by its name.

    What is installed comes before what is declared, and of that the first.
    """
    found: dict[str, str] = {}
    for one in executables(PackageSource(folder, name=package)):
        if one.language == "installed":
            found[one.name] = one.place
        else:
            found.setdefault(one.name, one.place)
    return found


def _python(source: PackageSource, script: Script, fault: str) -> Executable:
    found = source.module(script.module) if script.module else None
    path = source.path(found[1]) if found else None
    where = Path(script.source.file)
    return Executable(script.name, script.place, "python", path, where, script.line, fault)


def _fault(source: PackageSource, script: Script) -> str:
    """Return the sentence of the first finding that stops an entry; empty if nothing does."""
    fault = next(chain(build_faults(source), stopping_faults(source, script)), None)
    if fault is not None:
        # Checks are imported only where there is something to tell: a node starts without them.
        from studio.packages.lint.entries import problem_of  # noqa: PLC0415

        return problem_of(source, fault).sentence
    found = source.module(script.module)
    python = source.python(found[1]) if found else None
    if python is not None and python.fault:
        file = found[1] if found else ""
        return f"{file} is no Python that runs: {python.fault} (line {python.fault_line})."
    return ""


def _of_cmake(source: PackageSource) -> Iterator[Executable]:
    lists = source.cmake
    if lists is None:
        return
    built = {lists.plain(one.values[0]): one for one in lists.of("add_executable") if one.arguments}
    where = source.path("CMakeLists.txt")
    for kind, name, call in lists.installs():
        is_found = f"lib/{source.name}" in lists.destinations(call)
        if kind == "PROGRAMS" and (is_found or call.name == "catkin_install_python"):
            there = source.has(name)
            language = "python" if name.endswith(".py") else "script"
            fault = "" if there or "$" in name else f"{name} is not there."
            path = source.path(name) if there else None
            program = PurePosixPath(name).name
            yield Executable(program, name, language, path, where, call.line, fault)
        elif kind == "TARGETS" and is_found and name in built:
            values = tuple(map(lists.plain, built[name].values))
            made = _compiled(source, name, values, where)
            yield replace(made, line=built[name].line)


def _compiled(source: PackageSource, name: str, values: tuple[str, ...], where: Path) -> Executable:
    sources = [one for one in values[1:] if PurePosixPath(one).suffix in _CPP]
    first = sources[0] if sources else ""
    missing = [one for one in sources if "$" not in one and not source.has(one)]
    fault = f"{missing[0]} is not there." if missing else ""
    path = source.path(first) if first and source.has(first) else None
    return Executable(name, first, "c++", path, where, fault=fault)


def _installed(source: PackageSource) -> Iterator[Executable]:
    """Yield executable files in `lib/PACKAGE` of the prefix of this `share/PACKAGE`."""
    folder = source.folder
    if folder.parent.name != "share":
        return
    programs = folder.parent.parent / "lib" / source.name
    try:
        names = sorted(os.listdir(programs))  # noqa: PTH208 - names alone
    except OSError:
        return
    for name in names:
        path = programs / name
        if path.is_file() and os.access(path, os.X_OK):
            yield Executable(name, str(path), "installed", path, path)
