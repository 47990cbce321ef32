"""A source of topics in memory: what tests publish on it comes at once, in the same thread."""

from __future__ import annotations

import itertools
import time
from collections import deque
from typing import TYPE_CHECKING

from typing_extensions import override

from studio.errors import RosNameError, UnknownTypeError
from studio.live.topics.request import Endpoint
from studio.live.topics.shared_source import SharedSource
from studio.live.topics.source import Topic
from studio.ros.attachment import Attachment
from studio.ros.messages import shared_types
from studio.ros.names import check_full_name
from studio.ros.node.samples import RawSample
from studio.ros.node.topic_statistics import Arrivals
from studio.ros.qos import DurabilityPolicy, QoSProfile
from tests.support.display_messages import NOW_NS

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from studio.live.topics.request import Fit
    from studio.live.topics.source import Connection
    from studio.live.topics.subscription import Stream, Subscription
    from studio.ros.node.topic_statistics import Flow
    from studio.ros.types.library import TypeLibrary

_PUBLISHERS = itertools.count(1)


class MemoryPublisher:
    """Publishes on one topic of a source; of a latched one it keeps what it said."""

    def __init__(self, source: MemorySource, topic: str, offer: Endpoint, gid: bytes) -> None:
        self._source, self.topic, self.offer = source, topic, offer
        self.gid = gid or b"%016d" % next(_PUBLISHERS)
        self._numbers = itertools.count(1)
        is_latched = offer.qos.durability is DurabilityPolicy.TRANSIENT_LOCAL
        self.kept: deque[RawSample] = deque(maxlen=offer.qos.depth if is_latched else 0)

    def say(self, payload: bytes, at_ns: int = NOW_NS, *, skipping: int = 0) -> None:
        """Publish a message, received at a time; before it so many are lost on their way."""
        for _ in range(skipping):
            next(self._numbers)
        sample = RawSample(payload, Attachment(next(self._numbers), at_ns, self.gid), at_ns)
        self.kept.append(sample)
        self._source.deliver(self, sample)

    def leave(self) -> None:
        """Publish no more."""
        self._source.forget(self)


class MemorySubscription:
    """What a stream has subscribed: it is told at once what latched publishers keep."""

    def __init__(self, source: MemorySource, topic: str, fit: Fit, stream: Stream) -> None:
        self._source, self.topic, self.fit, self._stream = source, topic, fit, stream
        self.depth = fit.depth
        self._last: dict[bytes, int] = {}
        self.lost = 0
        self.is_read_whole = True
        self.is_hurried = False

    def tell_kept(self) -> None:
        """Give what latched publishers said before, as much of each as is deep."""
        for one in self._source.speakers(self.topic):
            if self.fit.latched and one.offer.type_name == self.fit.type_name:
                for sample in list(one.kept)[-self.depth :]:
                    self._stream.take([sample], 1, len(sample.payload))

    def receive(self, sample: RawSample) -> None:
        """Give one sample."""
        sequence, _, sender = sample.attachment
        self.lost += max(0, sequence - self._last.get(sender, sequence - 1) - 1)
        self._last[sender] = sequence
        self._stream.take([sample], 1, len(sample.payload))

    def read(self, *, newest_only: bool) -> None:
        self.is_read_whole = not newest_only

    def hurry(self, *, wanted: bool) -> None:
        self.is_hurried = wanted

    def deepen(self, depth: int, swapped: Callable[[], object]) -> None:
        self.depth = depth
        swapped()
        self.tell_kept()

    def close(self) -> None:
        self._source.opened.remove(self)


class MemoryMeter:
    """Counts what is published on a topic, until nobody asked for so long."""

    def __init__(self, kept_s: float) -> None:
        self._kept_s, self._asked_s = kept_s, time.monotonic()
        self._arrivals = Arrivals(time.monotonic_ns())
        self.is_open = True

    def flow(self) -> Flow:
        self._asked_s = time.monotonic()
        return self._arrivals.flow(time.monotonic_ns())

    def count(self, payload: bytes) -> None:
        """Count one message, or end for want of questions."""
        if time.monotonic() - self._asked_s > self._kept_s:
            self.close()
        else:
            self._arrivals.count(time.monotonic_ns(), 1, len(payload))

    def close(self) -> None:
        self.is_open = False


