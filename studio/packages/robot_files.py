"""Finds the files of a folder that describe a whole robot, best first, and why others do not.

An outline of each file and the includes among them are enough: nothing is expanded.
"""

from __future__ import annotations

import os
import re
from collections import defaultdict
from dataclasses import dataclass, field
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, Literal, TypeAlias
from xml.parsers import expat

from studio.errors import PackageError
from studio.files import LFS_REASON, is_lfs_pointer
from studio.packages.discovery import robot_files
from studio.packages.folder_memory import FolderMemory
from studio.packages.manifest import FILE_NAME, SIZE_LIMIT_BYTES, package_name
from studio.packages.roots import package_folder_of

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from studio.packages.roots import ServedRoots

_PREFIX: Final = "xacro:"
"""Xacro goes by the prefix: four spellings of its namespace are in use (UR's is neither of the two
that its pages name), and it takes them all."""
_NAMESPACES: Final = frozenset({"http://www.ros.org/wiki/xacro", "http://ros.org/wiki/xacro"})
_DIRECTIVES: Final = frozenset(
    {"arg", "property", "include", "if", "unless", "macro", "insert_block", "element", "attribute"}
)
"""Every other element with the prefix calls a macro."""
_TRANSPARENT: Final = frozenset({"if", "unless"})
_FIND: Final = re.compile(r"(?:file://)?\$\(find\s+([\w.-]+)\s*\)/(.*)|package://([\w.-]+)/(.*)")
FILE_LIMIT: Final = 20_000
_ASIDE: Final = frozenset({"test", "tests", "example", "examples", "gazebo", "moveit", "demo"})
_PACKAGE_ENDINGS: Final = re.compile(
    r"_(descriptions?|support|tutorial|simple|bringup|robot|model)$"
)
_ALL_SUFFIXES: Final = re.compile(r"(\.urdf|\.xacro|\.xml|\.robot)+$")
Kind: TypeAlias = Literal["xacro", "urdf"]


@dataclass(slots=True)
class Outline:
    """The outline of one file; `error` is why it cannot be read, else empty."""

    root: str = ""
    """Local name of the root element."""
    name: str = ""
    """The root's name attribute as written; may hold `$(arg ...)` or be empty."""
    is_xacro: bool = False
    """Whether it declares the xacro prefix, or its namespace under any prefix."""
    has_content: bool = False
    """A link, or a call of a macro, stands at the top level outside macros."""
    defines_macros: bool = False
    includes: list[str] = field(default_factory=list[str])
    """The file names of its includes outside macros, as written."""
    error: str = ""
    is_broken: bool = False
    """Whether it is XML up to a fault, which is `error`; the rest may be read all the same."""


def read_outline(data: bytes) -> Outline:
    """Read the outline; never raises. Entities are refused, nothing else is fetched."""
    reader = _OutlineReader()
    try:
        reader.parse(data)
    except _RefusedError as error:
        reader.outline.error = str(error)
    except expat.ExpatError as error:
        reader.outline.error = (
            f"not well-formed XML: {expat.ErrorString(error.code)}, line {error.lineno}"
        )
        reader.outline.is_broken = True
    except (LookupError, ValueError) as error:  # an encoding that does not exist or does not fit
        reader.outline.error = f"of no readable encoding ({error})"
    return reader.outline


class _RefusedError(Exception):
    """The file asks for what is not done."""


class _DoneError(Exception):
    """Ends the reading early."""


