"""Which files of a folder describe a whole robot, best first, and why the others do not."""

from __future__ import annotations

import re
from dataclasses import dataclass
from itertools import islice
from typing import TYPE_CHECKING, Final, Literal, TypeAlias

from studio.errors import PackageError
from studio.packages.discovery import robot_files
from studio.packages.folder_memory import FolderMemory
from studio.packages.includes import Includes
from studio.packages.manifest import FILE_NAME, SIZE_LIMIT_BYTES, package_name
from studio.packages.outline import Outline, read_outline
from studio.packages.roots import package_folder_of

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable
    from pathlib import Path

    from studio.packages.roots import ServedRoots

FILE_LIMIT: Final = 20_000
_ASIDE: Final = frozenset({"test", "tests", "example", "examples", "gazebo", "moveit", "demo"})
_PACKAGE_ENDINGS: Final = re.compile(
    r"_(descriptions?|support|tutorial|simple|bringup|robot|model)$"
)
_ALL_SUFFIXES: Final = re.compile(r"(\.urdf|\.xacro|\.xml|\.robot)+$")

Kind: TypeAlias = Literal["xacro", "urdf"]


@dataclass(frozen=True, slots=True)
class EntryPoint:
    """A file that is, or might be taken for, a robot description."""

    path: Path
    kind: Kind
    title: str
    """The robot's name, or the file's when the name is only known after expansion."""
    package: str
    """Name of the package that it lies in; empty when it is in none."""
    openable: bool
    reason: str = ""
    """Why it cannot be opened as a robot, in words; empty when it can."""
    is_broken: bool = False
    """Its XML has a fault: others are opened first."""
    included_by: tuple[Path, ...] = ()
    """Those of the same survey that include it, themselves perhaps no robots."""


def entry_points(
    folder: Path,
    roots: ServedRoots,
    progress: Callable[[int, int], None] | None = None,
    memory: FolderMemory | None = None,
) -> list[EntryPoint]:
    """Every file below a folder that looks like a robot description: the best to open first.

    At most FILE_LIMIT files are looked at. `progress` is told (files read, files to read);
    `memory` is that of an earlier search of these folders.
    """
    files = robot_files(folder, memory or FolderMemory(None, roots))
    return survey(islice(files, FILE_LIMIT), roots, progress)


def survey(
    files: Iterable[Path], roots: ServedRoots, progress: Callable[[int, int], None] | None = None
) -> list[EntryPoint]:
    """Judge these files, each in the light of the others."""
    return _Survey(roots).run(list(files), progress)


class _Survey:
    def __init__(self, roots: ServedRoots) -> None:
        self._roots = roots
        self._packages: dict[Path, tuple[str, Path | None]] = {}
        """Name and folder of the package, by folder of a file."""

    def run(
        self, files: list[Path], progress: Callable[[int, int], None] | None
    ) -> list[EntryPoint]:
        outlines: dict[Path, Outline] = {}
        for done, path in enumerate(files, start=1):
            outlines[path] = self._outline(path)
            if progress is not None:
                progress(done, len(files))
        packages = {path: self._package_of(path.parent) for path in files}
        includes = Includes(outlines, packages)
        points = [
            self._judge(path, outline, includes)
            for path, outline in outlines.items()
            if path.suffix != ".xml" or outline.root == "robot"
        ]
        return sorted(points, key=lambda one: self._rank(one, includes))

    def _outline(self, path: Path) -> Outline:
        try:
            return read_outline(self._roots.read(path))
        except PackageError as error:
            return Outline(error=str(error).removeprefix(str(path)).strip(" :."))

    def _package_of(self, folder: Path) -> tuple[str, Path | None]:
        if folder not in self._packages:
            package = package_folder_of(folder)
            name = None
            if package is not None and self._roots.serves(package / FILE_NAME):
                name = self._name_in(package / FILE_NAME)
            self._packages[folder] = (name or "", package)
        return self._packages[folder]

    def _name_in(self, manifest: Path) -> str | None:
        try:
            return package_name(self._roots.read(manifest, SIZE_LIMIT_BYTES))
        except PackageError:
            return None

    def _judge(self, path: Path, outline: Outline, includes: Includes) -> EntryPoint:
        reason = _why_not(path, outline, includes)
        name = outline.name
        return EntryPoint(
            path=path,
            kind="xacro" if outline.is_xacro else "urdf",
            title=path.name if not name or "$" in name else name,
            package=self._package_of(path.parent)[0],
            openable=not reason,
            reason=reason,
            is_broken=outline.is_broken,
            included_by=tuple(includes.includers(path)),
        )

    def _rank(self, point: EntryPoint, includes: Includes) -> tuple[bool | int | str, ...]:
        """Openable first; then what a person would try first."""
        _, package_folder = self._package_of(point.path.parent)
        inside = point.path.relative_to(package_folder) if package_folder else point.path
        return (
            not point.openable,
            point.is_broken,
            any(_words(step) & _ASIDE for step in inside.parts),
            "description" not in point.package and "support" not in point.package,
            not _is_named_like(point, start=False),
            bool(includes.includers(point.path)),
            not point.path.name.endswith(".urdf.xacro"),
            point.kind != "xacro",
            not _is_named_like(point, start=True),
            len(point.path.parts),
            str(point.path),
        )


def _why_not(path: Path, outline: Outline, includes: Includes) -> str:
    """The picker's rule; empty when the file is a robot."""
    if outline.error and not _is_broken_robot(outline):
        return f"not readable: {outline.error}"
    if outline.root != "robot":
        return f"root is <{outline.root}>"
    if ".srdf" in path.suffixes:
        return "an SRDF: says how a robot is used, not what it is"
    if not outline.has_content and not includes.bring_content(path):
        return _without_content(outline)
    includers = includes.includers(path)
    if not outline.name and includers:
        return f"included by {includers[0].name}"
    return ""


def _is_broken_robot(outline: Outline) -> bool:
    """Whether a file is a robot up to a fault: it is opened, and says what is wrong with it."""
    return outline.is_broken and outline.root == "robot" and outline.has_content


def _without_content(outline: Outline) -> str:
    if outline.defines_macros:
        return "only macros, meant to be included"
    if outline.includes:
        return "includes only macros and properties"
    return "holds no link and calls no macro"


def _is_named_like(point: EntryPoint, *, start: bool) -> bool:
    """Whether the file has the name of its package, or at least begins with it."""
    file = _ALL_SUFFIXES.sub("", point.path.name)
    base = _PACKAGE_ENDINGS.sub("", _PACKAGE_ENDINGS.sub("", point.package))
    if start:
        return bool(base) and file.startswith(base)
    return file in (base, point.package, "robot")


def _words(step: str) -> set[str]:
    return set(re.split(r"[^a-z]+", step.lower()))
