"""Files dropped together, put where the descriptions among them look for them."""

from __future__ import annotations

import os
import re
from collections import Counter
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING, Final, NamedTuple

from studio.packages.archive import is_plain_step
from studio.packages.folder_memory import is_robot_name
from studio.packages.manifest import FILE_NAME, SIZE_LIMIT_BYTES, package_name
from studio.settings import SOURCE_SIZE_LIMIT_BYTES

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

_IN_PACKAGE: Final = re.compile(
    r"(?:(?:package|model)://|\$\(find(?:-pkg-share)?\s+)([A-Za-z0-9_.-]{1,200})\)?/"
    r"([^\"'<>\r\n${}]{1,500}\.\w{1,10})"
)
_BESIDE: Final = re.compile(r"filename\s*=\s*[\"']([^\"'<>:${}\r\n]{1,500}\.\w{1,10})[\"']")
_REFERENCES_READ: Final = 20_000


class Reference(NamedTuple):
    """A file that a description names; `package` is empty where it is looked for beside."""

    package: str
    inside: str
    """Its path in the package, or seen from the folder of the description."""


def arrange(folder: Path) -> dict[str, Path]:
    """Make the files of a folder find each other.

    A browser tells no more than names, so a robot and its meshes, dropped together, lie side by
    side, where `package://my_robot/meshes/base.stl` finds nothing. Each file that is named, is not
    there, and lies elsewhere under the same name goes to the place where it is looked for.

    Returns:
        For each package without a package.xml the folder that stands for it, relative to `folder`.
    """
    return _Arranging(folder).run()


class _Arranging:
    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._files = {one: one.relative_to(folder) for one in _files_below(folder)}
        self._moved: dict[Path, Path] = {}

    def run(self) -> dict[str, Path]:
        texts = [one for one in self._files if is_robot_name(one.name)]
        named = {one: _references(one) for one in texts}
        known = self._packages()
        wanted = _by_package(named.values(), known)
        chosen = {name: self._stand_in(name, inside) for name, inside in wanted.items()}
        for file, references in named.items():
            folder = self._moved.get(file, file).parent
            for one in references:
                if one.package == "":
                    self._bring(folder, one.inside)
        return {name: found for name, found in chosen.items() if found is not None}

    def _packages(self) -> set[str]:
        manifests = (one for one in self._files if one.name == FILE_NAME)
        return {package_name(_start_of(one, SIZE_LIMIT_BYTES)) or "" for one in manifests}

    def _stand_in(self, package: str, wanted: dict[str, None]) -> Path | None:
        """The folder below which most of the wanted files lie, or one into which they are put."""
        holding = Counter(folder for one in wanted for folder in self._holders(one))
        if holding:
            return holding.most_common(1)[0][0]
        if not is_plain_step(package):
            return None
        brought = [self._bring(self._folder / package, one) for one in wanted]
        return Path(package) if any(brought) else None

    def _holders(self, inside: str) -> Iterator[Path]:
        """Folders in which a file lies at this path; not the folder of all, for a bare name."""
        steps = PurePosixPath(inside).parts
        for path in self._files.values():
            if len(steps) > 1 and path.parts[-len(steps) :] == steps:
                yield Path(*path.parts[: -len(steps)])

    def _bring(self, folder: Path, inside: str) -> bool:
        """Move the one file of this name to where it is looked for, unless something is there."""
        target = Path(os.path.normpath(folder / inside.lstrip("/")))
        steps = target.parts[len(self._folder.parts) :]
        is_below = target.parts[: len(self._folder.parts)] == self._folder.parts
        if not is_below or not all(map(is_plain_step, steps)) or target in self._files:
            return target in self._files
        named = [one for one in self._files if one.name == target.name]
        if len(named) != 1 or any(parent in self._files for parent in target.parents):
            return False
        target.parent.mkdir(parents=True, exist_ok=True)
        named[0].rename(target)
        del self._files[named[0]]
        self._files[target] = target.relative_to(self._folder)
        self._moved[named[0]] = target
        return True


def _by_package(
    named: Iterable[tuple[Reference, ...]], known: set[str]
) -> dict[str, dict[str, None]]:
    """What is looked for in each package that is not among the files."""
    wanted: dict[str, dict[str, None]] = {}
    for one in (reference for references in named for reference in references):
        if one.package and one.package not in known:
            wanted.setdefault(one.package, {})[one.inside] = None
    return wanted


def _references(file: Path) -> tuple[Reference, ...]:
    text = _start_of(file, SOURCE_SIZE_LIMIT_BYTES).decode("utf-8", "replace")
    found = {Reference(one[1], one[2]): None for one in _IN_PACKAGE.finditer(text)}
    found |= {Reference("", one[1]): None for one in _BESIDE.finditer(text)}
    return tuple(found)[:_REFERENCES_READ]


def _start_of(file: Path, limit_bytes: int) -> bytes:
    with file.open("rb") as opened:
        return opened.read(limit_bytes)


def _files_below(folder: Path) -> Iterator[Path]:
    for path, _, names in os.walk(folder):
        for name in names:
            yield Path(path, name)
