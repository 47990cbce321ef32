"""The last run that gave a robot, kept so that questions about it can be answered."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from studio.description.output_tree import OutputElement
    from studio.description.run_record import RunRecord


@dataclass(frozen=True, slots=True)
class GoodRun:
    """What a run read and what came out of it; the texts may have changed since."""

    root: OutputElement
    record: RunRecord
    evaluator: str
    """As in `Expansion`."""
