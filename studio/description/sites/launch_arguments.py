"""The arguments that a robot can be launched with, read from its files, even if no run succeeds.

A name is followed from `$(arg name)` into properties and macro parameters that hold nothing else,
by name. The values that an argument may have come from comparisons with literals, and from the
folders and files that a path with the argument may name. A form need not be exact: a run decides.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from itertools import islice
from pathlib import PurePath
from typing import TYPE_CHECKING, Final, Protocol

from studio.description.sites.file_sites import xml_sites
from studio.description.sites.widgets import infer_widget, parse_number
from studio.description.syntax.annotations import NOTHING, Annotation
from studio.description.syntax.source_tree import SourceError, SourceText, parse_source
from studio.description.values import SiteKind, Widget, WidgetKind
from studio.errors import PackageError
from studio.problems import Place

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping

    from studio.description.syntax.source_tree import SourceElement, SourceTree

CHOICES_KEPT: Final = 100
_NAMED: Final = r"(?:['\"]?\$\(arg\s+(?P<arg>[\w.-]+)\s*\)['\"]?|(?P<name>[A-Za-z_]\w*))"
_LITERAL: Final = r"(?P<literal>'[^'$]*'|\"[^\"$]*\")"
_COMPARISONS: Final = (
    re.compile(rf"{_NAMED}\s*[!=]=\s*{_LITERAL}"),
    re.compile(rf"{_LITERAL}\s*[!=]=\s*{_NAMED}"),
)
_MEMBERSHIP: Final = re.compile(rf"{_NAMED}\s+(?:not\s+)?in\s*[\[(](?P<list>[^\])$]*)[\])]")
_QUOTED: Final = re.compile(r"'([^']*)'|\"([^\"]*)\"")
_INSIDE: Final = re.compile(r"\$\{([^}]*)\}|\$\(eval\s+([^)]*\)?[^)]*)\)")
_READ: Final = re.compile(r"\$\(arg\s+([\w.-]+)\s*\)|\$\{\s*(\w+)\s*\}")
_PATH: Final = re.compile(r"(?:file://)?\$\(find\s|package://|/")
_TRUTH: Final = re.compile(r"\$\(arg\s+([\w.-]+)\s*\)|\$\{\s*(?:not\s+)?(\w+)\s*\}")
_FILES: Final = 100
_ROUNDS: Final = 12
"""Includes inside includes that are followed."""
_TEXTS: Final = 20_000
_DEPTH: Final = 8
"""Names behind names that are followed."""
_SUBSTITUTION: Final = re.compile(
    r"\$\(find\s+(?P<find>[\w.-]+)\s*\)|package://(?P<package>[\w.-]+)"
    r"|\$\(arg\s+(?P<arg>[\w.-]+)\s*\)|\$\{\s*(?P<name>\w+)\s*\}"
)
_ARG: Final = re.compile(r"\$\(arg\s+([\w.-]+)\s*\)")
_ALIAS: Final = re.compile(r"\$\(arg\s+(?P<arg>[\w.-]+)\s*\)|\$\{\s*(?P<name>\w+)\s*\}")
_CONDITIONS: Final = frozenset({"xacro:if", "xacro:unless"})


class Folders(Protocol):
    """The file system as far as it may be seen; what lies outside is not there."""

    def names(self, folder: str) -> tuple[str, ...]:
        """Return the names in a folder; none if it is no folder."""
        ...

    def exists(self, path: str) -> bool:
        """Whether a file or folder is there."""
        ...

    def is_folder(self, path: str) -> bool:
        """Whether a folder is there."""
        ...


@dataclass(frozen=True, slots=True)
class Named:
    """A `$(arg name)`, or a property or macro parameter of that name."""

    name: str
    is_arg: bool


def compared(text: str) -> Iterator[tuple[Named, str]]:
    """Yield each name that a text compares with a literal, and the literal."""
    for inside in _INSIDE.finditer(text):
        body = inside[1] or inside[2] or ""
        for pattern in _COMPARISONS:
            for found in pattern.finditer(body):
                yield _named(found), found["literal"][1:-1]
        for found in _MEMBERSHIP.finditer(body):
            for quoted in _QUOTED.finditer(found["list"]):
                yield _named(found), quoted[1] or quoted[2] or ""


def truth(text: str) -> Named | None:
    """Return the one name whose truth a condition asks for."""
    found = _TRUTH.fullmatch(text.strip())
    return Named(found[1] or found[2], bool(found[1])) if found else None


def paths_in(text: str, *, is_filename: bool) -> Iterator[str]:
    """Yield what may be a path in a text: all of it, or what is quoted in its expressions."""
    if is_filename or _PATH.match(text):
        yield text
    elif "$(find" in text:
        for quoted in _QUOTED.finditer(text):
            inside = quoted[1] or quoted[2] or ""
            if _PATH.match(inside):
                yield inside


def reads(path: str) -> Iterator[tuple[Named, re.Match[str]]]:
    """Yield every name that stands in a path, and where."""
    for found in _READ.finditer(path):
        yield Named(found[1] or found[2], bool(found[1])), found


def folder_choices(
    path: str, at: re.Match[str], resolve: Callable[[str, str | None], str | None], folders: Folders
) -> tuple[str, ...]:
    """Return the values for which a path leads somewhere.

    Args:
        path: As written, with the name at `at`.
        at: Where the name stands.
        resolve: Gives a text its value, or None; its second argument is the name's value if known.
        folders: What may be seen of the file system.
    """
    before, behind = path[: at.start()], path[at.end() :]
    head, _, begin = before.rpartition("/")
    end, slash, tail = behind.partition("/")
    folder, begin_text = resolve(head, None), resolve(begin, None)
    if not head or not folder or begin_text is None:
        return ()
    found: list[str] = []
    folders_only: list[str] = []
    for name in folders.names(folder):
        value, inside = _between(name, begin_text, end, resolve), f"{folder}/{name}"
        if value and (not slash or folders.is_folder(inside)):
            folders_only.append(value)
            if not slash or folders.exists(f"{inside}/{resolve(tail, value) or ''}"):
                found.append(value)
    # What stands further down may hang on another argument that is not chosen yet.
    kept = found if len(found) > 1 else folders_only
    return tuple(sorted(dict.fromkeys(kept), key=_natural)[:CHOICES_KEPT])


def common(found: Iterable[tuple[str, ...]]) -> tuple[str, ...]:
    """Return the values in all that have any; those of the first if they have none in common."""
    known = [one for one in found if one]
    if not known:
        return ()
    agreed = tuple(value for value in known[0] if all(value in one for one in known))
    return agreed or known[0]


def _named(found: re.Match[str]) -> Named:
    return Named(found["arg"] or found["name"], bool(found["arg"]))


def _between(
    name: str, begin: str, end: str, resolve: Callable[[str, str | None], str | None]
) -> str:
    """Return the part of a file name between its known begin and end; empty if they differ."""
    if not name.startswith(begin) or name.startswith("."):
        return ""
    for size in range(len(name) - len(begin), 0, -1):
        value = name[len(begin) : len(begin) + size]
        if resolve(end, value) == name[len(begin) + size :]:
            return value
    return ""


def _natural(text: str) -> list[tuple[int, int | str]]:
    """Sorts ur5 before ur10."""
    parts = re.split(r"(\d{1,9})", text)
    return [(0, int(part)) if part.isdigit() else (1, part) for part in parts if part]


class World(Folders, Protocol):
    """The files and packages that may be read."""

    def read(self, path: str) -> bytes:
        """Return a file's text as it is edited; PackageError when it may not or cannot be read."""
        ...

    def find(self, package: str, asking_file: str) -> str | None:
        """Return the folder of a package."""
        ...


