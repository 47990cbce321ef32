"""Descriptions that came from ROS 2: a file of the data folder for each place they come from."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final

from studio.errors import NotMadeError
from studio.settings import SOURCE_SIZE_LIMIT_BYTES

if TYPE_CHECKING:
    from pathlib import Path

FOLDER: Final = "from_ros"
_NAME_LIMIT: Final = 80
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
        fresh = file.with_suffix(".new")
        fresh.write_bytes(content)
        fresh.replace(file)
    except OSError as error:
        reason = f"the data folder cannot take it ({error.strerror or type(error).__name__})."
        raise NotMadeError(shown, reason) from error
    return file


def _folder_name(source: str) -> str:
    """Letters, digits and hyphens of a name of ROS; those have no others but `/`, `_` and `~`."""
    return re.sub(r"[^A-Za-z0-9_]+", "-", source).strip("-")[:_NAME_LIMIT] or "robot"
