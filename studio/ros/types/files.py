"""Interface files of a package, of a folder of packages, or of what STUDIO_INTERFACES names."""

from __future__ import annotations

import os
import re
import stat
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, cast
from xml.etree import ElementTree

from studio.errors import (
    InterfaceTextError,
    RosNameError,
    UnreadableFileError,
)
from studio.ros.names import KINDS, check_package_name, split_type_name
from studio.ros.types.interface_text import TEXT_BYTES_MAX

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

FILES_MAX = 5_000
_MANIFEST = "package.xml"
_PACKAGE_NAME = re.compile(r"[A-Za-z0-9_.-]{1,200}")


@dataclass(frozen=True, slots=True)
class InterfaceTexts:
    """Texts by the full names of their types, with the files that they come from.

    Attributes:
        faults: What keeps a file from being one of them, by the name that its type would have.
    """

    texts: dict[str, str] = field(default_factory=dict[str, str])
    files: dict[str, Path] = field(default_factory=dict[str, Path])
    faults: dict[str, InterfaceTextError] = field(default_factory=dict[str, InterfaceTextError])

    def take(self, package: str, path: Path) -> None:
        """Read a file of a package, or note why it cannot be one of its types."""
        name = f"{package}/{path.suffix.removeprefix('.')}/{path.stem}"
        try:
            _check_whole(name)
            self.texts[name], self.files[name] = read_text(path), path
        except RosNameError as error:
            self.faults[name] = InterfaceTextError(str(path), None, _rename(path, error))
        except UnreadableFileError as error:
            self.faults[name] = InterfaceTextError(str(path), None, error.reason.rstrip("."))

    def placed(self, faults: Mapping[str, InterfaceTextError]) -> dict[str, InterfaceTextError]:
        """Return faults of these texts as those of their files, where they come from files."""
        files = self.files
        return {
            name: one.at(str(files[name])) if name in files else one for name, one in faults.items()
        }

    @classmethod
    def of_all(cls, parts: Iterable[InterfaceTexts]) -> InterfaceTexts:
        """Put several together; of texts with one name, the last."""
        whole = cls()
        for part in parts:
            whole.texts.update(part.texts)
            whole.files.update(part.files)
            whole.faults.update(part.faults)
        return whole


def texts_of_package(folder: Path, package: str) -> InterfaceTexts:
    """Read the texts in `msg`, `srv` and `action` of a package's folder.

    Links that lead out of the folder, and what is no regular file, are passed over.

    Raises:
        RosNameError: The package has a name that none may have.
        UnreadableFileError: There are too many files.
    """
    check_package_name(package)
    paths = [path for kind in KINDS for path in _files(folder, kind)]
    if len(paths) > FILES_MAX:
        raise UnreadableFileError(str(folder), f"it holds more than {FILES_MAX} interfaces.")
    found = InterfaceTexts()
    for path in paths:
        found.take(package, path)
    return found


def read_text(path: Path) -> str:
    """Read one interface text, whole.

    Raises:
        UnreadableFileError: It is too large, no regular file, or cannot be read.
    """
    try:
        # A pipe would wait for its writer, for ever.
        handle = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0))
        with open(handle, "rb") as file:  # noqa: PTH123  # of the handle that was checked
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


def _check_whole(name: str) -> None:
    """Refuse what names no type, or only a part of one.

    Raises:
        RosNameError: It is so.
    """
    _, _, base = split_type_name(name)
    if "_" in base:
        raise RosNameError(name, "a type is named in letters and digits, the first a capital")


def _rename(path: Path, error: RosNameError) -> str:
    """Return what a file would have to be called."""
    parts = re.split(r"[^A-Za-z0-9]+", path.stem)
    better = "".join(part[:1].upper() + part[1:] for part in parts).lstrip("0123456789")
    mend = f": call it {better[:1].upper()}{better[1:]}{path.suffix}" if better else ""
    return f"its name defines no type, {error.reason}{mend}"


def texts_at(path: Path) -> InterfaceTexts:
    """Read the texts at a path.

    Raises:
        UnreadableFileError: Nothing is there, or it holds no types.
        RosNameError: A package has a name that none may have.
    """
    if path.is_file():
        folder = next((one for one in _folders_above(path) if (one / _MANIFEST).is_file()), None)
        return _text_of_file(_name_of(folder) if folder else path.parent.parent.name, path)
    folders = [path] if _holds_types(path) else [one for one in path.glob("*") if _holds_types(one)]
    if not folders:
        raise UnreadableFileError(
            str(path), "holds no msg, srv or action folder: name a package's folder or one file."
        )
    return InterfaceTexts.of_all(
        texts_of_package(folder, _name_of(folder)) for folder in sorted(folders)
    )


def _holds_types(folder: Path) -> bool:
    return any((folder / kind).is_dir() for kind in KINDS)


def _name_of(folder: Path) -> str:
    """Return the name in the package.xml, else that of the folder.

    A package.xml that is a link out of the folder is passed over.

    Raises:
        UnreadableFileError: The package.xml is too large, no regular file, or cannot be read.
    """
    manifest = folder / _MANIFEST
    is_here = manifest.is_file() and manifest.resolve().is_relative_to(folder.resolve())
    return (_name_in(read_text(manifest)) if is_here else "") or folder.name


def _name_in(manifest: str) -> str:
    """Return the text of `name` in `package`; empty if there is none or it names no package.

    What is broken behind the name does not matter here.
    """
    parser: ElementTree.XMLPullParser[ElementTree.Element] = ElementTree.XMLPullParser(
        ("start", "end")
    )
    parser.feed(manifest)
    path: list[str] = []
    try:
        for event, element in cast(
            "Iterable[tuple[str, ElementTree.Element]]", parser.read_events()
        ):
            if event == "start":
                path.append(element.tag)
            elif path == ["package", "name"]:
                name = (element.text or "").strip()
                return name if _PACKAGE_NAME.fullmatch(name) else ""
            else:
                path.pop()
    except ElementTree.ParseError:
        return ""
    return ""


def _folders_above(path: Path) -> Iterator[Path]:
    """Walk up from a file; the home folder and what holds it belong to no package."""
    home = Path(os.path.realpath(os.path.expanduser("~")))  # noqa: PTH111 - `Path.home` may raise
    for folder in path.parents:
        if home.is_relative_to(folder):
            return
        yield folder


def _text_of_file(package: str, path: Path) -> InterfaceTexts:
    if path.suffix.removeprefix(".") not in KINDS:
        raise UnreadableFileError(str(path), "defines no type: name a .msg, .srv or .action file.")
    found = InterfaceTexts()
    found.take(package, path)
    return found
