"""Messages about topics: which there are, and who is at both ends of one."""

from __future__ import annotations

from typing import Literal, TypeAlias

from studio.protocol.displays import RosName
from studio.protocol.message import Command, Event, Message


class ListTopics(Command):
    """Ask for the topics that have a publisher or a subscription."""

    type: Literal["list_topics"] = "list_topics"


class GetTopicEnds(Command):
    """Ask who publishes a topic and who subscribes to it, how, and what keeps them apart."""

    type: Literal["get_topic_ends"] = "get_topic_ends"
    topic: RosName


class TopicRow(Message):
    """One topic; the studio's own subscriptions are not counted."""

    name: str
    types: tuple[str, ...]
    """The types of publishers first, then those that only subscriptions have."""
    publishers: int
    subscribers: int
    kind: str
    """The display that shows it; empty: none does."""


class TopicTable(Event):
    """Answer to `list_topics`."""

    type: Literal["topic_table"] = "topic_table"
    request: int
    topics: tuple[TopicRow, ...]


class TopicEnd(Message):
    """A publisher or a subscription."""

    node: str
    """Full name of its node."""
    own: bool
    """Whether it is the studio's."""
    bridge: str
    """The bridge to DDS that its node is behind; empty: it is not on DDS."""
    type_name: str
    reliability: str
    durability: str
    history: str
    depth: int
    deadline_s: float | None
    lifespan_s: float | None
    liveliness: str
    lease_s: float | None
    hash: str
    """Empty: its node is on DDS and does not tell it, so only the name of its type is compared."""


Way: TypeAlias = Literal["zenoh", "bridge", "dds", "none"]
"""How messages go from a publisher to a subscription. `bridge`: one of them is on DDS, or each
behind a bridge of its own; `dds`: both are, behind the same bridge; `none`: one is on DDS, and the
other of rmw_zenoh, which bridges do not hear of."""


class Misfit(Message):
    """A publisher and a subscription that do not fit each other, or would not on DDS."""

    publisher: str
    subscriber: str
    reasons: tuple[str, ...]
    """Empty where there is no way between them."""
    heard: bool
    """The messages come all the same: by Zenoh, or by a bridge, which brings no earlier ones."""
    way: Way


class TopicEnds(Event):
    """Answer to `get_topic_ends`."""

    type: Literal["topic_ends"] = "topic_ends"
    request: int
    publishers: tuple[TopicEnd, ...]
    subscribers: tuple[TopicEnd, ...]
    misfits: tuple[Misfit, ...]
