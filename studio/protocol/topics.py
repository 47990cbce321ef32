"""Messages about topics: which there are, and who is at both ends of one."""

from __future__ import annotations

from typing import Literal

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


class Misfit(Message):
    """A publisher and a subscription that would not meet on DDS."""

    publisher: str
    subscriber: str
    reasons: tuple[str, ...]
    heard: bool
    """On Zenoh the messages come all the same; other types or hashes keep them apart there, too."""


class TopicEnds(Event):
    """Answer to `get_topic_ends`."""

    type: Literal["topic_ends"] = "topic_ends"
    request: int
    publishers: tuple[TopicEnd, ...]
    subscribers: tuple[TopicEnd, ...]
    misfits: tuple[Misfit, ...]
