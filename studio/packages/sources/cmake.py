"""A CMakeLists.txt as it is written: its commands with their arguments and bytes, up to a fault."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Final

from studio.packages.sources.spans import SourceText

if TYPE_CHECKING:
    from collections.abc import Iterator

FILE_NAME: Final = "CMakeLists.txt"
CALLS_MAX: Final = 20_000
_PROJECT_VARIABLES: Final = re.compile(
    r"\$\{(PROJECT_NAME|CMAKE_PROJECT_NAME|CATKIN_PACKAGE_NAME)\}"
)
_CATKIN_FOLDERS: Final = (
    ("${CATKIN_PACKAGE_SHARE_DESTINATION}", "share/${PROJECT_NAME}"),
    ("${CATKIN_PACKAGE_BIN_DESTINATION}", "lib/${PROJECT_NAME}"),
)
_INSTALLED: Final = ("DIRECTORY", "FILES", "PROGRAMS", "TARGETS")
_ENDS: Final = (
    *("DESTINATION", "PATTERN", "REGEX", "EXPORT", "ARCHIVE", "LIBRARY", "RUNTIME"),
    *("INCLUDES", "OPTIONAL", "RENAME", "PERMISSIONS", "USE_SOURCE_PERMISSIONS"),
    *("FILES_MATCHING", "COMPONENT", "EXCLUDE", "CONFIGURATIONS"),
)
_TOKEN: Final = re.compile(
    rb"""(?P<bracket>\#?\[=*\[)
    |(?P<comment>\#[^\n]*)
    |(?P<string>"(?:\\.|[^"\\])*")
    |(?P<open>\()|(?P<close>\))
    |(?P<blank>\s+)
    |(?P<word>(?:\\.|\$\{[^}\s]*\}|[^\s()"\#\\])+)
    |(?P<other>.)""",
    re.DOTALL | re.VERBOSE,
)


@dataclass(frozen=True, slots=True)
class Argument:
    """One argument: `value` without its quotes, variables as written."""

    value: str
    start: int
    end: int
    is_quoted: bool


@dataclass(frozen=True, slots=True)
class Call:
    """One command. `name` is in small letters, `end` behind its parenthesis."""

    name: str
    arguments: tuple[Argument, ...]
    start: int
    open: int
    """Where its parenthesis begins."""
    end: int
    line: int

    @property
    def values(self) -> tuple[str, ...]:
        """Its arguments as texts."""
        return tuple(one.value for one in self.arguments)

    def after(self, keyword: str, *others: str) -> tuple[Argument, ...]:
        """Return the arguments behind a keyword, as far as one of the others."""
        found: list[Argument] = []
        is_after = False
        for one in self.arguments:
            if not one.is_quoted and one.value in (keyword, *others):
                is_after = one.value == keyword
            elif is_after:
                found.append(one)
        return tuple(found)


class CMakeLists:
    """The commands of a CMakeLists.txt; nothing is evaluated.

    Args:
        file: Its path.
        data: Its bytes.
        package: The name of its package, where `project()` gives none.
    """

    def __init__(self, file: str, data: bytes, package: str = "") -> None:
        self._package = package
        self.source = SourceText(file, data)
        self.calls: list[Call] = []
        self.fault = ""
        """Why the rest was not read, as the end of a sentence."""
        self.fault_line = 0
        self.fault_call: tuple[str, int] | None = None
        """Name and start of a command that is not closed."""
        for call in _calls(self):
            self.calls.append(call)
            if len(self.calls) > CALLS_MAX:
                self.fault = "has more commands than any package needs"
                self.fault_line = call.line
                break

    def of(self, *names: str) -> list[Call]:
        """Return the calls of these commands."""
        return [one for one in self.calls if one.name in names]

    @cached_property
    def project(self) -> Argument | None:
        """The name that `project()` gives."""
        named = (one.arguments[0] for one in self.of("project") if one.arguments)
        return next(named, None)

    @cached_property
    def found_packages(self) -> dict[str, Call]:
        """The packages of `find_package`, with the first call of each."""
        found: dict[str, Call] = {}
        for one in self.of("find_package"):
            if one.arguments:
                found.setdefault(one.arguments[0].value, one)
        return found

    def plain(self, text: str) -> str:
        """Put the project's name in the place of the variables that hold it."""
        name = self.project.value if self.project else self._package
        for variable, folder in _CATKIN_FOLDERS:
            text = text.replace(variable, folder)
        return _PROJECT_VARIABLES.sub(lambda found: name or found[0], text)

    def installs(self) -> Iterator[tuple[str, str, Call]]:
        """Yield what is installed: (its kind, one name, the call), as DIRECTORY or FILES."""
        for call in self.of("install", "catkin_install_python"):
            for kind in _INSTALLED:
                others = (*(one for one in _INSTALLED if one != kind), *_ENDS)
                for argument in call.after(kind, *others):
                    yield kind, self.plain(argument.value), call

    def destinations(self, call: Call) -> tuple[str, ...]:
        """Return the folders that a call installs to, below the prefix: `share/my_package`."""
        named = call.after("DESTINATION", *_INSTALLED, *_ENDS[1:])
        return tuple(self.plain(one.value).strip("/") for one in named)


def _calls(lists: CMakeLists) -> Iterator[Call]:
    """Yield each whole call; the first that is not closed is the fault."""
    source = lists.source
    word: re.Match[bytes] | None = None
    name, start, opened, depth = "", 0, 0, 0
    arguments: list[Argument] = []
    for kind, token in _tokens(source.data):
        if kind == "blank":
            continue
        if depth == 0:
            if kind == "open" and word is not None:
                name, start, opened = (
                    word[0].decode("utf-8", "replace"),
                    word.start(),
                    token.start(),
                )
                depth, arguments, word = 1, [], None
            else:
                word = token if kind == "word" else None
        elif kind == "open":
            depth += 1
        elif kind == "close":
            depth -= 1
            if depth == 0:
                line = source.line_of(start)
                yield Call(name.lower(), tuple(arguments), start, opened, token.end(), line)
        else:
            arguments.append(_argument(token, source))
    if depth:
        lists.fault = f"{name}( is not closed"
        lists.fault_line = source.line_of(start)
        lists.fault_call = (name.lower(), start)


def _tokens(data: bytes) -> Iterator[tuple[str, re.Match[bytes]]]:
    """Yield each token but comments; what stands in long brackets is passed over as one blank."""
    at, unclosed = 0, set[bytes]()
    while at < len(data) and (token := _TOKEN.match(data, at)):
        kind, at = token.lastgroup or "other", token.end()
        if kind == "bracket":
            closing = token[0].lstrip(b"#").replace(b"[", b"]")
            # None that is looked for in vain is looked for again: a text of these alone is slow.
            end = -1 if closing in unclosed else data.find(closing, at)
            if end < 0:
                unclosed.add(closing)
            at = end + len(closing) if end >= 0 else at
            kind = "blank"
        if kind != "comment":
            yield kind, token


def _argument(token: re.Match[bytes], source: SourceText) -> Argument:
    text = source.slice(token.start(), token.end())
    is_quoted = token["string"] is not None
    value = text[1:-1] if is_quoted else text
    return Argument(value, token.start(), token.end(), is_quoted)
