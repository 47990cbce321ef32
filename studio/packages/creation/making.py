"""Makes a new package on the disk: it appears at once, or not at all."""

from __future__ import annotations

import os
import shutil
from typing import TYPE_CHECKING

from studio.errors import NotMadeError
from studio.files import is_there
from studio.packages.creation.new_package import faults
from studio.packages.creation.package_texts import package_files, package_folders

if TYPE_CHECKING:
    from pathlib import Path

    from studio.packages.creation.new_package import NewPackage


def check_new(new: NewPackage) -> None:
    """Refuse wishes for a package that cannot be.

    Raises:
        NotMadeError: Something forbids it.
    """
    if reasons := tuple(faults(new)):
        raise NotMadeError(new.name, " ".join(reasons))


def free_folder(folder: Path, name: str) -> Path:
    """Return the folder of a new package in another one.

    Raises:
        NotMadeError: Something bears its name there.
    """
    target = folder / name
    if is_there(target):
        raise NotMadeError(
            str(target), "there is something of that name: choose another name or folder."
        )
    return target


def create_package(folder: Path, new: NewPackage) -> tuple[Path, ...]:
    """Write a package into `folder`, and return its files in the order of making.

    Raises:
        NotMadeError: Something forbids it, bears its name there, or the system refused.
    """
    check_new(new)
    target = free_folder(folder, new.name)
    files = package_files(new)
    partial = folder / f".{new.name}.{os.getpid()}"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        shutil.rmtree(partial, ignore_errors=True)
        for name in package_folders(new):
            (partial / name).mkdir(parents=True, exist_ok=True)
        for name, text in files.items():
            path = partial / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8", newline="")
        partial.rename(target)
    except OSError as error:
        shutil.rmtree(partial, ignore_errors=True)
        reason = f"the system refused ({error.strerror or type(error).__name__})."
        raise NotMadeError(str(target), reason) from error
    return tuple(target / name for name in files)
