"""How much one run may cost."""

from __future__ import annotations

from dataclasses import dataclass
from time import perf_counter
from typing import TYPE_CHECKING, Any, Final

from studio.description.faults import Refusal

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

_CLOCK_EVERY: Final = 256
"""Steps between two looks at the clock."""


@dataclass(frozen=True, slots=True)
class Limits:
    """Bounds of one run; the largest real robot (100 files) needs 1 % of each."""

    macro_depth: int = 200
    elements: int = 200_000
    evaluations: int = 2_000_000
    seconds: float = 2.0


class Budget:
    """Counts one run. Every step is an evaluated text, an element, or one turn of a loop."""

    __slots__ = ("_elements", "_ends_at", "_evaluations", "limits")

    def __init__(self, limits: Limits) -> None:
        self.limits = limits
        self._elements = self._evaluations = 0
        self._ends_at = perf_counter() + limits.seconds

    def restart(self) -> None:
        """Count anew, for an edit of what came out."""
        self._elements = self._evaluations = 0
        self._ends_at = perf_counter() + self.limits.seconds

    def element(self) -> None:
        """One element came out.

        Raises:
            Refusal: There are too many, or the time is over.
        """
        self._elements += 1
        if self._elements > self.limits.elements:
            raise Refusal(
                "too-many-elements", f"It makes more than {self.limits.elements:,} elements."
            )
        if not self._elements % _CLOCK_EVERY:
            self._look_at_clock()

    def evaluation(self) -> None:
        """One text is evaluated; raises as `element`."""
        self._evaluations += 1
        if not self._evaluations % _CLOCK_EVERY:
            self._look_at_clock()
            if self._evaluations > self.limits.evaluations:
                raise Refusal(
                    "too-many-evaluations",
                    f"It evaluates more than {self.limits.evaluations:,} expressions.",
                )

    def steps(self, items: Iterable[Any]) -> Iterator[Any]:
        """The items of a loop inside an expression, each counted."""
        for item in items:
            self.evaluation()
            yield item

    def depth(self, depth: int, macro: str) -> None:
        """A macro is called inside `depth - 1` others.

        Raises:
            Refusal: That is too deep; it most likely calls itself without end.
        """
        if depth > self.limits.macro_depth:
            raise Refusal(
                "macro-recursion",
                f'The macro "{macro}" is called inside more than {self.limits.macro_depth} others: '
                "it calls itself without end.",
            )

    def _look_at_clock(self) -> None:
        if perf_counter() > self._ends_at:
            raise Refusal(
                "expansion-too-slow",
                f"The expansion takes longer than {self.limits.seconds:g} s and was ended.",
            )
