"""Texts that have no place of their own yet: pasted ones, each in a folder of the data folder."""

from __future__ import annotations

import re
import shutil
from typing import TYPE_CHECKING, Final

from studio.errors import NotMadeError

if TYPE_CHECKING:
    from pathlib import Path

FOLDER: Final = "untitled"
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


def new_untitled(data_folder: Path, text: str) -> Path:
    """Keep a text under the next free name, and return its file.

    Parts of a robot without the robot around them get one. The text may be broken otherwise: it
    is kept as it is.

    Raises:
        NotMadeError: It is no robot description at all, or the data folder cannot take it.
    """
    kept = _as_robot(text.removeprefix(_BYTE_ORDER_MARK))
    try:
        folder = _next_folder(data_folder / FOLDER)
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
    """Which untitled text a file is; None for any other file."""
    folder = file.parent
    if folder.parent != data_folder / FOLDER or file.name != f"{folder.name}{_SUFFIX}":
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
    """The text without its first `<?xml ...?>`, and without the blanks around that.

    Looked for step by step: a pattern for it takes for ever on many blanks or many beginnings.
    """
    begin = text.find("<?xml")
    end = text.find("?>", begin)
    if begin < 0 or end < 0 or ">" in text[begin:end]:
        return text
    return text[:begin].rstrip() + text[end + 2 :].lstrip()


def _next_folder(untitled: Path) -> Path:
    """Make the folder of the first free number; two who ask at once get two."""
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
