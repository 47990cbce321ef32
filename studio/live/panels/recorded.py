"""RecordedSystem: what panels see of the ROS system that a recording is of."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Final

from studio.errors import CommandError
from studio.live.connection.topic_kinds import kind_for
from studio.live.panels.diagnostics import PartDiagnostics
from studio.live.panels.graph import node_answer
from studio.live.panels.logs import NodeLogs
from studio.live.panels.topics import ENDS_MAX, end_of
from studio.live.topics.source import decoder
from studio.protocol.graph import LINKS_MAX, GraphAnswer, GraphLinkView, GraphNodeView
from studio.protocol.parameters import ParameterNodes, Parameters
from studio.protocol.topics import TopicEnds, TopicRow, TopicTable
from studio.ros.names import is_hidden

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from studio.live.time.recording_source import RecordingSource
    from studio.protocol.changes import Subject
    from studio.protocol.graph import GetGraph, GetNode, NodeAnswer
    from studio.protocol.parameters import GetParameterNodes, GetParameters, ParameterView
    from studio.protocol.topics import GetTopicEnds, ListTopics
    from studio.ros.types.classes import MessageValue

_EVENTS: Final = "/parameter_events"
_EVENT_TYPE: Final = "rcl_interfaces/msg/ParameterEvent"
_EVENTS_MAX: Final = 5_000


class RecordedSystem:
    """As long as a document shows a recording; a bag says nothing of nodes but what they sent.

    Args:
        source: The recording where it stands.
        changed: Told what changed, in a thread of the source.
    """

    def __init__(self, source: RecordingSource, changed: Callable[[Subject], object]) -> None:
        self.source = source
        self.logs = NodeLogs(source, lambda: changed("log"))
        self.diagnostics = PartDiagnostics(source, lambda: changed("diagnostics"))
        self.graph, self.parameters = RecordedGraph(source), RecordedParameters(source)

    def close(self) -> None:
        """Receive no more."""
        self.logs.close()
        self.diagnostics.close()

    async def topics(self, command: ListTopics) -> TopicTable:
        """Return every topic."""
        rows = await asyncio.to_thread(lambda: tuple(self._rows()))
        return TopicTable(request=command.request, topics=rows)

    def ends(self, command: GetTopicEnds) -> TopicEnds:
        """Return how a topic was published."""
        publishers = self.source.publishers(command.topic)[:ENDS_MAX]
        return TopicEnds(
            request=command.request,
            publishers=tuple(end_of(one.node, one, own=False) for one in publishers),
            subscribers=(),
            misfits=(),
        )

    def _rows(self) -> Iterator[TopicRow]:
        for one in self.source.catalogue():
            yield TopicRow(
                name=one.name,
                types=one.types,
                publishers=len(one.publishers),
                subscribers=0,
                kind=kind_for(one.name, one.types),
            )


class RecordedGraph:
    """Of who was there a bag knows only what was published."""

    def __init__(self, source: RecordingSource) -> None:
        self._source = source

    async def graph(self, command: GetGraph) -> GraphAnswer:
        """Return the bag as one node that publishes all; nothing if that is known."""
        topics = self._source.catalogue() if command.known else []
        nodes = tuple(
            GraphNodeView(name=one.publishers[0].node, count=1, own=False) for one in topics[:1]
        )
        links = tuple(
            GraphLinkView(
                kind="topic",
                name=one.name,
                types=one.types,
                sources=(0,),
                targets=(),
                hidden=is_hidden(one.name),
            )
            for one in topics[:LINKS_MAX]
        )
        return GraphAnswer(
            request=command.request,
            version=0,
            nodes=nodes,
            links=links,
            other_count=len(nodes),
            more=max(0, len(topics) - LINKS_MAX),
        )

    async def node(self, command: GetNode) -> NodeAnswer:
        """Return the topics of the bag."""
        topics = [one for one in self._source.catalogue() if one.publishers[0].node == command.name]
        parts = {"publishers": [(one.name, one.types[0]) for one in topics]}
        return node_answer(command, int(bool(topics)), parts)


class RecordedParameters:
    """Parameters of nodes as far as their changes were recorded."""

    def __init__(self, source: RecordingSource) -> None:
        self._source = source

    async def nodes(self, command: GetParameterNodes) -> ParameterNodes:
        """Return the nodes whose parameters changed while it was recorded, up to the moment."""
        events = await asyncio.to_thread(self._events)
        nodes = tuple(sorted({str(one.node) for one in events}))
        return ParameterNodes(request=command.request, nodes=nodes)

    async def parameters(self, command: GetParameters) -> Parameters:
        """Return the parameters of a node as far as its events say them.

        Raises:
            CommandError: None of it is recorded.
        """
        node = f"/{command.node.removeprefix('/')}"
        found = await asyncio.to_thread(self._parameters, node)
        if found is None:
            raise CommandError(f"No change of a parameter of {node} is recorded up to this moment.")
        views = tuple(view for _, view in sorted(found.items()))
        return Parameters(request=command.request, node=node, parameters=views)

    def _events(self) -> list[MessageValue]:
        decode, recording = decoder(self._source, _EVENT_TYPE), self._source.recording
        return [decode(one) for one in recording.last(_EVENTS, self._source.now_ns, _EVENTS_MAX)]

    def _parameters(self, node: str) -> dict[str, ParameterView] | None:
        from studio.live.panels.parameter_work import changed_view  # noqa: PLC0415 - zenoh

        events = [one for one in self._events() if str(one.node) == node]
        found: dict[str, ParameterView] = {}
        for event in events:
            for one in (*event.new_parameters, *event.changed_parameters):
                found[str(one.name)] = changed_view(one)
            for one in event.deleted_parameters:
                found.pop(str(one.name), None)
        return found if events else None
