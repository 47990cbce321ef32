"""What a package starts, read out of its files: nothing of it is run."""

from __future__ import annotations

import ast
import configparser
import os
from typing import TYPE_CHECKING, Final

from studio.errors import PackageError
from studio.packages.roots import ServedRoots

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

SIZE_LIMIT_BYTES: Final = 1 << 20
_SCRIPTS: Final = "console_scripts"


def executables_of(folder: Path, package: str) -> dict[str, str]:
    """Give what a package starts by name: `module:function` of sources, files of installed ones.

    What cannot be read is left out.
    """
    found: dict[str, str] = {}
    for line in (*_lines_of_setup_cfg(folder), *_lines_of_setup_py(folder)):
        name, equals, place = (part.strip() for part in line.partition("="))
        if equals and name and place:
            found[name] = place
    return {**found, **_installed(folder, package)}


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
    """Give the texts of a list behind the key `console_scripts`."""
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
    """Files that may be run in `lib/<package>` of the prefix whose `share/<package>` this is."""
    if folder.parent.name != "share":
        return {}
    programs = folder.parent.parent / "lib" / package
    try:
        names = sorted(os.listdir(programs))  # noqa: PTH208 - names alone
    except OSError:
        return {}
    paths = (programs / name for name in names)
    return {path.name: str(path) for path in paths if path.is_file() and os.access(path, os.X_OK)}