class _OutlineReader:
    """Counts the depth and reads the elements at the top level."""

    def __init__(self) -> None:
        self.outline = Outline()
        self._depth = 0
        """Depth below the root, not counting elements of `_TRANSPARENT`."""
        self._open: list[bool] = []
        """For each open element, whether it counts for the depth."""

    def parse(self, data: bytes) -> None:
        if not data.strip(b"\xef\xbb\xbf \t\r\n"):
            raise _RefusedError("empty")
        if is_lfs_pointer(data):
            raise _RefusedError(LFS_REASON.removesuffix("."))
        if b"\0" in data[:1024]:
            raise _RefusedError("binary or UTF-16: save it as UTF-8")
        parser: Any = expat.ParserCreate()
        parser.StartElementHandler = self._start
        parser.EndElementHandler = self._end
        parser.EntityDeclHandler = _refuse_entity
        parse: Callable[[bytes, bool], int] = parser.Parse
        try:
            parse(data, True)  # noqa: FBT003 - expat takes it by position only
        except _DoneError:
            return

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        self._see_declarations(attributes)
        in_xacro = tag.startswith(_PREFIX)
        local = tag.removeprefix(_PREFIX)
        counts = not (in_xacro and local in _TRANSPARENT)
        if not self._open:
            self._root(tag, attributes)
        elif self._depth == 1 and counts:
            self._top_level(local, attributes, in_xacro=in_xacro)
        self._open.append(counts)
        self._depth += counts

    def _see_declarations(self, attributes: dict[str, str]) -> None:
        if not self.outline.is_xacro and attributes:
            named = "xmlns:xacro" in attributes
            self.outline.is_xacro = named or not _NAMESPACES.isdisjoint(attributes.values())

    def _end(self, _full_name: str) -> None:
        self._depth -= self._open.pop()

    def _root(self, tag: str, attributes: dict[str, str]) -> None:
        self.outline.root, self.outline.name = tag, attributes.get("name", "")
        if tag != "robot":
            raise _DoneError

    def _top_level(self, local: str, attributes: dict[str, str], *, in_xacro: bool) -> None:
        outline = self.outline
        if not in_xacro:
            outline.has_content |= local == "link"
            if outline.has_content and not outline.is_xacro:
                raise _DoneError  # plain URDF: it includes nothing
        elif local == "include":
            outline.includes.append(attributes.get("filename", ""))
        elif local == "macro":
            outline.defines_macros = True
        elif local not in _DIRECTIVES:
            outline.has_content = True


def _refuse_entity(*_declaration: object) -> None:
    raise _RefusedError("it declares entities, which are never expanded")


class Includes:
    """The include graph of some files, as far as it can be known without evaluation."""

    def __init__(
        self, outlines: Mapping[Path, Outline], packages: Mapping[Path, tuple[str, Path | None]]
    ) -> None:
        self._outlines = outlines
        self._folders = {name: folder for name, folder in packages.values() if name and folder}
        self._by_name: dict[str, list[Path]] = defaultdict(list)
        for path in outlines:
            self._by_name[path.name].append(path)
        self._included: dict[Path, list[Path]] = {}
        """The files that each file includes."""
        self._unknown: set[Path] = set()
        """Files that include something that is not among these."""
        self._includers: dict[Path, list[Path]] = defaultdict(list)
        for path, outline in outlines.items():
            self._link(path, outline.includes)

    def includers(self, path: Path) -> list[Path]:
        """Return the files that include this one, other than itself."""
        return self._includers.get(path, [])

    def bring_content(self, path: Path) -> bool:
        """Whether what a file includes, over any number of steps, has a link or a macro call.

        A computed include counts as having one, if the file has a name of its own.
        """
        waiting, seen = list(self._included[path]), {path}
        if path in self._unknown and self._outlines[path].name:
            return True
        while waiting:
            one = waiting.pop()
            if self._outlines[one].has_content:
                return True
            if one not in seen:
                seen.add(one)
                waiting += self._included[one]
        return False

    def _link(self, path: Path, includes: Iterable[str]) -> None:
        self._included[path] = []
        for written in includes:
            targets = [one for one in self._targets(path, written) if one != path]
            if not targets:
                self._unknown.add(path)
            self._included[path] += targets
            for target in targets:
                self._includers[target].append(path)

    def _targets(self, path: Path, written: str) -> list[Path]:
        """Return the files that a written name may mean; several when only its end is certain."""
        found = _FIND.fullmatch(written.strip())
        if found:
            folder, inside = self._folders.get(found[1] or found[3]), found[2] or found[4]
            exact = Path(os.path.normpath(folder / inside)) if folder else None
        else:
            inside = written.strip()
            exact = Path(os.path.normpath(path.parent / inside))
        if exact is not None and exact in self._outlines:
            return [exact]
        return self._by_ending(inside) if "$" in written else []

    def _by_ending(self, inside: str) -> list[Path]:
        """Return files whose path ends with the text after the last substitution."""
        ending = re.split(r"[})]", inside)[-1]
        if not ending.startswith("/") or "*" in ending:
            return []
        return [one for one in self._by_name[Path(ending).name] if one.as_posix().endswith(ending)]


