"""TopicsNow: what is published at one moment, for displays whose topic nobody publishes."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Protocol

from studio.displays.catalogue import displays_of_type

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from studio.displays.display import Display
    from studio.ros.graph.endpoints import GraphEndpoint


class KnowsTopics(Protocol):
    """What is needed of the graph."""

    def topics(self) -> Sequence[tuple[str, Sequence[str]]]:
        """All names with the types of both ends."""
        ...

    def publishers(self, topic: str) -> Sequence[GraphEndpoint]:
        """Those of a topic."""
        ...


class TopicsNow:
    """Asks the graph for all its topics once, and only if a display lacks its own."""

    def __init__(self, graph: KnowsTopics) -> None:
        self._graph = graph

    def instead_of(self, topic: str, display: Display) -> str:
        """The topic that a display may listen to instead; empty: nobody publishes what it shows.

        One of the same last name is the best, as of another namespace; else the first that is not
        hidden.
        """
        roles = display.roles()
        if not roles:
            return ""
        types = frozenset(roles[0].types)
        last = topic.rpartition("/")[2]
        fitting = [name for name, those in self._topics if not types.isdisjoint(those)]
        fitting.sort(key=lambda name: (name.rpartition("/")[2] != last, "/_" in name, name))
        shown = (name for name in fitting if self._is_shown(name, display, types))
        return next(shown, "")

    @cached_property
    def _topics(self) -> tuple[tuple[str, Sequence[str]], ...]:
        return tuple(self._graph.topics())

    def _is_shown(self, name: str, display: Display, types: Iterable[str]) -> bool:
        """Whether somebody publishes it in a type that the display shows under such a name."""
        sent = {one.type_name for one in self._graph.publishers(name)}
        return any(type(display) in displays_of_type(one, name) for one in sent.intersection(types))
