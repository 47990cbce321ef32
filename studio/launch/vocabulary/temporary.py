"""Temporary files of a launch, such as files of parameters; they end with the process."""

from __future__ import annotations

import atexit
import shutil
import tempfile
from itertools import count
from pathlib import Path

_FOLDERS: list[str] = []
_NUMBERS = count(1)
_SOURCES: dict[str, str] = {}


def folder() -> Path:
    """Return the folder of this process, made at the first call."""
    if not _FOLDERS:
        _FOLDERS.append(tempfile.mkdtemp(prefix="launch_params_"))
        atexit.register(shutil.rmtree, _FOLDERS[0], ignore_errors=True)
    return Path(_FOLDERS[0])


def use_folder(path: str) -> None:
    """Have temporary files be in a folder that whoever started this process removes."""
    _FOLDERS[:] = [path]


def written(text: str, name: str = "parameters.yaml", source: str = "") -> str:
    """Write a text to a file of its own, made of the file `source`; returns its path."""
    path = folder() / f"{next(_NUMBERS)}_{name}"
    path.write_text(text, encoding="utf-8")
    if source:
        _SOURCES[str(path)] = source_of(source)
    return str(path)


def source_of(path: str) -> str:
    """Return the file that a temporary file was made of; any other path as it is."""
    return _SOURCES.get(path, path)
