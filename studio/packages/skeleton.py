"""New packages: a robot from a template or a text, all files around it, and valid names."""

from __future__ import annotations

import os
import re
import shutil
from pathlib import Path
from typing import Final, Literal, TypeAlias

from studio.errors import NotMadeError
from studio.files import is_there

LENGTH_LIMIT: Final = 60
_NAME: Final = re.compile(r"[a-z][a-z0-9]*(?:_[a-z0-9]+)*")
ROBOTS: Final = "robots"
"""Folder of the data folder where new robots go unless another one is named."""
Template: TypeAlias = Literal["blank", "rover", "arm"]
_TEMPLATES: Final = Path(__file__).parent / "templates"
_SUFFIX: Final = ".urdf.xacro"
_FIRST_LINK: Final = re.compile(rb"""<link\s[^<>]*?name\s*=\s*["']([\w-]+)["']""")


def name_fault(name: str) -> str:
    """Return what is wrong with a name for a new package, a sentence; empty if nothing is.

    The rule is that of ROS (REP 144): small letters, digits and single underscores, a letter first.
    """
    if len(name) < 2:
        return "A package name has two characters at least."
    if len(name) > LENGTH_LIMIT:
        return f"A package name has {LENGTH_LIMIT} characters at most."
    if not _NAME.fullmatch(name):
        return (
            "A package name is of small letters, digits and single underscores, "
            "with a letter first and no underscore last: my_rover_description, say."
        )
    return ""


def robot_of(package: str) -> str:
    """Return the robot of a package: its name without a suffix such as `_description`."""
    return package.removesuffix("_description") or package


def template_text(template: Template, robot: str) -> bytes:
    """Return the text of a template for a robot of that name."""
    return _filled(f"{template}{_SUFFIX}", {"ROBOT": robot})


def make_package(folder: Path, package: str, text: bytes) -> Path:
    """Write a whole package `folder/package` around a robot's text; the robot's file is returned.

    It appears at once or not at all.

    Raises:
        NotMadeError: The name is none for a package, something bears it there, or the system
            refused.
    """
    target = folder / package
    if fault := name_fault(package):
        raise NotMadeError(package, fault)
    if is_there(target):
        raise NotMadeError(str(target), "there is something of that name: choose another one.")
    partial = folder / f".{package}.{os.getpid()}"
    file = f"{robot_of(package)}{_SUFFIX}"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        _write_all(partial, package, text)
        partial.rename(target)
    except OSError as error:
        shutil.rmtree(partial, ignore_errors=True)
        raise NotMadeError(str(target), _reason(error)) from error
    return target / "urdf" / file


def make_file(folder: Path, package: str, text: bytes) -> Path:
    """Write a robot's text as the only file, and return it.

    Raises:
        NotMadeError: The name is none, the file is there already, or the system refused.
    """
    if fault := name_fault(package):
        raise NotMadeError(package, fault)
    file = folder / f"{robot_of(package)}{_SUFFIX}"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        _write_new(file, text)
    except FileExistsError as error:
        raise NotMadeError(str(file), "it is there already: choose another name.") from error
    except OSError as error:
        raise NotMadeError(str(file), _reason(error)) from error
    return file


def description_files(package: str, text: bytes) -> dict[str, bytes]:
    """Return the files of a package around a robot's text, by their paths below its folder."""
    file = f"{robot_of(package)}{_SUFFIX}"
    values = {"PACKAGE": package, "ROBOT": robot_of(package), "FILE": file, "ROOT": _root_of(text)}
    around = ("package.xml", "CMakeLists.txt", "README.md", "launch/display.launch.py")
    filled = {path: _filled(f"{Path(path).name}.in", values) for path in around}
    return {f"urdf/{file}": text, **filled}


def _write_all(folder: Path, package: str, text: bytes) -> None:
    shutil.rmtree(folder, ignore_errors=True)
    for path, data in description_files(package, text).items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        _write_new(folder / path, data)


def _write_new(file: Path, text: bytes) -> None:
    """Write a file that must not be there yet; half a file is taken away again."""
    with file.open("xb") as opened:
        try:
            opened.write(text)
            opened.flush()
            os.fsync(opened.fileno())
        except OSError:
            file.unlink(missing_ok=True)
            raise


def _filled(template: str, values: dict[str, str]) -> bytes:
    text = (_TEMPLATES / template).read_text(encoding="utf-8")
    for name, value in values.items():
        text = text.replace(f"@{name}@", value)
    return text.encode()


def _root_of(text: bytes) -> str:
    """Return the frame that RViz holds still: the first link, which is the root in most files."""
    found = _FIRST_LINK.search(text)
    return found[1].decode() if found else "base_link"


def _reason(error: OSError) -> str:
    return f"the system refused ({error.strerror or type(error).__name__})."
