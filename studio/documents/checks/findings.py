"""What is wrong with a document, by who found it, and the fixes that are edits."""

from __future__ import annotations

from collections import Counter
from itertools import count
from typing import TYPE_CHECKING, Final

from studio.description.editing.edits import apart, edits_of
from studio.description.editing.sources import Change
from studio.documents.texts import TEXT_LIMIT_BYTES
from studio.errors import CommandError, EditError, ReadOnlyTextError
from studio.problems import Problem, Severity

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from studio.documents.document import Document
    from studio.problems import Fix, Replacement


OF_A_CODE = 500
"""So many findings of one code are told: a large robot may have the same fault everywhere."""
_ORIGINS: Final = ("packages", "expansion", "robot", "mesh", "checks", "validation")
"""In the order in which they are told; any other origin comes after these."""
_RANK = {Severity.ERROR: 0, Severity.WARNING: 1, Severity.INFO: 2}


class Findings:
    """Problems by origin (`expansion`, `robot`, `mesh` ...): each origin heals its own."""

    def __init__(self) -> None:
        self._by_origin: dict[str, tuple[Problem, ...]] = dict.fromkeys(_ORIGINS, ())

    def replace(self, origin: str, problems: Iterable[Problem]) -> bool:
        """Set all that `origin` finds now; answers whether that changed anything."""
        found = tuple(problems)
        if found == self._by_origin.get(origin, ()):
            return False
        self._by_origin[origin] = found
        return True

    def all(self) -> tuple[Problem, ...]:
        """Every problem once: errors first, then by origin, each in its own order."""
        distinct = dict.fromkeys(problem for found in self._by_origin.values() for problem in found)
        kept = _bounded(distinct)
        return tuple(sorted(kept, key=lambda problem: _RANK[problem.severity]))


def _bounded(problems: Iterable[Problem]) -> Iterator[Problem]:
    """The first of each code; how many more there are is said behind them."""
    counts: Counter[str] = Counter()
    last: dict[str, Problem] = {}
    for problem in problems:
        counts[problem.code] += 1
        if counts[problem.code] <= OF_A_CODE:
            yield problem
            last[problem.code] = problem
    for code, number in counts.items():
        if number > OF_A_CODE:
            more = f"{number - OF_A_CODE} more findings are like this one: {last[code].sentence}"
            yield Problem(last[code].severity, code, more)


_MEND_ALL = "Mend all"


class Fixes:
    """Carries out fixes whose action is `edit`; the others are the page's."""

    def __init__(self, document: Document) -> None:
        self._document = document
        self._mended = count(1)

    async def apply(self, code: str, sentence: str, label: str) -> None:
        """Mend one problem, and show what that does.

        Raises:
            CommandError: It is no longer found, or its fix is no edit.
            StaleTextError: The text is another one by now.
            ReadOnlyTextError: A file may not be written.
        """
        for problem in self._document.board.found:
            fix = problem.fix
            if (problem.code, problem.sentence) == (code, sentence) and fix and fix.label == label:
                if not fix.edits:
                    break
                await self._edit(fix.edits, label)
                return
        raise CommandError("This problem is no longer found: look at the list again.")

    async def apply_all(self) -> None:
        """Mend every error and warning that an edit mends, in one step.

        Raises:
            CommandError: There is none.
            StaleTextError: The text is another one by now.
        """
        fixes = [fix.edits for fix in _fixes(self._document.board.found)]
        if not fixes:
            raise CommandError("Nothing that is found has a fix: mend it in the source.")
        await self._edit(apart(fixes), _MEND_ALL)

    async def _edit(self, replacements: Sequence[Replacement], label: str) -> None:
        sources, served = self._document.sources, self._document.location.served
        for file in {one.file for one in replacements}:
            if not served.may_write(file):
                raise ReadOnlyTextError(file, "it lies where the studio may only read.")
        edits = edits_of(replacements, sources.text)
        for edit in edits:
            if len(sources.text(edit.file)) + len(edit.new) > TEXT_LIMIT_BYTES:
                raise EditError(f"{edit.file} would grow too large: mend it by hand.")
        sources.edit_all(edits, label, f"fix {next(self._mended)}")
        await self._document.follow(Change(label, edits))


def _fixes(problems: Sequence[Problem]) -> Iterator[Fix]:
    """The fixes that are edits, of what hinders; several problems may share one."""
    fixes = (one.fix for one in problems if one.severity is not Severity.INFO)
    yield from dict.fromkeys(fix for fix in fixes if fix and fix.edits)