@dataclass(frozen=True, slots=True)
class LaunchArgument:
    """One argument: `default` as written, None where the robot needs a value from outside."""

    name: str
    place: Place
    default: str | None
    shown: str
    """Its present value, where the texts alone show it."""
    widget: Widget
    is_file: bool
    """Whether its value names a file."""
    in_macro: bool
    """Whether it is read in macros only, which need not be called."""
    is_early: bool
    """The root element reads it, above its declaration: a default there comes too late."""


@dataclass(frozen=True, slots=True)
class _Text:
    text: str
    element: SourceElement
    attribute: str


@dataclass(frozen=True, slots=True)
class _Declared:
    place: Place
    text: str
    annotation: Annotation


def launch_arguments(
    entry: str, arguments: Mapping[str, str], world: World, also: Iterable[str] = ()
) -> tuple[LaunchArgument, ...]:
    """Return every argument of a file and what it includes, those without a default first.

    Args:
        entry: The file that is launched.
        arguments: What is passed already; it may decide what is included.
        world: What may be read.
        also: More files that a run is known to have read.
    """
    scan = _Scan(arguments, world)
    scan.follow([entry, *also])
    names = dict.fromkeys([*scan.used_undeclared(), *scan.early(entry), *scan.declared])
    return tuple(scan.argument(name) for name in names)


