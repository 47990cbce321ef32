"""What the named texts of a run shape: through other named texts down to what came out."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

if TYPE_CHECKING:
    from studio.description.evaluator.graph import Consumer
    from studio.description.evaluator.run_record import Binding, Input

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
        self._consumers: dict[Input, tuple[Consumer, ...]] = {}

    def forget(self, one: Input) -> None:
        """Look at an input anew: it, or what is made of it, got or lost readers."""
        self._links.pop(one, None)
        self._consumers.pop(one, None)

    def links(self, one: Input) -> Links:
        """What reads an input."""
        links = self._links.get(one)
        if links is None:
            links = self._links[one] = _links_of(one)
        return links

    def consumers(self, start: Input) -> tuple[Consumer, ...]:
        """The attributes that an input shapes, through any number of properties, nearest first.

        Only the first few.
        """
        found = self._consumers.get(start)
        if found is None:
            found = self._consumers[start] = tuple(self._nearest(start))[:CONSUMERS_KEPT]
        return found

    def _nearest(self, start: Input) -> dict[Consumer, None]:
        """Consumers from the nearest on, until there are enough."""
        found: dict[Consumer, None] = {}
        seen: set[Input] = {start}
        front: list[Input] = [start]
        while front:
            reached: list[Input] = []
            for one in front:
                _, consumers, dependents = self._links.get(one) or self.links(one)
                if consumers:
                    found.update(dict.fromkeys(consumers))
                    if len(found) >= CONSUMERS_KEPT:
                        return found
                for dependent in dependents:
                    if dependent not in seen:
                        seen.add(dependent)
                        reached.append(dependent)
            front = reached
        return found


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
