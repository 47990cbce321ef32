"""Interface texts of a package folder, read as they lie there: nothing is built."""

from __future__ import annotations

import os
import stat
from typing import TYPE_CHECKING

from studio.errors import RosNameError, UnreadableFileError
from studio.ros.names import KINDS, check_package_name, split_type_name
from studio.ros.types.parser import TEXT_BYTES_MAX

if TYPE_CHECKING:
    from pathlib import Path

FILES_MAX = 5_000


def texts_of_package(folder: Path, package: str) -> dict[str, str]:
    """Read the texts in `msg`, `srv` and `action` of a package's folder, by full names.

    Links that lead out of the folder, and what is no regular file, are passed over.

    Raises:
        RosNameError: The package, or a file, has a name that no type may have.
        UnreadableFileError: A file is too large or cannot be read, or there are too many.
    """
    check_package_name(package)
    paths = [path for kind in KINDS for path in _files(folder, kind)]
    if len(paths) > FILES_MAX:
        raise UnreadableFileError(str(folder), f"it holds more than {FILES_MAX} interfaces.")
    return {_full_name(package, path): read_text(path) for path in paths}


def read_text(path: Path) -> str:
    """Read one interface text, whole.

    Raises:
        UnreadableFileError: It is too large, no regular file, or cannot be read.
    """
    try:
        # A pipe would wait for its writer, for ever.
        handle = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0))
        with open(handle, "rb") as file:  # noqa: PTH123  # of the handle that was looked at
            if not stat.S_ISREG(os.fstat(handle).st_mode):
                raise UnreadableFileError(str(path), "it is no regular file.")
            data = file.read(TEXT_BYTES_MAX + 1)
    except OSError as error:
        reason = error.strerror or type(error).__name__
        raise UnreadableFileError(str(path), f"it cannot be read ({reason}).") from None
    if len(data) > TEXT_BYTES_MAX:
        raise UnreadableFileError(str(path), f"it is larger than {TEXT_BYTES_MAX} bytes.")
    return data.decode(errors="replace")


def _files(folder: Path, kind: str) -> list[Path]:
    root = folder.resolve()
    found = sorted((folder / kind).glob(f"*.{kind}"))
    return [path for path in found if path.resolve().is_relative_to(root) and path.is_file()]


def _full_name(package: str, path: Path) -> str:
    name = f"{package}/{path.suffix.removeprefix('.')}/{path.stem}"
    try:
        split_type_name(name)
    except RosNameError as error:
        raise RosNameError(path.name, error.reason) from None
    return name
