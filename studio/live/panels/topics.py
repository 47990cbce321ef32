"""The topics, their endpoints, and why endpoints do not match."""

from __future__ import annotations

import asyncio
import itertools
from typing import TYPE_CHECKING, Final, Protocol

from studio.live.connection.topic_kinds import carried_types, kind_for
from studio.protocol.commands import Commands, Scope
from studio.protocol.topics import (
    GetTopicEnds,
    ListTopics,
    Misfit,
    TopicEnd,
    TopicEnds,
    TopicRow,
    TopicTable,
    Way,
)
from studio.ros.profiles import NO_HASH
from studio.ros.qos import QoSProfile, why_unmatched

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from studio.live.connection.link import WireLink
    from studio.live.connection.ros_connection import RosConnection
    from studio.ros.duration import Duration
    from studio.ros.graph.endpoints import GraphEndpoint

ENDS_MAX: Final = 100
"""Endpoints listed of one side; `/rosout` has one for every node."""
MISFITS_MAX: Final = 20


class OffersQos(Protocol):
    """An endpoint."""

    @property
    def type_name(self) -> str:
        """Of its messages."""
        ...

    @property
    def type_hash(self) -> str:
        """As its token has it."""
        ...

    @property
    def qos(self) -> QoSProfile:
        """How it publishes or subscribes."""
        ...


class AnswersTopics(Protocol):
    """A system whose topics are asked for."""

    async def topics(self, command: ListTopics, /) -> TopicTable:
        """Return every topic."""
        ...

    def ends(self, command: GetTopicEnds, /) -> TopicEnds:
        """Return who is at the ends of a topic; raises a StudioError."""
        ...


class LiveTopics:
    """The topics of the system that the studio is connected with."""

    def __init__(self, connection: RosConnection) -> None:
        self._connection = connection

    async def topics(self, command: ListTopics, /) -> TopicTable:
        """Return every topic; without a connection there is none."""
        return await topic_table(self._connection, command)

    def ends(self, command: GetTopicEnds, /) -> TopicEnds:
        """Return who is at the ends of a topic; errors as for `topic_ends`."""
        return topic_ends(self._connection, command)


async def topic_table(connection: RosConnection, command: ListTopics) -> TopicTable:
    """Return every topic; without a connection there is none."""
    link = connection.current
    rows = await asyncio.to_thread(_rows, link) if link else ()
    return TopicTable(request=command.request, topics=rows)


def topic_ends(connection: RosConnection, command: GetTopicEnds) -> TopicEnds:
    """Return who is at the ends of a topic.

    Raises:
        RosNameError: No topic is named so.
    """
    link = connection.current
    publishers = link.graph.publishers(command.topic) if link else []
    subscribers = link.graph.subscriptions(command.topic) if link else []
    own = link.zid if link else ""
    announcing = link.graph.announcing if link else frozenset[str]()
    return TopicEnds(
        request=command.request,
        publishers=tuple(_end(one, own) for one in publishers[:ENDS_MAX]),
        subscribers=tuple(_end(one, own) for one in subscribers[:ENDS_MAX]),
        misfits=_misfits(publishers[:ENDS_MAX], subscribers[:ENDS_MAX], announcing),
    )


def _rows(link: WireLink) -> tuple[TopicRow, ...]:
    found: list[TopicRow] = []
    for name, types in link.graph.topics():
        published, subscribed = link.graph.publishers(name), link.graph.subscriptions(name)
        # A user asked for what the studio publishes; what it subscribes only serves to show it.
        publishers, subscribers = len(published), _others(subscribed, link.zid)
        if publishers or subscribers:
            carried = carried_types(published, subscribed)
            found.append(
                TopicRow(
                    name=name,
                    types=(*carried, *(one for one in types if one not in carried)),
                    publishers=publishers,
                    subscribers=subscribers,
                    kind=kind_for(name, carried),
                )
            )
    return tuple(found)


def _others(ends: Iterable[GraphEndpoint], own_zid: str) -> int:
    """Count the endpoints that are not the studio's own."""
    return sum(one.node.zid != own_zid for one in ends)


def _end(endpoint: GraphEndpoint, own_zid: str) -> TopicEnd:
    node = endpoint.node
    return end_of(node.path, endpoint, own=node.zid == own_zid, bridge=node.bridge)


