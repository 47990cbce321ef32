"""The package that a check gets, and how a finding and its mend are made.

A file of this folder with a function `findings(checked: CheckedPackage) -> Iterator[Problem]` is a
check: `package_checks` finds it by that name. Its `WHY` explains each of its codes to the user.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from difflib import get_close_matches
from functools import cached_property
from itertools import islice
from typing import TYPE_CHECKING, Final

from studio.packages.inspection.inspecting import launch_format
from studio.packages.sources.interfaces import interface_files
from studio.packages.sources.topic_ends import topic_ends
from studio.problems import Fix, Place, Problem, Severity

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from studio.packages.known import Known
    from studio.packages.sources.package_source import PackageSource
    from studio.packages.sources.python_file import PythonFile
    from studio.packages.sources.spans import SourceText
    from studio.packages.sources.topic_ends import TopicEnd
    from studio.problems import NewFile, Replacement

ERROR: Final = Severity.ERROR
WARNING: Final = Severity.WARNING
INFO: Final = Severity.INFO
_PYTHON_FILES_MAX: Final = 300
_PUBLISHERS_MAX: Final = 2_000
"""Of one package."""
_WORD_MAX: Final = 100
_WORDS_MAX: Final = 3_000
"""To find a misspelt word among these takes 50 ms at most."""


@dataclass(frozen=True)
class CheckedWorkspace:
    """The packages that are checked together: what is known of all is found once.

    Attributes:
        packages: All packages of the workspace by their names.
        known: What ROS and the studio have.
    """

    packages: Mapping[str, PackageSource]
    known: Known

    @cached_property
    def types(self) -> dict[str, frozenset[str]]:
        """The full names of types by their package: of its source if it is in the workspace."""
        found = dict(self.known.types_by_package)
        for name, source in self.packages.items():
            own = frozenset(
                f"{name}/{one.removesuffix(f'.{kind}')}" for kind, one in interface_files(source)
            )
            if own:
                found[name] = own
        return found

    @cached_property
    def publishers(self) -> dict[str, list[TopicEnd]]:
        """The publishers of all packages by their topics."""
        found: dict[str, list[TopicEnd]] = defaultdict(list)
        for source in self.packages.values():
            files = CheckedPackage(source, self).python_files
            ends = (one for python in files for one in topic_ends(python) if one.publishes)
            for one in islice(ends, _PUBLISHERS_MAX):
                found[one.topic].append(one)
        return found


@dataclass(frozen=True)
class CheckedPackage:
    """One package of a workspace.

    Attributes:
        source: Its files.
        workspace: It and the packages beside it.
    """

    source: PackageSource
    workspace: CheckedWorkspace

    @property
    def packages(self) -> Mapping[str, PackageSource]:
        """All packages of the workspace by their names, this one too."""
        return self.workspace.packages

    @property
    def known(self) -> Known:
        """What ROS and the studio have."""
        return self.workspace.known

    def has_package(self, name: str) -> bool:
        """Whether the workspace or ROS has a package."""
        return name in self.packages or self.known.has_package(name)

    def types_of(self, package: str) -> frozenset[str]:
        """Return the full names of a package's types."""
        return self.workspace.types.get(package, frozenset())

    def packages_with_type(self, kind: str, name: str) -> list[str]:
        """Return the packages that have a type of that name, those of the workspace first."""
        types = self.workspace.types.items()
        found = [one for one, names in types if f"{one}/{kind}/{name}" in names]
        return sorted(found, key=lambda one: (one not in self.packages, one))

    @cached_property
    def python_files(self) -> tuple[PythonFile, ...]:
        """Its Python files but setup.py, launch files and tests."""
        return self._parsed(
            one
            for one in self.source.below("", ".py")
            if one != "setup.py"
            and not one.startswith(("test/", "tests/", "launch/"))
            and not launch_format(one)
        )

    @cached_property
    def launch_files(self) -> tuple[PythonFile, ...]:
        """Its launch files in Python."""
        return self._parsed(one for one in self.source.below("", ".py") if launch_format(one))

    def _parsed(self, names: Iterable[str]) -> tuple[PythonFile, ...]:
        files = map(self.source.python, islice(names, _PYTHON_FILES_MAX))
        return tuple(one for one in files if one is not None)


def found(
    severity: Severity,
    code: str,
    sentence: str,
    text: SourceText | str,
    at: int = 0,
    fix: Fix | None = None,
) -> Problem:
    """Return a finding at a byte of a text, or at a file as a whole."""
    place = Place(text) if isinstance(text, str) else text.place(at)
    return Problem(severity, code, sentence, place, fix=fix)


def edit(label: str, *edits: Replacement, new_files: tuple[NewFile, ...] = ()) -> Fix:
    """Return a fix that is these changes."""
    return Fix(label, "edit", edits=edits, new_files=new_files)


def safely(label: str, change: Callable[[], Iterable[Replacement]]) -> Fix | None:
    """Return a fix of changes that may refuse a broken file; None if they do, or change nothing."""
    try:
        edits = tuple(change())
    except ValueError:
        return None
    return edit(label, *edits) if edits else None


def meant(word: str, known: Iterable[str], cutoff: float = 0.8) -> str:
    """Return the known word that a misspelt one is closest to; empty if none is close."""
    if len(word) > _WORD_MAX:
        return ""
    alike = get_close_matches(word, list(islice(known, _WORDS_MAX)), n=1, cutoff=cutoff)
    return alike[0] if alike and alike[0] != word else ""
