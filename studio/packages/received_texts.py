"""Descriptions that came without a file, pasted or from ROS 2: each gets one in the data folder."""

from __future__ import annotations

import re
import shutil
from typing import TYPE_CHECKING, Final

from studio.errors import NotMadeError
from studio.files import write_whole
from studio.packages.index import load_choices, save_choices
from studio.settings import SOURCE_SIZE_LIMIT_BYTES

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from studio.packages.index import PackageIndex

UNTITLED_FOLDER: Final = "untitled"
COUNT_LIMIT: Final = 500
_STEM: Final = "untitled-"
_SUFFIX: Final = ".urdf.xacro"
_BYTE_ORDER_MARK: Final = "\N{ZERO WIDTH NO-BREAK SPACE}"
_ROBOT: Final = re.compile(r"<(?:\w+:)?robot\b")
_PART: Final = re.compile(r"<(?:link|joint|material|transmission|gazebo|xacro:\w+)\b")
_AROUND: Final = (
    '<?xml version="1.0"?>\n<robot name="untitled" xmlns:xacro="http://www.ros.org/wiki/xacro">\n',
    "\n</robot>\n",
)
FROM_ROS_FOLDER: Final = "from_ros"
_NAME_LIMIT: Final = 80
_NAMED: Final = re.compile(r"package://([A-Za-z0-9_.-]{1,100})/")
_NAMED_LIMIT: Final = 100


def new_untitled(data_folder: Path, text: str) -> Path:
    """Keep a text under the next free name, and return its file.

    Parts of a robot without the robot around them get one. The text may be broken otherwise: it
    is kept as it is.

    Raises:
        NotMadeError: It is no robot description at all, or the data folder cannot take it.
    """
    kept = _as_robot(text.removeprefix(_BYTE_ORDER_MARK))
    try:
        folder = _next_folder(data_folder / UNTITLED_FOLDER)
    except OSError as error:
        raise NotMadeError("An untitled robot", _reason(error)) from error
    file = folder / f"{folder.name}{_SUFFIX}"
    try:
        file.write_bytes(kept.encode("utf-8", "replace"))
    except OSError as error:
        shutil.rmtree(folder, ignore_errors=True)
        raise NotMadeError("An untitled robot", _reason(error)) from error
    return file


def untitled_number(file: Path, data_folder: Path) -> int | None:
    """Return the number of an untitled text; None for any other file."""
    folder = file.parent
    if folder.parent != data_folder / UNTITLED_FOLDER or file.name != f"{folder.name}{_SUFFIX}":
        return None
    number = folder.name.removeprefix(_STEM)
    return int(number) if number.isdecimal() else None


def drop_untitled(file: Path, data_folder: Path) -> None:
    """Delete an untitled text, which was saved elsewhere; other files stay."""
    if untitled_number(file, data_folder) is not None:
        shutil.rmtree(file.parent, ignore_errors=True)


def _as_robot(text: str) -> str:
    if _ROBOT.search(text):
        return text
    if not _PART.search(text):
        reason = "the text is no robot description: it has no <robot>, <link> or <joint> in it."
        raise NotMadeError("An untitled robot", reason)
    return _without_declaration(text).strip("\n").join(_AROUND)


def _without_declaration(text: str) -> str:
    """Return the text without its first `<?xml ...?>`, and without the blanks around that.

    Looked for step by step: a pattern for it takes for ever on many blanks or many beginnings.
    """
    begin = text.find("<?xml")
    end = text.find("?>", begin)
    if begin < 0 or end < 0 or ">" in text[begin:end]:
        return text
    return text[:begin].rstrip() + text[end + 2 :].lstrip()


def _next_folder(untitled: Path) -> Path:
    """Make the folder of the first free number; simultaneous calls get different ones."""
    untitled.mkdir(parents=True, exist_ok=True)
    for number in range(1, COUNT_LIMIT + 1):
        folder = untitled / f"{_STEM}{number}"
        try:
            folder.mkdir()
        except FileExistsError:
            continue
        return folder
    reason = f"there are {COUNT_LIMIT} of them: save some elsewhere, or delete them in {untitled}."
    raise NotMadeError("An untitled robot", reason)


def _reason(error: OSError) -> str:
    return f"the data folder cannot take it ({error.strerror or type(error).__name__})."


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
    folder = data_folder / FROM_ROS_FOLDER / _folder_name(source)
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
    """Make a description find the packages that it names where open robots have them.

    It is beside none of them, so its meshes would be missing; what a person chose stays.

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


def _folder_name(source: str) -> str:
    """Letters, digits and hyphens of a name of ROS; those have no others but `/`, `_` and `~`."""
    return re.sub(r"[^A-Za-z0-9_]+", "-", source).strip("-")[:_NAME_LIMIT] or "robot"