class _Scan:
    """All that the files have about arguments."""

    def __init__(self, arguments: Mapping[str, str], world: World) -> None:
        self._arguments, self._world = arguments, world
        self._trees: dict[str, SourceTree | None] = {}
        self._texts: list[_Text] = []
        self._alias: dict[str, str] = {}
        self._literals: dict[str, str] = {}
        self._used: dict[str, _Text] = {}
        self.declared: dict[str, _Declared] = {}

    def follow(self, files: Iterable[str]) -> None:
        """Read files and, as far as their names are known, what they include."""
        pending = list(files)
        for _ in range(_ROUNDS):
            for path in pending:
                if path not in self._trees and len(self._trees) < _FILES:
                    self._trees[path] = self._parsed(path)
            pending = [path for path in self._included() if path not in self._trees]
            if not pending:
                return

    def used_undeclared(self) -> list[str]:
        """Return names that are read and that no file declares."""
        return [name for name in self._used if name not in self.declared]

    def early(self, entry: str) -> list[str]:
        """Return names that the entry's root element reads."""
        tree = self._trees.get(entry)
        texts = tree.root.attributes.values() if tree else ()
        return [name for text in texts for name in _ARG.findall(text)]

    def argument(self, name: str) -> LaunchArgument:
        """Return all about one of them."""
        declared = self.declared.get(name)
        default = declared.text if declared else None
        shown = self._value_of(name) or ""
        used = self._used.get(name)
        place = declared.place if declared else used.element.place if used else Place("")
        annotation = declared.annotation if declared else NOTHING
        return LaunchArgument(
            name=name,
            place=place,
            default=default,
            shown=shown,
            widget=self._widget(name, default or "", shown, annotation),
            is_file=bool(PurePath(shown).suffix) and "/" in shown,
            in_macro=used is not None and _in_macro(used.element),
            is_early=used is not None and used.element.parent is None,
        )

    def _parsed(self, path: str) -> SourceTree | None:
        try:
            tree = parse_source(path, self._world.read(path))
        except (PackageError, SourceError):
            return None
        sites = xml_sites(tree).sites
        for site in sites:
            if site.kind is SiteKind.ARG:
                declared = _Declared(site.place, site.text, site.annotation)
                self.declared.setdefault(site.name, declared)
        for text in islice(_texts_of(tree), max(0, _TEXTS - len(self._texts))):
            self._note(text)
        return tree

    def _note(self, text: _Text) -> None:
        element = text.element
        if "$" not in text.text:
            if element.tag == "xacro:property" and text.attribute in {"value", "default"}:
                self._literals.setdefault(element.attributes.get("name", ""), text.text)
            return
        self._texts.append(text)
        for name in _ARG.findall(text.text):
            known = self._used.get(name)
            if known is None or (_in_macro(known.element) and not _in_macro(element)):
                self._used[name] = text
        alias = _ALIAS.fullmatch(text.text.strip())
        held = _holder(text)
        if alias and held:
            source = alias["arg"] or self._alias.get(alias["name"])
            if source:
                self._alias.setdefault(held, source)

    def _included(self) -> Iterator[str]:
        for tree in [one for one in self._trees.values() if one]:
            for element in tree.elements:
                written = element.attributes.get("filename", "")
                if element.tag != "xacro:include" or not written:
                    continue
                path = self._resolve(written, tree.path)
                if path:
                    yield str(PurePath(tree.path).parent / path.removeprefix("file://"))

    def _resolve(
        self, text: str, path: str, known: Mapping[str, str] | None = None, depth: int = 0
    ) -> str | None:
        """Return a text's value as far as finding packages, args and plain properties give it."""
        parts: list[str] = []
        at = 0
        for found in _SUBSTITUTION.finditer(text):
            value = self._substituted(found, path, known or {}, depth)
            if value is None:
                return None
            parts += [text[at : found.start()], value]
            at = found.end()
        parts.append(text[at:])
        made = "".join(parts)
        return None if "$" in made else made

    def _substituted(
        self, found: re.Match[str], path: str, known: Mapping[str, str], depth: int
    ) -> str | None:
        if package := found["find"] or found["package"]:
            return self._world.find(package, path)
        name = found["arg"] or self._alias.get(found["name"], "")
        if name in known:
            return known[name]
        if name:
            return self._value_of(name, depth + 1)
        return self._literals.get(found["name"])

    def _value_of(self, name: str, depth: int = 0) -> str | None:
        if name in self._arguments:
            return self._arguments[name]
        declared = self.declared.get(name)
        if declared is None or depth > _DEPTH:
            return None
        return self._resolve(declared.text, declared.place.file, depth=depth)

    def _widget(self, name: str, text: str, shown: str, annotation: Annotation) -> Widget:
        texts = [one for one in self._compared_with(name) if one]
        widget = infer_widget(name, text, shown, annotation, (), texts)
        if annotation.gives_range:
            return widget
        folders = common(self._folder_choices(name))
        if parse_number(shown) is not None:
            folders = tuple(one for one in folders if parse_number(one) is not None)
        if len(folders) > 1 or (folders and not text):
            return replace(widget, kind=WidgetKind.CHOICE, choices=folders)
        if widget.choices == (shown,):  # compared with what it is anyway
            return replace(widget, kind=WidgetKind.TEXT, choices=())
        if not shown and widget.kind is WidgetKind.TEXT and self._is_truth(name):
            return replace(widget, kind=WidgetKind.SWITCH)
        return widget

    def _means(self, named: Named | None, name: str) -> bool:
        if named is None:
            return False
        return named.name == name if named.is_arg else self._alias.get(named.name) == name

    def _compared_with(self, name: str) -> tuple[str, ...]:
        found = {
            text: None
            for one in self._texts
            for named, text in compared(one.text)
            if self._means(named, name)
        }
        return tuple(found)[:CHOICES_KEPT]

    def _is_truth(self, name: str) -> bool:
        return any(
            one.element.tag in _CONDITIONS and self._means(truth(one.text), name)
            for one in self._texts
        )

    def _folder_choices(self, name: str) -> Iterator[tuple[str, ...]]:
        seen: set[str] = set()
        for one in self._texts:
            for path in paths_in(one.text, is_filename=one.attribute == "filename"):
                if path in seen:
                    continue
                seen.add(path)
                for named, at in reads(path):
                    if self._means(named, name):
                        yield self._leading(path, at, name, one.element.tree.path)

    def _leading(self, path: str, at: re.Match[str], name: str, file: str) -> tuple[str, ...]:
        def resolve(text: str, value: str | None) -> str | None:
            return self._resolve(text, file, {} if value is None else {name: value})

        return folder_choices(path, at, resolve, self._world)


def _texts_of(tree: SourceTree) -> Iterator[_Text]:
    for element in tree.elements:
        for attribute, text in element.attributes.items():
            yield _Text(text, element, attribute)
        for child in element.children:
            if isinstance(child, SourceText) and "$" in child.text:
                yield _Text(child.text, element, "")


def _holder(text: _Text) -> str:
    """Return the property or macro parameter that a text gives its value."""
    element = text.element
    if element.tag == "xacro:property":
        return element.attributes.get("name", "")
    return text.attribute if element.tag.startswith("xacro:") else ""


def _in_macro(element: SourceElement) -> bool:
    above: SourceElement | None = element
    while above is not None:
        if above.tag == "xacro:macro":
            return True
        above = above.parent
    return False
