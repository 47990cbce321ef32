"""The executables of a package, found in its files without running anything."""

from __future__ import annotations

import ast
import configparser
import os
import re
from typing import TYPE_CHECKING, Final

from studio.errors import PackageError
from studio.packages.roots import ServedRoots

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

SIZE_LIMIT_BYTES: Final = 1 << 20
_SCRIPTS: Final = "console_scripts"
_CMAKE_COMMENT: Final = re.compile(r"#[^\n]*")
_CMAKE_CALL: Final = re.compile(
    r"\b(add_executable|install|catkin_install_python)\s*\(([^()]*)\)", re.IGNORECASE
)
_CMAKE_KEYWORDS: Final = frozenset({"TARGETS", "PROGRAMS", "DESTINATION", "RUNTIME", "EXPORT"})


def executables_of(folder: Path, package: str) -> dict[str, str]:
    """Return what a package starts by name.

    It is `module:function` of Python sources, the source file that a CMakeLists.txt names, and
    the file itself where it is installed. What cannot be read is left out.
    """
    found = _of_cmake(folder, package)
    for line in (*_lines_of_setup_cfg(folder), *_lines_of_setup_py(folder)):
        name, equals, place = (part.strip() for part in line.partition("="))
        if equals and name and place:
            found[name] = place
    return {**found, **_installed(folder, package)}


def file_of(folder: Path, place: str) -> Path | None:
    """Find the file of what `executables_of` gave for a package's folder; None: it is not there."""
    module, colon, _ = place.partition(":")
    if not colon:
        path = folder / place
        return path if path.is_file() else None
    steps = module.strip().replace(".", "/")
    ends = (f"{steps}.py", f"{steps}/__init__.py")
    paths = (root / end for root in (folder, folder / "src") for end in ends)
    return next((path for path in paths if path.is_file()), None)


def _of_cmake(folder: Path, package: str) -> dict[str, str]:
    """Return the programs that a CMakeLists.txt installs where `ros2 run` finds them, by name."""
    text = _CMAKE_COMMENT.sub("", _read(folder, "CMakeLists.txt"))
    text = re.sub(r"\$\{(PROJECT_NAME|CATKIN_PACKAGE_NAME)\}", package, text)
    sources: dict[str, str] = {}
    found: dict[str, str] = {}
    for call in _CMAKE_CALL.finditer(text):
        arguments = call[2].replace('"', " ").split()
        if call[1].lower() == "add_executable":
            sources[arguments[0] if arguments else ""] = arguments[1] if len(arguments) > 1 else ""
        elif f"lib/{package}" in arguments or call[1].lower() == "catkin_install_python":
            found |= {name.rsplit("/", 1)[-1]: name for name in _named(arguments)}
    return {name: sources.get(place) or place for name, place in found.items()}


def _named(arguments: list[str]) -> list[str]:
    """Return what stands behind TARGETS or PROGRAMS, as far as the next keyword."""
    named: list[str] = []
    is_named = False
    for argument in arguments:
        if argument in _CMAKE_KEYWORDS:
            is_named = argument in {"TARGETS", "PROGRAMS"}
        elif is_named:
            named.append(argument)
    return named


def _read(folder: Path, name: str) -> str:
    try:
        return ServedRoots([folder]).read(folder / name, SIZE_LIMIT_BYTES).decode(errors="replace")
    except PackageError:
        return ""


def _lines_of_setup_cfg(folder: Path) -> list[str]:
    config = configparser.ConfigParser(interpolation=None, strict=False)
    try:
        config.read_string(_read(folder, "setup.cfg"))
    except configparser.Error:
        return []
    return config.get("options.entry_points", _SCRIPTS, fallback="").splitlines()


def _lines_of_setup_py(folder: Path) -> list[str]:
    try:
        tree = ast.parse(_read(folder, "setup.py"))
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return []
    return [line for node in ast.walk(tree) for line in _scripts_of(node)]


def _scripts_of(node: ast.AST) -> Iterator[str]:
    """Yield the texts of a list behind the key `console_scripts`."""
    if not isinstance(node, ast.Dict):
        return
    for key, value in zip(node.keys, node.values, strict=True):
        if isinstance(key, ast.Constant) and key.value == _SCRIPTS:
            yield from (
                one.value
                for one in getattr(value, "elts", [])
                if isinstance(one, ast.Constant) and isinstance(one.value, str)
            )


def _installed(folder: Path, package: str) -> dict[str, str]:
    """Return executable files in `lib/<package>` of the prefix of this `share/<package>`."""
    if folder.parent.name != "share":
        return {}
    programs = folder.parent.parent / "lib" / package
    try:
        names = sorted(os.listdir(programs))  # noqa: PTH208 - names alone
    except OSError:
        return {}
    paths = (programs / name for name in names)
    return {path.name: str(path) for path in paths if path.is_file() and os.access(path, os.X_OK)}
