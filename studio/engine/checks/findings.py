"""What is wrong with a document now, by who found it."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

from studio.problems import Problem, Severity

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

OF_A_CODE = 500
"""So many findings of one code are told: a large robot may have the same fault everywhere."""
_RANK = {Severity.ERROR: 0, Severity.WARNING: 1, Severity.INFO: 2}


class Findings:
    """Problems by origin (`expansion`, `robot`, `mesh:<uri>` ...): each origin heals its own."""

    def __init__(self) -> None:
        self._by_origin: dict[str, tuple[Problem, ...]] = {}

    def replace(self, origin: str, problems: Iterable[Problem]) -> bool:
        """Set all that `origin` finds now; answers whether that changed anything."""
        found = tuple(problems)
        if found == self._by_origin.get(origin, ()):
            return False
        self._by_origin[origin] = found
        return True

    def keep_only(self, prefix: str, origins: Iterable[str]) -> bool:
        """Drop the origins that start with `prefix` and are not in `origins`."""
        kept = set(origins)
        gone = [
            origin
            for origin, found in self._by_origin.items()
            if origin.startswith(prefix) and origin not in kept and found
        ]
        for origin in gone:
            del self._by_origin[origin]
        return bool(gone)

    def all(self) -> tuple[Problem, ...]:
        """Every problem once, errors first, else in the order in which they were found."""
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
