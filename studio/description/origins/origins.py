"""Answer where the parts of a good run come from, and what its texts shape."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

from studio.description.evaluator.output_tree import part_keys
from studio.description.origins.effects import Readers
from studio.description.origins.provenance import part_origin
from studio.description.origins.tracing import Trace, trace
from studio.description.values import NoReply

if TYPE_CHECKING:
    from studio.description.evaluator.runs import GoodRun
    from studio.description.origins.origin_values import PartOrigin, SiteEffects


class Origins:
    """Answers questions about one good run. The first one runs its texts once more, traced.

    The run's own graph is no use: it continues with the next edit, and reports a block that came
    out twice as one. Both questions raise a Fault when the texts cannot be run once more: only
    stock xacro could expand them, or a file beside them changed.
    """

    def __init__(self, run: GoodRun) -> None:
        self._run = run

    def part(self, part: str) -> PartOrigin | NoReply:
        """Return where a part comes from, by its key."""
        if self._run.evaluator != "studio":
            return NoReply("xacro itself expanded this robot: where parts come from is not known.")
        element = dict(part_keys(self._trace.root)).get(part)
        if element is None:
            return NoReply(f'The robot has no part "{part}": it may be gone since.')
        return part_origin(part, element, self._trace, self._run.sites)

    def effects(self, site: str) -> SiteEffects | NoReply:
        """Return the effects of a text, by its site id."""
        if self._run.evaluator != "studio":
            return NoReply("xacro itself expanded this robot: what a text affects is not known.")
        if site not in self._run.sites:
            return NoReply("That text is no longer there: choose it again.")
        return self._readers.effects_of(site)

    @cached_property
    def _trace(self) -> Trace:
        run = self._run
        return trace(run.store, run.policy, run.entry, run.arguments)

    @cached_property
    def _readers(self) -> Readers:
        return Readers(self._trace)
