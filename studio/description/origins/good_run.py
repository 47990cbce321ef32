"""The last run that gave a robot, kept so that questions about it can be answered.

The graph of that run goes on to the next edit, and tells a block that came out twice as one. So a
question runs the same texts once more, watched, in `store`, which nobody edits.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from studio.description.origins.effects import Readers
from studio.description.origins.tracing import Trace, trace

if TYPE_CHECKING:
    from collections.abc import Mapping, Set

    from studio.description.evaluator.output_tree import OutputElement
    from studio.description.evaluator.run_record import RunRecord
    from studio.description.evaluator.source_store import SourceStore
    from studio.description.values import ReadPolicy


@dataclass(frozen=True)
class GoodRun:
    """What a run read and what came out of it; the session's texts may have changed since."""

    root: OutputElement
    record: RunRecord
    evaluator: str
    """As in `Expansion`."""
    entry: str
    arguments: Mapping[str, str]
    policy: ReadPolicy
    store: SourceStore
    """The texts as they were, for another run of them."""
    sites: Set[str]
    """Ids of the texts that can be edited."""

    @cached_property
    def trace(self) -> Trace:
        """The same run once more, with all that each thing was made of.

        Raises:
            Fault: It cannot be repeated: only stock xacro could expand it, or the disk changed.
        """
        return trace(self.store, self.policy, self.entry, self.arguments)

    @cached_property
    def readers(self) -> Readers:
        """Who reads what in it; raises as `trace`."""
        return Readers(self.trace)
