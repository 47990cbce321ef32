"""TopicOffers: the topics that there are, and which display shows each."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Final

from studio.protocol.commands import Commands, Scope
from studio.protocol.displays import GetTopics, Topics

if TYPE_CHECKING:
    from studio.live.connection.ros_connection import RosConnection


class TopicOffers:
    """Answers which topics there are, by the connection that there is."""

    def __init__(self, wire: RosConnection) -> None:
        self._wire = wire

    async def topics(self, command: GetTopics) -> Topics:
        """Return the topics; none without a connection."""
        link = self._wire.current
        if link is None:
            return Topics(request=command.request, topics=())
        from studio.live.displays.topic_views import topic_views  # noqa: PLC0415 - imports all

        found = await asyncio.to_thread(topic_views, link)
        return Topics(request=command.request, topics=found)


COMMANDS: Final = Commands[TopicOffers](Scope.DOCUMENT)
COMMANDS.viewer(GetTopics, lambda offers, c, _: offers.topics(c))


def first_topic(kind: str) -> str:
    """Return the topic of a new display of a kind.

    Raises:
        DisplayError: There is no such kind.
    """
    from studio.displays.catalogue import display_of_kind  # noqa: PLC0415 - imports all

    return display_of_kind(kind).FIRST_TOPIC


def full_name(topic: str) -> str:
    """Return a topic as the graph names it."""
    topic = topic.strip()
    return f"/{topic}" if topic and topic[0] not in "/~" else topic
