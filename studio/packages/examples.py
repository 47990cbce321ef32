"""The models that the studio ships, and their copies in the data folder, to edit."""

from __future__ import annotations

import os
import shutil
from pathlib import Path
from typing import Final, NamedTuple

from studio.errors import DataFolderError, PackageNotFoundError
from studio.files import is_file
from studio.packages.manifest import FILE_NAME, texts_of_tag

_ENDING: Final = "_description"
COPIES_FOLDER: Final = "models"
_REPLACED: Final = "models_replaced"
_LEFT_OUT: Final = shutil.ignore_patterns("__pycache__", "*.pyc", ".*")


class Example(NamedTuple):
    """A shipped package."""

    package: str
    robot: str
    text: str
    """The description in its package.xml."""


def examples(models_folder: Path) -> tuple[Example, ...]:
    """Return all examples, sorted by name."""
    manifests = sorted(models_folder.glob(f"*/{FILE_NAME}"))
    return tuple(_example(one) for one in manifests if is_file(one))


def _example(manifest: Path) -> Example:
    package = manifest.parent.name
    [text] = texts_of_tag(manifest.read_bytes(), "description")
    return Example(package, package.removesuffix(_ENDING), " ".join(text.split()))


def working_copy(models_folder: Path, data_folder: Path, package: str, *, fresh: bool) -> Path:
    """Return the working copy of a shipped package, with all others beside it.

    A copy that is there is kept, and packages that a newer studio ships are added. `fresh` renews
    the package that is asked for; its old copy is moved to `models_replaced`, one of each.

    Raises:
        PackageNotFoundError: No such package is shipped.
        DataFolderError: It cannot be copied.
    """
    if not (models_folder / package / FILE_NAME).is_file():
        raise PackageNotFoundError(package)
    copies = data_folder / COPIES_FOLDER
    try:
        copies.mkdir(parents=True, exist_ok=True)
        if fresh and (copies / package).exists():
            _set_aside(copies / package, data_folder / _REPLACED / package)
        for shipped in models_folder.iterdir():
            if (shipped / FILE_NAME).is_file() and not (copies / shipped.name).exists():
                _copy(shipped, copies / shipped.name)
    except OSError as error:
        raise DataFolderError(str(data_folder), error.strerror or "cannot be written") from error
    return copies / package


def _set_aside(copy: Path, replaced: Path) -> None:
    replaced.parent.mkdir(parents=True, exist_ok=True)
    if replaced.exists():
        shutil.rmtree(replaced)
    copy.rename(replaced)


def _copy(shipped: Path, target: Path) -> None:
    """Whole or not at all, and writable even when it was installed read-only."""
    partial = target.with_name(f".{target.name}.{os.getpid()}")
    shutil.rmtree(partial, ignore_errors=True)
    shutil.copytree(shipped, partial, copy_function=shutil.copyfile, ignore=_LEFT_OUT)
    for folder, _, _ in os.walk(partial):
        Path(folder).chmod(0o755)
    partial.rename(target)
