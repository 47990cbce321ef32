"""A Problem: what is wrong, where, and what mends it, as every room reports it."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from importlib import import_module
from pkgutil import iter_modules
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator
    from types import ModuleType


class Severity(StrEnum):
    """How serious a Problem is.

    An error keeps the last good model, or ROS rejects the robot for it; a warning does neither, and
    something will not work as it is written; the rest is worth knowing.
    """

    ERROR = "error"
    WARNING = "warning"
    INFO = "info"


@dataclass(frozen=True, slots=True)
class Place:
    """A place in a source file; `line` and `column` are 1-based, 0 when not known."""

    file: str
    line: int = 0
    column: int = 0

    def __str__(self) -> str:
        """Write `file:line:column`, as far as it is known."""
        parts = [self.file, *(str(n) for n in (self.line, self.column) if n)]
        return ":".join(parts)


@dataclass(frozen=True, slots=True)
class MacroCall:
    """One macro call on the way to a place: its name and where it was called."""

    macro: str
    called_at: Place


@dataclass(frozen=True, slots=True)
class Replacement:
    """Replaces the bytes [start, end) of an edited file, which are `before`, by `text`.

    Both are raw text, escaped as in the file. `before` is never empty: an insertion repeats a text
    beside it, so that a place that has moved is noticed.
    """

    file: str
    start: int
    end: int
    before: str
    text: str


@dataclass(frozen=True, slots=True)
class NewFile:
    """A file that an edit makes, with its whole text; nothing bears that name yet."""

    file: str
    text: str


@dataclass(frozen=True, slots=True)
class Fix:
    """One click that mends a Problem: `action` names it, `target` is what it works on.

    Actions: `choose_package` (target: package name), `undo` (target: empty),
    `open_file` (target: path), `resolve_collisions` (target: path of the file), `give_arguments`
    (target: empty), `edit` (all of `edits` and `new_files`, as one undo step that bears the label).
    """

    label: str
    action: str
    target: str = ""
    edits: tuple[Replacement, ...] = ()
    new_files: tuple[NewFile, ...] = ()


@dataclass(frozen=True, slots=True)
class Problem:
    """One finding. `sentence` stands alone; `code` is stable, kebab-case, for tests and tools.

    `include_chain` runs from the opened file down to (not including) `place`; `macro_stack` from
    the outermost call to the innermost. `parts` are the parts of the robot to show, by part key:
    `link:<name>`, `joint:<name>`.
    """

    severity: Severity
    code: str
    sentence: str
    place: Place | None = None
    include_chain: tuple[Place, ...] = ()
    macro_stack: tuple[MacroCall, ...] = ()
    fix: Fix | None = None
    parts: tuple[str, ...] = ()

    def __str__(self) -> str:
        """Write the sentence behind its place."""
        return f"{self.place}: {self.sentence}" if self.place else self.sentence


def whys(*checks: ModuleType) -> dict[str, dict[str, str]]:
    """Return why a finding matters, by its code and by language: the `WHY` of every check.

    Args:
        checks: Packages whose files are checks.
    """
    modules = (module for package in checks for module in modules_of(package))
    return {code: why for one in modules for code, why in getattr(one, "WHY", {}).items()}


def modules_of(package: ModuleType) -> Iterator[ModuleType]:
    """Import every file of a package, in the order of their names."""
    return (
        import_module(f"{package.__name__}.{one.name}") for one in iter_modules(package.__path__)
    )