@dataclass(frozen=True, slots=True)
class Candidate:
    """A file that is, or might be taken for, a robot description."""

    path: Path
    kind: Kind
    title: str
    """The robot's name, or the file's when the name is only known after expansion."""
    package: str
    """Name of the package that it lies in; empty when it is in none."""
    openable: bool
    reason: str = ""
    """Why it cannot be opened as a robot; empty when it can."""
    is_broken: bool = False
    """Whether its XML has a fault: others are opened first."""
    included_by: tuple[Path, ...] = ()
    """Found files that include it, themselves perhaps no robots."""


def robot_candidates(
    folder: Path,
    roots: ServedRoots,
    progress: Callable[[int, int], None] | None = None,
    memory: FolderMemory | None = None,
) -> list[Candidate]:
    """Return every file below a folder that seems to be a robot description, the best first.

    At most FILE_LIMIT files are read. `progress` is called with (files read, files to read);
    `memory` is that of an earlier search of these folders.
    """
    files = robot_files(folder, memory or FolderMemory(None, roots))
    return survey(islice(files, FILE_LIMIT), roots, progress)


def survey(
    files: Iterable[Path], roots: ServedRoots, progress: Callable[[int, int], None] | None = None
) -> list[Candidate]:
    """Judge these files, each in the light of the others."""
    return _Survey(roots).run(list(files), progress)


class _Survey:
    def __init__(self, roots: ServedRoots) -> None:
        self._roots = roots
        self._packages: dict[Path, tuple[str, Path | None]] = {}
        """Name and folder of the package, by folder of a file."""

    def run(
        self, files: list[Path], progress: Callable[[int, int], None] | None
    ) -> list[Candidate]:
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

    def _judge(self, path: Path, outline: Outline, includes: Includes) -> Candidate:
        reason = _why_not(path, outline, includes)
        name = outline.name
        return Candidate(
            path=path,
            kind="xacro" if outline.is_xacro else "urdf",
            title=path.name if not name or "$" in name else name,
            package=self._package_of(path.parent)[0],
            openable=not reason,
            reason=reason,
            is_broken=outline.is_broken,
            included_by=tuple(includes.includers(path)),
        )

    def _rank(self, point: Candidate, includes: Includes) -> tuple[bool | int | str, ...]:
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
    """Return the picker's rule; empty when the file is a robot."""
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
    """Whether a file is a robot but for a fault: it can be opened, and the fault is reported."""
    return outline.is_broken and outline.root == "robot" and outline.has_content


def _without_content(outline: Outline) -> str:
    if outline.defines_macros:
        return "only macros, meant to be included"
    if outline.includes:
        return "includes only macros and properties"
    return "holds no link and calls no macro"


def _is_named_like(point: Candidate, *, start: bool) -> bool:
    """Whether the file has the name of its package, or at least begins with it."""
    file = _ALL_SUFFIXES.sub("", point.path.name)
    base = _PACKAGE_ENDINGS.sub("", _PACKAGE_ENDINGS.sub("", point.package))
    if start:
        return bool(base) and file.startswith(base)
    return file in (base, point.package, "robot")


def _words(step: str) -> set[str]:
    return set(re.split(r"[^a-z]+", step.lower()))
