"""Descriptions that came from ROS 2: a file of the data folder for each place they come from."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final

from studio.errors import NotMadeError
from studio.files import write_whole
from studio.packages.choices import load_choices, save_choices
from studio.settings import SOURCE_SIZE_LIMIT_BYTES

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from studio.packages.index import PackageIndex

FOLDER: Final = "from_ros"
_NAME_LIMIT: Final = 80
_NAMED: Final = re.compile(r"package://([A-Za-z0-9_.-]{1,100})/")
_NAMED_LIMIT: Final = 100
_ROBOT: Final = re.compile(r"<(?:\w+:)?robot\b")


def keep_description(data_folder: Path, source: str, text: str) -> Path:
    """Write a description into the file of its source, whole or not at all, and return that.

    Args:
        data_folder: Where it is kept.
        source: The topic, or the node and its parameter, that it came from.
        text: URDF.

    Raises:
        NotMadeError: It is no robot, too long, or the data folder cannot take it.
    """
    shown = f"The robot of {source}"
    if not _ROBOT.search(text):
        raise NotMadeError(shown, "what came is no robot description: it has no <robot> in it.")
    content = text.encode("utf-8", "replace")
    if len(content) > SOURCE_SIZE_LIMIT_BYTES:
        raise NotMadeError(shown, f"it has {len(content)} bytes, which is too long to open.")
    folder = data_folder / FOLDER / _folder_name(source)
    file = folder / f"{_folder_name(source)}.urdf"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        if file.is_file() and file.read_bytes() == content:
            return file
        write_whole(file, content)
    except OSError as error:
        raise NotMadeError(shown, _reason(error)) from error
    return file


def choose_packages(
    data_folder: Path, file: Path, text: str, open_ones: Iterable[PackageIndex]
) -> None:
    """Let a description find the packages that it names where open robots have them.

    It lies beside none of them, so that its meshes would be missed; what a person chose stays.

    Raises:
        NotMadeError: The data folder cannot take it.
    """
    known = load_choices(data_folder, file.parent)
    found: dict[str, Path] = {}
    for name in sorted(set(_NAMED.findall(text)))[:_NAMED_LIMIT]:
        index = next((one for one in open_ones if name in one), None)
        if index is not None:
            found[name] = index.best(name, file)
    if not found.keys() - known.keys():
        return
    try:
        save_choices(data_folder, file.parent, {**found, **known})
    except OSError as error:
        raise NotMadeError("A robot of ROS", _reason(error)) from error


def _reason(error: OSError) -> str:
    return f"the data folder cannot take it ({error.strerror or type(error).__name__})."


def _folder_name(source: str) -> str:
    """Letters, digits and hyphens of a name of ROS; those have no others but `/`, `_` and `~`."""
    return re.sub(r"[^A-Za-z0-9_]+", "-", source).strip("-")[:_NAME_LIMIT] or "robot"
