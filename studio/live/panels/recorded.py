"""RecordedSystem: what panels see of the ROS system that a recording is of."""

from __future__ import annotations

import asyncio
import threading
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
            GraphNodeView(name=one.publishers[0].node, count=1, own=False, bridge="")
            for one in topics[:1]
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
    """Parameters of nodes as far as their changes were recorded.

    What was read up to a moment is kept: where time went on since, only what came meanwhile is
    read.
    """

    def __init__(self, source: RecordingSource) -> None:
        self._source = source
        self._decode = decoder(source, _EVENT_TYPE)
        self._reading = threading.Lock()
        self._read_ns = -1
        """The moment up to which events were read; -1: not yet."""
        self._nodes: dict[str, dict[str, ParameterView]] = {}

    async def nodes(self, command: GetParameterNodes) -> ParameterNodes:
        """Return the nodes whose parameters changed while it was recorded, up to the moment."""
        nodes = await asyncio.to_thread(self._node_names)
        return ParameterNodes(request=command.request, nodes=nodes)

    async def parameters(self, command: GetParameters) -> Parameters:
        """Return the parameters of a node as far as its events say them.

        Raises:
            CommandError: None of it is recorded.
        """
        node = f"/{command.node.removeprefix('/')}"
        views = await asyncio.to_thread(self._views, node)
        if views is None:
            raise CommandError(f"No change of a parameter of {node} is recorded up to this moment.")
        return Parameters(request=command.request, node=node, parameters=views)

    def _node_names(self) -> tuple[str, ...]:
        with self._reading:
            self._read()
            return tuple(sorted(self._nodes))

    def _views(self, node: str) -> tuple[ParameterView, ...] | None:
        with self._reading:
            self._read()
            found = self._nodes.get(node)
            return None if found is None else tuple(view for _, view in sorted(found.items()))

    def _read(self) -> None:
        """Read what came since the last time; from the beginning after a jump back."""
        now_ns = self._source.now_ns
        if now_ns == self._read_ns:
            return
        goes_on = 0 <= self._read_ns < now_ns
        since_ns = self._read_ns + 1 if goes_on else 0
        samples = self._source.recording.last(_EVENTS, now_ns, _EVENTS_MAX, since_ns)
        events = [self._decode(one) for one in samples]
        if not goes_on or len(events) == _EVENTS_MAX:  # what lies between may say otherwise
            self._nodes.clear()
        for event in events:
            self._apply(event)
        self._read_ns = now_ns

    def _apply(self, event: MessageValue) -> None:
        from studio.live.panels.parameter_work import changed_view  # noqa: PLC0415 - zenoh

        found = self._nodes.setdefault(str(event.node), {})
        for one in (*event.new_parameters, *event.changed_parameters):
            found[str(one.name)] = changed_view(one)
        for one in event.deleted_parameters:
            found.pop(str(one.name), None)