class MemorySource(SharedSource):
    """Connected from the beginning; everything happens in the thread that asks for it."""

    def __init__(self, types: TypeLibrary | None = None) -> None:
        super().__init__()
        self._types = types or shared_types()
        self._connection: Connection = "there"
        self._publishers: list[MemoryPublisher] = []
        self._meters: dict[str, MemoryMeter] = {}
        self.opened: list[MemorySubscription] = []
        """What is subscribed now."""
        self.asked: list[tuple[str, Fit]] = []
        """All that ever was subscribed."""
        self.before_opening: Callable[[], None] = lambda: None

    def offer(
        self,
        topic: str,
        type_name: str,
        qos: QoSProfile | None = None,
        *,
        node: str = "/talker",
        gid: bytes = b"",
        type_hash: str | None = None,
    ) -> MemoryPublisher:
        """Let somebody publish a topic from now on."""
        known = self.own_hash(type_name) or "RIHS01_unknown"
        offer = Endpoint(node, False, type_name, type_hash or known, qos or QoSProfile(depth=10))
        made = MemoryPublisher(self, topic, offer, gid)
        self._publishers.append(made)
        self.refit()
        return made

    def say(self, topic: str, payload: bytes, gid: bytes = b"\x00" * 16) -> None:
        """Publish on a topic by whoever has the GID, or somebody whom nobody knows."""
        found = [one for one in self.speakers(topic) if one.gid == gid]
        if found:
            found[0].say(payload)
            return
        sample = RawSample(payload, Attachment(1, NOW_NS, gid), NOW_NS)
        for one in tuple(self.opened):
            if one.topic == topic:
                one.receive(sample)

    def forget(self, publisher: MemoryPublisher) -> None:
        """Let somebody publish no more."""
        self._publishers.remove(publisher)
        self.refit()

    def connect(self, connection: Connection = "there") -> None:
        """Be connected, or not; a connection that was ended is another one afterwards."""
        with self.fitting:
            if connection == "none":
                self.end_all()
            if "none" in (connection, self._connection):
                self.change_epoch()
            self._connection = connection
        self.refit()

    def speakers(self, topic: str) -> list[MemoryPublisher]:
        """Who publishes a topic."""
        return [one for one in self._publishers if one.topic == topic]

    def deliver(self, publisher: MemoryPublisher, sample: RawSample) -> None:
        """Give a sample to those who subscribed its topic and type."""
        if self._connection == "there":
            if meter := self._meters.get(publisher.topic):
                meter.count(sample.payload)
            for one in tuple(self.opened):
                if (one.topic, one.fit.type_name) == (publisher.topic, publisher.offer.type_name):
                    one.receive(sample)

    @property
    @override
    def types(self) -> TypeLibrary:
        return self._types

    @property
    @override
    def connection(self) -> Connection:
        return self._connection

    @override
    def catalogue(self) -> list[Topic]:
        names = sorted({one.topic for one in self._publishers})
        found = ((name, tuple(self.publishers(name))) for name in names)
        return [
            Topic(name, tuple(sorted({one.type_name for one in offers})), offers, ())
            for name, offers in found
        ]

    @override
    def publishers(self, topic: str) -> Sequence[Endpoint]:
        if self._connection != "there":
            return ()
        return [one.offer for one in self.speakers(topic)]

    @override
    def senders(self, topic: str) -> frozenset[bytes]:
        return frozenset(one.gid for one in self.speakers(topic))

    @override
    def sender(self, gid: bytes) -> str | None:
        return next((one.offer.node for one in self._publishers if one.gid == gid), None)

    @override
    def own_hash(self, type_name: str) -> str | None:
        try:
            return self._types.hash_of(type_name)
        except (UnknownTypeError, RosNameError):
            return None

    @override
    def open(self, topic: str, fit: Fit, stream: Stream) -> MemorySubscription:
        self.before_opening()
        check_full_name(topic)
        if fit.type_hash is None and self.own_hash(fit.type_name) is None:
            raise UnknownTypeError(fit.type_name, "no known package defines it")
        made = MemorySubscription(self, topic, fit, stream)
        self.opened.append(made)
        self.asked.append((topic, fit))
        made.tell_kept()
        return made

    @override
    def measure(self, topic: str, kept_s: float) -> MemoryMeter | None:
        if not self.publishers(topic):
            return None
        made = self._meters[topic] = MemoryMeter(kept_s)
        return made

    @override
    def refit(self) -> None:
        self.fit_all()

    @override
    def hand_over(self, subscription: Subscription) -> None:
        subscription.hand_over()