def end_of(node: str, endpoint: OffersQos, *, own: bool, bridge: str = "") -> TopicEnd:
    """Return the view of an endpoint of a node, which may be behind a bridge to DDS."""
    qos = endpoint.qos
    return TopicEnd(
        node=node,
        own=own,
        bridge=bridge,
        type_name=endpoint.type_name,
        reliability=_policy(qos.reliability.name),
        durability=_policy(qos.durability.name),
        history=_policy(qos.history.name),
        depth=qos.depth,
        deadline_s=_seconds(qos.deadline),
        lifespan_s=_seconds(qos.lifespan),
        liveliness=_policy(qos.liveliness.name),
        lease_s=_seconds(qos.liveliness_lease_duration),
        hash=endpoint.type_hash,
    )


def _policy(name: str) -> str:
    """Return a policy's value as `ros2 topic info` does, in lower case."""
    return name.lower().replace("_", " ")


def _seconds(span: Duration) -> float | None:
    """Return seconds; None stands for no bound."""
    return span.nanoseconds / 1e9 if span.nanoseconds else None


def _misfits(
    publishers: Sequence[GraphEndpoint],
    subscribers: Sequence[GraphEndpoint],
    announcing: frozenset[str],
) -> tuple[Misfit, ...]:
    """Return pairs that do not fit; those without a way last, as there may be very many."""
    pairs: list[tuple[GraphEndpoint, GraphEndpoint, Way]] = [
        (one, other, _way(one, other, announcing)) for one in publishers for other in subscribers
    ]
    pairs.sort(key=lambda pair: pair[2] == "none")
    found = (misfit for pair in pairs if (misfit := _misfit(*pair)))
    return tuple(itertools.islice(found, MISFITS_MAX))


def _misfit(publisher: GraphEndpoint, subscriber: GraphEndpoint, way: Way) -> Misfit | None:
    if way == "none":
        return Misfit(
            publisher=publisher.node.path,
            subscriber=subscriber.node.path,
            reasons=(),
            heard=False,
            way=way,
        )
    deaf = _why_deaf(publisher, subscriber, way)
    unmatched = (
        _why_late(publisher, subscriber)
        if way == "bridge"
        else why_unmatched(publisher.qos, subscriber.qos)
    )
    if not deaf and not unmatched:
        return None
    return Misfit(
        publisher=publisher.node.path,
        subscriber=subscriber.node.path,
        reasons=(*deaf, *unmatched),
        heard=not deaf and way != "dds",
        way=way,
    )


def _way(publisher: GraphEndpoint, subscriber: GraphEndpoint, announcing: frozenset[str]) -> Way:
    """Return how messages go from one to the other.

    Args:
        publisher: Of a topic.
        subscriber: Of the same.
        announcing: Sessions that bridges to DDS hear of, of those that are not on DDS.
    """
    nodes = publisher.node, subscriber.node
    on_zenoh = [one for one in nodes if not one.bridge]
    if len(on_zenoh) == 2:
        return "zenoh"
    if on_zenoh:
        return "bridge" if on_zenoh[0].zid in announcing else "none"
    return "dds" if nodes[0].zid == nodes[1].zid else "bridge"


def _why_late(publisher: GraphEndpoint, subscriber: GraphEndpoint) -> list[str]:
    """Return what a bridge does not make up for.

    On DDS it takes the QoS of whom it meets there, and on Zenoh all is heard: so only earlier
    messages, which a volatile publisher does not keep, are missing.
    """
    offered = QoSProfile(depth=1, durability=publisher.qos.durability)
    return why_unmatched(offered, QoSProfile(depth=1, durability=subscriber.qos.durability))


def _why_deaf(publisher: GraphEndpoint, subscriber: GraphEndpoint, way: Way) -> list[str]:
    """Return what keeps them from matching, whatever their QoS.

    Keys of rmw_zenoh have type and hash. On DDS only names are compared, what comes in another
    form is misread, and nodes before Iron tell no hash.
    """
    if publisher.type_name != subscriber.type_name:
        return [f"one sends {publisher.type_name}, the other wants {subscriber.type_name}"]
    untold = set[str]() if way == "zenoh" else {"", NO_HASH}
    if len({publisher.type_hash, subscriber.type_hash} - untold) > 1:
        return [
            f"their {publisher.type_name} are of different forms: they come from different "
            "distributions or versions of its package"
        ]
    return []


COMMANDS: Final = Commands[AnswersTopics](Scope.ROS)
COMMANDS.viewer(ListTopics, lambda one, c, _: one.topics(c), same_for_all=True)
COMMANDS.viewer(GetTopicEnds, lambda one, c, _: one.ends(c), same_for_all=True)
