"""Topics as the page receives them, each with the display that shows it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.live.connection.topic_kinds import carried_types, kinds_for
from studio.protocol.displays import TopicView

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.live.topics.source import TopicSource


def topic_views(source: TopicSource, owns: Callable[[str], str]) -> tuple[TopicView, ...]:
    """Return the topics that have a publisher, by name; thread-safe.

    `owns` gives the owner's display of a type, which shows what none of the studio's does.
    """
    found: list[TopicView] = []
    for name, _, publishers, _ in source.catalogue():
        if publishers:
            types = carried_types(publishers, ())
            own = tuple(one for one in map(owns, types) if one)
            kinds = tuple(dict.fromkeys((*kinds_for(name, types), *own)))
            found.append(
                TopicView(
                    name=name,
                    types=types,
                    publishers=len(publishers),
                    kind=next(iter(kinds), ""),
                    kinds=kinds,
                )
            )
    return tuple(found)
