"""The folders that a person chose for packages, remembered for each workspace."""

from __future__ import annotations

import contextlib
import hashlib
import os
from pathlib import Path
from typing import TYPE_CHECKING, Final

import msgspec

from studio.errors import PackageNotFoundError, UnreadableFileError
from studio.files import write_whole
from studio.packages.discovery import discover
from studio.packages.folder_memory import FolderMemory
from studio.packages.manifest import FILE_NAME
from studio.packages.presence import is_folder, is_there
from studio.packages.roots import ServedRoots, is_too_wide

if TYPE_CHECKING:
    from collections.abc import Mapping

_FOLDER: Final = "chosen_packages"
_CHOICES: Final = msgspec.json.Decoder(dict[str, str])


def load_choices(data_folder: Path, workspace: Path) -> dict[str, Path]:
    """What was chosen for a workspace; folders that are gone are left out."""
    with contextlib.suppress(OSError, msgspec.MsgspecError):
        chosen = _CHOICES.decode(_file(data_folder, workspace).read_bytes())
        return {name: Path(folder) for name, folder in chosen.items() if is_folder(Path(folder))}
    return {}


def save_choices(data_folder: Path, workspace: Path, chosen: Mapping[str, Path]) -> None:
    """Remember what was chosen.

    Raises:
        OSError: The data folder cannot be written.
    """
    file = _file(data_folder, workspace)
    file.parent.mkdir(parents=True, exist_ok=True)
    text = msgspec.json.encode({name: str(folder) for name, folder in chosen.items()})
    write_whole(file, msgspec.json.format(text))


def folder_of_choice(name: str, chosen: Path) -> Path:
    """The package that a person meant by a folder: itself, or the one of that name below it.

    A folder without any package.xml is taken at its word.

    Raises:
        UnreadableFileError: It is no folder, or too wide to serve.
        PackageNotFoundError: There are packages, and none has that name.
    """
    try:
        folder = Path(os.path.realpath(chosen))
    except ValueError as error:  # a NUL character
        raise UnreadableFileError(repr(str(chosen)), "is no file name.") from error
    if not is_folder(folder):
        raise UnreadableFileError(str(chosen), "is no folder.")
    if is_too_wide(folder):
        raise UnreadableFileError(str(chosen), "is too wide to serve: choose a folder inside it.")
    found = discover(folder, FolderMemory(None, ServedRoots([folder]))).packages
    named = [one.folder for one in found if one.name == name]
    if named:
        return min(named, key=lambda one: len(one.parts))
    if found or is_there(folder / FILE_NAME):
        raise PackageNotFoundError(name, str(folder))
    return folder


def _file(data_folder: Path, workspace: Path) -> Path:
    key = hashlib.sha256(os.fsencode(workspace)).hexdigest()[:16]
    return data_folder / _FOLDER / f"{key}.json"
