"""Where a part comes from: the place that it is written at and what led there."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.description.output_tree import macro_calls
from studio.description.parts import part_keys
from studio.description.queries import NoReply, PartOrigin

if TYPE_CHECKING:
    from studio.description.good_run import GoodRun


def part_origin(run: GoodRun, part: str) -> PartOrigin | NoReply:
    """The place and macro calls of a part, by its key."""
    element = dict(part_keys(run.root)).get(part)
    if element is None:
        return NoReply(f'The robot has no part "{part}": it may be gone since.')
    return PartOrigin(part, element.origin.place, macro_calls(element.calls))
