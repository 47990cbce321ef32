"""What the checks examine: the robot of a run, and the texts that it came from."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from studio.description.evaluator.output_tree import macro_calls, part_keys
from studio.problems import Problem, Severity

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from studio.description.evaluator.graph import Binding
    from studio.description.evaluator.output_tree import OutputElement
    from studio.description.syntax.source_tree import SourceElement, SourceTree
    from studio.problems import Fix, Place


@dataclass(frozen=True)
class CheckedRun:
    """One run; `chain_to` returns how a file came to be included."""

    root: OutputElement
    trees: Mapping[str, SourceTree]
    bindings: Sequence[Binding]
    chain_to: Callable[[str], tuple[Place, ...]]

    @cached_property
    def keys(self) -> dict[OutputElement, str]:
        """The key of each part, by its element, in the order of the robot."""
        return {element: key for key, element in part_keys(self.root)}

    def problem(
        self,
        severity: Severity,
        code: str,
        sentence: str,
        at: OutputElement,
        fix: Fix | None = None,
        parts: tuple[str, ...] = (),
    ) -> Problem:
        """Return a finding at an element that came out."""
        place = at.origin.place
        calls = macro_calls(at.calls)
        return Problem(
            severity, code, sentence, place, self.chain_to(place.file), calls, fix, parts
        )

    def note(self, code: str, sentence: str, at: SourceElement, fix: Fix | None = None) -> Problem:
        """Return a finding of little weight at an element as it is written."""
        chain = self.chain_to(at.place.file)
        return Problem(Severity.INFO, code, sentence, at.place, chain, fix=fix)
