"""TopicsNow: the topics published at one moment, for displays whose topic nobody publishes."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Protocol

from studio.displays.catalogue import displays_of_type

if TYPE_CHECKING:
    from collections.abc import Sequence

    from studio.displays.display import Display
    from studio.live.topics.source import Topic


class HasCatalogue(Protocol):
    """The part of a topic source that lists topics."""

    def catalogue(self) -> Sequence[Topic]:
        """Return all topics by name."""
        ...


class TopicsNow:
    """Asks the source for all its topics once, and only if a display lacks its own."""

    def __init__(self, source: HasCatalogue) -> None:
        self._source = source

    def instead_of(self, topic: str, display: Display) -> str:
        """Return the topic that a display may show instead; empty: there is none.

        One with the same last name is the best, as of another namespace; else the first that is not
        hidden.
        """
        roles = display.roles()
        if not roles:
            return ""
        types = frozenset(roles[0].types)
        last = topic.rpartition("/")[2]
        fitting = [name for name, sent in self._sent if self._is_shown(name, sent & types, display)]
        return min(
            fitting,
            key=lambda name: (name.rpartition("/")[2] != last, "/_" in name, name),
            default="",
        )

    @cached_property
    def _sent(self) -> list[tuple[str, frozenset[str]]]:
        """The topics that are published, and the types of those who publish them."""
        found = (
            (one.name, frozenset(each.type_name for each in one.publishers))
            for one in self._source.catalogue()
        )
        return [(name, types) for name, types in found if types]

    def _is_shown(self, name: str, types: frozenset[str], display: Display) -> bool:
        """Whether the display shows one of the types under such a name."""
        return any(type(display) in displays_of_type(one, name) for one in types)
