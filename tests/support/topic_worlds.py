"""Sources of topics, each with what tests publish on it: in memory, and on a real router."""

from __future__ import annotations

from abc import ABC, abstractmethod
from contextlib import contextmanager
from typing import TYPE_CHECKING

from typing_extensions import override

from studio.live.connection.link import WireLink
from studio.live.topics.zenoh_source import ZenohSource
from studio.ros.cdr import codec_of
from studio.ros.messages import message
from studio.settings import WireChoice
from tests.support.demos import node_at
from tests.support.memory_source import MemorySource

if TYPE_CHECKING:
    from collections.abc import Callable, Generator

    from studio.live.topics.shared_source import SharedSource
    from studio.ros.client import Node, Publisher, QoSProfile
    from tests.support.memory_source import MemoryPublisher

STRING, BOOL = "std_msgs/msg/String", "std_msgs/msg/Bool"


def text_payload(text: str) -> bytes:
    """A `std_msgs/msg/String` as CDR."""
    return bytes(codec_of(message(STRING)).encode(message(STRING)(data=text)))


def text_of(payload: bytes) -> str:
    """What is in it."""
    return codec_of(message(STRING)).decode(payload).data


class Speaker(ABC):
    """Somebody who publishes texts on one topic."""

    @abstractmethod
    def say(self, text: str) -> None:
        """Publish a text."""

    @abstractmethod
    def leave(self) -> None:
        """Publish no more."""


class World(ABC):
    """A source that is connected, and who publishes there."""

    source: SharedSource

    @abstractmethod
    def speaker(self, topic: str, qos: QoSProfile, type_name: str = STRING) -> Speaker:
        """Let somebody publish."""

    @abstractmethod
    def depths(self, topic: str) -> list[int]:
        """Of the subscriptions of a topic, as those see them who publish."""

    @abstractmethod
    def connect(self) -> None:
        """Connect the source."""

    @abstractmethod
    def disconnect(self) -> None:
        """End its connection."""


class MemoryWorld(World):
    """All in memory."""

    def __init__(self) -> None:
        self.source = self._source = MemorySource()

    @override
    def speaker(self, topic: str, qos: QoSProfile, type_name: str = STRING) -> Speaker:
        return _MemorySpeaker(self._source.offer(topic, type_name, qos))

    @override
    def depths(self, topic: str) -> list[int]:
        return [one.depth for one in self._source.opened if one.topic == topic]

    @override
    def connect(self) -> None:
        self._source.connect()

    @override
    def disconnect(self) -> None:
        self._source.connect("none")


class _MemorySpeaker(Speaker):
    def __init__(self, publisher: MemoryPublisher) -> None:
        self._publisher = publisher

    @override
    def say(self, text: str) -> None:
        self._publisher.say(text_payload(text))

    @override
    def leave(self) -> None:
        self._publisher.leave()


class ZenohWorld(World):
    """A node of another session at a router, and the studio's own connection with it."""

    def __init__(self, endpoint: str, node: Node) -> None:
        self._endpoint, self._node = endpoint, node
        self.source = self._source = ZenohSource()
        self._link: WireLink | None = None

    @override
    def speaker(self, topic: str, qos: QoSProfile, type_name: str = STRING) -> Speaker:
        made = self._node.create_publisher(message(type_name), topic, qos)
        return _NodeSpeaker(made, lambda: self._node.destroy_publisher(made))

    @override
    def depths(self, topic: str) -> list[int]:
        return [one.qos.depth for one in self._node.graph.subscriptions(topic)]

    @override
    def connect(self) -> None:
        self._link = WireLink(WireChoice("off", (self._endpoint,)), self._source.refit)
        self._source.attach(self._link)

    @override
    def disconnect(self) -> None:
        self._source.detach()
        link, self._link = self._link, None
        if link is not None:
            link.close()

    def close(self) -> None:
        """End everything."""
        self.disconnect()
        self._source.close()


class _NodeSpeaker(Speaker):
    def __init__(self, publisher: Publisher, leave: Callable[[], object]) -> None:
        self._publisher, self._leave = publisher, leave

    @override
    def say(self, text: str) -> None:
        self._publisher.publish(message(STRING)(data=text))

    @override
    def leave(self) -> None:
        self._leave()


@contextmanager
def zenoh_world(endpoint: str) -> Generator[ZenohWorld]:
    """Connected, until the block ends."""
    with node_at(endpoint, "speaker") as node:
        world = ZenohWorld(endpoint, node)
        world.connect()
        try:
            yield world
        finally:
            world.close()
