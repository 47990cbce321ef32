"""Topics as the page is told of them, each with the display that shows it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.displays.catalogue import displays_of_type
from studio.engine.messages.live import TopicView

if TYPE_CHECKING:
    from studio.engine.wire.link import WireLink


def topic_views(link: WireLink) -> tuple[TopicView, ...]:
    """Topics that somebody publishes, by name; any thread."""
    found: list[TopicView] = []
    for name, types in link.graph.topics():
        if publishers := len(link.graph.publishers(name)):
            kinds = [kind.KIND for one in types for kind in displays_of_type(one, name)]
            kind = kinds[0] if kinds else ""
            found.append(TopicView(name=name, types=tuple(types), publishers=publishers, kind=kind))
    return tuple(found)
