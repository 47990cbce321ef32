"""What is wrong with a document now, by who found it."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Final

from studio.problems import Problem, Severity

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

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
    for code, count in counts.items():
        if count > OF_A_CODE:
            more = f"{count - OF_A_CODE} more findings are like this one: {last[code].sentence}"
            yield Problem(last[code].severity, code, more)
