"""The problems of a document, by what found them."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Final

from studio.problems import Problem, Severity
from studio.protocol.edits import Problems

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from studio.documents.runs import LastRun
    from studio.protocol.listeners import Audience


OF_A_CODE = 500
"""Limit of the findings of one code: a large robot may have the same fault everywhere."""
_ORIGINS: Final = ("packages", "expansion", "robot", "mesh", "checks", "validation")
"""The order of origins; any other one comes after these."""
_RANK = {Severity.ERROR: 0, Severity.WARNING: 1, Severity.INFO: 2}


class Findings:
    """Problems by origin (`expansion`, `robot`, `mesh` ...): each origin replaces its own.

    Args:
        audience: Is sent all problems whenever one came or went.
        last_run: Knows whether the robot is older than the texts.
    """

    def __init__(self, audience: Audience, last_run: LastRun) -> None:
        self._audience, self._last_run = audience, last_run
        self._by_origin: dict[str, tuple[Problem, ...]] = dict.fromkeys(_ORIGINS, ())

    def replace(self, origin: str, problems: Iterable[Problem]) -> bool:
        """Set all that `origin` finds now; returns whether that changed anything."""
        found = tuple(problems)
        if found == self._by_origin.get(origin, ()):
            return False
        self._by_origin[origin] = found
        self.send()
        return True

    def all(self) -> tuple[Problem, ...]:
        """Return every problem once: errors first, then by origin, each in its own order."""
        distinct = dict.fromkeys(problem for found in self._by_origin.values() for problem in found)
        kept = _bounded(distinct)
        return tuple(sorted(kept, key=lambda problem: _RANK[problem.severity]))

    def send(self) -> None:
        """Send all problems."""
        self._audience.send(self.event())

    def event(self) -> Problems:
        """Return all problems, and whether the robot is older than the texts."""
        last = self._last_run
        return Problems(
            problems=self.all(), showing_last_good=last.failed and last.expansion is not None
        )


def _bounded(problems: Iterable[Problem]) -> Iterator[Problem]:
    """Yield the first problems of each code, and a problem with the number left out."""
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
