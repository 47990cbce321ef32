"""DocumentSource: the topics that a document shows: the live ones, or those of a recording."""

from __future__ import annotations

import threading
from contextlib import contextmanager
from typing import TYPE_CHECKING, Final

from studio.live.topics.request import SubscriptionState
from studio.live.topics.subscription import Subscription

if TYPE_CHECKING:
    from collections.abc import Callable, Generator, Iterable, Sequence

    from studio.live.topics.request import Endpoint, Request
    from studio.live.topics.shared_source import SharedSource
    from studio.live.topics.source import Connection, Topic
    from studio.ros.node.samples import RawSample
    from studio.ros.node.topic_statistics import Flow
    from studio.ros.types.library import TypeLibrary

_EPOCHS: Final = 1 << 32
"""More than any source has."""


class DocumentSource:
    """A TopicSource behind which another one can be put: every subscription goes on from there.

    Subscriptions are made at the source itself, so that no sample passes through here.

    Args:
        live: The topics of whatever the studio is connected with.
    """

    def __init__(self, live: SharedSource) -> None:
        self._live = self._current = live
        self._turn = threading.RLock()
        """Held while subscriptions are made or go elsewhere."""
        self._switches = 0
        self._subscriptions: dict[Subscription, None] = {}
        self.settling = threading.Lock()
        """Held while what all have been given is replaced by that of another moment."""

    @property
    def is_live(self) -> bool:
        """Implement `TopicSource.is_live`."""
        return self._current is self._live

    @property
    def current(self) -> SharedSource:
        """The source that it is now."""
        return self._current

    def show(self, source: SharedSource | None) -> None:
        """Take topics from another source from now on; None: from the live one. In a thread."""
        with self._turn, self.settling:
            before, self._current = self._current, source or self._live
            if before is self._current:
                return
            self._switches += 1
            subscriptions = tuple(self._subscriptions)
            for one in subscriptions:
                before.release(one)
                one.clear()
                one.beginnings += 1
                one.take_state(SubscriptionState(one.request.topic))
            for one in subscriptions:
                self._current.adopt(one)
        self._current.fit_all()

    @contextmanager
    def held(self) -> Generator[bool]:
        """Keep all at one moment within this block; whether that could be had at once."""
        has_it = self.settling.acquire(blocking=False)
        try:
            yield has_it
        finally:
            if has_it:
                self.settling.release()

    # The source

    @property
    def epoch(self) -> int:
        """Another number after each switch, and with each of the source behind it."""
        return self._switches * _EPOCHS + self._current.epoch

    @property
    def connection(self) -> Connection:
        """Implement `TopicSource.connection`."""
        return self._current.connection

    @property
    def now_ns(self) -> int:
        """Implement `TopicSource.now_ns`."""
        return self._current.now_ns

    @property
    def types(self) -> TypeLibrary:
        """Implement `TopicSource.types`."""
        return self._current.types

    @property
    def later_tf(self) -> Sequence[RawSample]:
        """Implement `TopicSource.later_tf`."""
        return self._current.later_tf

    def catalogue(self) -> list[Topic]:
        """Implement `TopicSource.catalogue`."""
        return self._current.catalogue()

    def publishers(self, topic: str) -> Sequence[Endpoint]:
        """Implement `TopicSource.publishers`."""
        return self._current.publishers(topic)

    def sender(self, gid: bytes) -> str | None:
        """Implement `TopicSource.sender`."""
        return self._current.sender(gid)

    def subscribe(
        self,
        request: Request,
        *,
        take: Callable[[RawSample], object] | None = None,
        arrived: Callable[[], object] | None = None,
        changed: Callable[[], object] | None = None,
    ) -> Subscription:
        """Implement `TopicSource.subscribe`."""
        made = Subscription(request, self._left, take, arrived, changed)
        with self._turn:
            self._subscriptions[made] = None
            self._current.adopt(made)
        return made

    def fit_all(self) -> None:
        """Implement `TopicSource.fit_all`."""
        self._current.fit_all()

    def flows(self, topics: Iterable[str]) -> dict[str, Flow]:
        """Implement `TopicSource.flows`."""
        return self._current.flows(topics)

    def latest(self, topics: Iterable[str], at_ns: int) -> dict[str, RawSample]:
        """Implement `TopicSource.latest`."""
        return self._current.latest(topics, at_ns)

    def window(self, topic: str, begin_ns: int, end_ns: int) -> list[RawSample]:
        """Implement `TopicSource.window`."""
        return self._current.window(topic, begin_ns, end_ns)

    def _left(self, subscription: Subscription) -> None:
        with self._turn:
            self._subscriptions.pop(subscription, None)
            self._current.release(subscription)
