"""What the named texts of a run shape: through other named texts down to what came out."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

if TYPE_CHECKING:
    from studio.description.graph import Consumer
    from studio.description.run_record import Binding, Input

CONSUMERS_KEPT: Final = 8


class Links(NamedTuple):
    """What reads one input: `reads` counts texts, of the consumers there are the first few."""

    reads: int
    consumers: tuple[Consumer, ...]
    dependents: tuple[Binding, ...]
    """Named texts that were made from it."""


class Reach:
    """The links of one state of a graph, each looked up once."""

    def __init__(self) -> None:
        self._links: dict[Input, Links] = {}

    def links(self, one: Input) -> Links:
        """What reads an input."""
        links = self._links.get(one)
        if links is None:
            links = self._links[one] = _links_of(one)
        return links

    def consumers(self, start: Input, limit: int = CONSUMERS_KEPT) -> tuple[Consumer, ...]:
        """The attributes that an input shapes, through any number of properties, nearest first."""
        links = self.links(start)
        if len(links.consumers) >= limit or not links.dependents:
            return links.consumers[:limit]
        found: dict[Consumer, None] = {}
        seen: set[Input] = {start}
        front: list[Input] = [start]
        while front and len(found) < limit:
            reached: dict[Binding, None] = {}
            for one in front:
                links = self.links(one)
                found.update(dict.fromkeys(links.consumers))
                reached.update(dict.fromkeys(links.dependents))
            front = [one for one in reached if one not in seen]
            seen.update(front)
        return tuple(found)[:limit]


def _links_of(one: Input) -> Links:
    readings = one.readings
    consumers: dict[Consumer, None] = {}
    dependents: dict[Binding, None] = {}
    for record in readings:
        made = record.made
        if made is not None and made.binding is not None:
            dependents[made.binding] = None
        elif record.consumer is not None and len(consumers) < CONSUMERS_KEPT:
            consumers[record.consumer] = None
    return Links(len(readings), tuple(consumers), tuple(dependents))
