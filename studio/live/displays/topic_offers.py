"""TopicOffers: the displays and topics that there are, and which display shows each."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Final

from studio.live.displays.plugins import Plugins
from studio.protocol.commands import Commands, Scope
from studio.protocol.displays import DisplayKinds, GetDisplayKinds, GetTopics, Topics

if TYPE_CHECKING:
    from studio.live.connection.ros_connection import RosConnection
    from studio.live.topics.source import TopicSource


class TopicOffers:
    """Answers which topics there are, by the connection that there is, or in what is recorded."""

    def __init__(self, wire: RosConnection, source: TopicSource) -> None:
        self._wire, self._source = wire, source
        self.plugins = Plugins()
        """Displays of the owner's own."""

    def kinds(self, command: GetDisplayKinds) -> DisplayKinds:
        """Return the kinds of displays."""
        from studio.live.displays.catalogue_views import kind_views  # noqa: PLC0415 - imports all

        return DisplayKinds(
            request=command.request,
            kinds=kind_views(self.plugins.kinds()),
            plugin_faults=self.plugins.faults(),
        )

    async def topics(self, command: GetTopics) -> Topics:
        """Return the topics; none without a connection."""
        link = self._wire.current
        if link is None and self._source.is_live:
            return Topics(request=command.request, topics=())
        from studio.live.displays.topic_views import topic_views  # noqa: PLC0415 - imports all

        found = await asyncio.to_thread(topic_views, self._source, self.plugins.kind_of_type)
        return Topics(request=command.request, topics=found)


COMMANDS: Final = Commands[TopicOffers](Scope.DOCUMENT)
COMMANDS.viewer(GetDisplayKinds, lambda offers, c, _: offers.kinds(c), same_for_all=True)
COMMANDS.viewer(GetTopics, lambda offers, c, _: offers.topics(c), same_for_all=True)


def full_name(topic: str) -> str:
    """Return a topic as the graph names it."""
    topic = topic.strip()
    return f"/{topic}" if topic and topic[0] not in "/~" else topic
