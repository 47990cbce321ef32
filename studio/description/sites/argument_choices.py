"""What values an argument may have, told from the texts alone: comparisons and folders."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, Protocol

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

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


class Folders(Protocol):
    """The file system as far as it may be seen; what lies outside is not there."""

    def names(self, folder: str) -> tuple[str, ...]:
        """What a folder holds; nothing when it is none."""
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
    """Each name that a text compares with a literal, and the literal."""
    for inside in _INSIDE.finditer(text):
        body = inside[1] or inside[2] or ""
        for pattern in _COMPARISONS:
            for found in pattern.finditer(body):
                yield _named(found), found["literal"][1:-1]
        for found in _MEMBERSHIP.finditer(body):
            for quoted in _QUOTED.finditer(found["list"]):
                yield _named(found), quoted[1] or quoted[2] or ""


def truth(text: str) -> Named | None:
    """The one name whose truth a condition asks for."""
    found = _TRUTH.fullmatch(text.strip())
    return Named(found[1] or found[2], bool(found[1])) if found else None


def paths_in(text: str, *, is_filename: bool) -> Iterator[str]:
    """What in a text may be a path: all of it, or what is quoted in its expressions."""
    if is_filename or _PATH.match(text):
        yield text
    elif "$(find" in text:
        for quoted in _QUOTED.finditer(text):
            inside = quoted[1] or quoted[2] or ""
            if _PATH.match(inside):
                yield inside


def reads(path: str) -> Iterator[tuple[Named, re.Match[str]]]:
    """Every name that stands in a path, and where."""
    for found in _READ.finditer(path):
        yield Named(found[1] or found[2], bool(found[1])), found


def folder_choices(
    path: str, at: re.Match[str], resolve: Callable[[str, str | None], str | None], folders: Folders
) -> tuple[str, ...]:
    """The values for which a path leads somewhere.

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
    """What all say that say something; what the first says when they agree on nothing."""
    said = [one for one in found if one]
    if not said:
        return ()
    agreed = tuple(value for value in said[0] if all(value in one for one in said))
    return agreed or said[0]


def _named(found: re.Match[str]) -> Named:
    return Named(found["arg"] or found["name"], bool(found["arg"]))


def _between(
    name: str, begin: str, end: str, resolve: Callable[[str, str | None], str | None]
) -> str:
    """What stands in a file name between its known begin and end; empty when it has others."""
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
