"""ZenohSource: the topics of the ROS 2 system that the studio is connected with, if it is."""

from __future__ import annotations

import logging
import threading
import time
from collections import deque
from typing import TYPE_CHECKING, Final, Protocol

from typing_extensions import override

from studio.errors import RosNameError, StudioError, UnknownTypeError
from studio.live.topics.request import Endpoint
from studio.live.topics.shared_source import SharedSource
from studio.live.topics.source import Topic

if TYPE_CHECKING:
    from collections.abc import Sequence

    from studio.live.time.past import LivePast
    from studio.live.topics.request import Fit
    from studio.live.topics.source import Connection
    from studio.live.topics.subscription import Stream, Subscription
    from studio.live.topics.topic_rates import Meter
    from studio.ros.graph.endpoints import GraphEndpoint
    from studio.ros.graph.graph import Graph
    from studio.ros.node.raw_subscription import RawSubscription
    from studio.ros.types.library import TypeLibrary

_PAUSE_S: Final = 0.05
"""Changes within this time are fitted together."""
_AGAIN_S: Final = 0.5
"""Until a refused subscription is tried again."""

_log = logging.getLogger(__name__)


class Link(Protocol):
    """The part of a connection that a source uses."""

    @property
    def is_connected(self) -> bool:
        """Whether its router is there."""
        ...

    @property
    def graph(self) -> Graph:
        """The graph of nodes and endpoints."""
        ...

    @property
    def types(self) -> TypeLibrary:
        """All types known on it."""
        ...

    @property
    def zid(self) -> str:
        """Zenoh id of the studio's own session."""
        ...

    def shown_hash(self, type_name: str) -> str:
        """Return the hash of a type as publishers show it; raises an UnknownTypeError."""
        ...

    def receive(self, topic: str, fit: Fit, stream: Stream) -> RawSubscription:
        """Begin to receive; raises a StudioError."""
        ...

    def measure(self, topic: str, kept_s: float) -> Meter:
        """Count messages until nobody asked for `kept_s`; raises a RosNameError."""
        ...


class ZenohSource(SharedSource):
    """Outlives connections: subscriptions wait for the next one.

    Two threads are started with the first connection: one that fits subscriptions when somebody
    came or went, and one that hands samples to those who have them handed over.
    """

    def __init__(self) -> None:
        super().__init__()
        self._link: Link | None = None
        self.past: LivePast | None = None
        """Keeps what comes; to be set before anything is subscribed."""
        self._due_to_fit = threading.Event()
        self._closed = False
        self._due: deque[Subscription] = deque()
        self._is_due = threading.Event()
        self._threads: list[threading.Thread] = []

    def attach(self, link: Link) -> None:
        """Take topics from a connection; what comes is of another epoch."""
        self._link = link
        self.change_epoch()
        self._start()
        self.refit()

    def detach(self) -> None:
        """Take nothing more from the connection, which is about to end; in a thread."""
        with self.fitting:
            self._link = None
            self.end_all()
            self.change_epoch()
        self.fit_all()

    def close(self) -> None:
        """Take nothing more from anywhere; in a thread."""
        self.detach()
        self._closed = True
        self._due_to_fit.set()
        self._is_due.set()
        for thread in self._threads:
            thread.join()

    @property
    @override
    def types(self) -> TypeLibrary:
        from studio.ros.messages import shared_types  # noqa: PLC0415 - takes its time

        link = self._link
        return shared_types() if link is None else link.types

    @property
    @override
    def connection(self) -> Connection:
        link = self._link
        if link is None:
            return "none"
        return "there" if link.is_connected else "lost"

    @override
    def catalogue(self) -> list[Topic]:
        link = self._link
        if link is None:
            return []
        graph = link.graph
        return [
            Topic(
                name,
                tuple(types),
                tuple(_endpoint(one, link) for one in graph.publishers(name)),
                tuple(_endpoint(one, link) for one in graph.subscriptions(name)),
            )
            for name, types in graph.topics()
        ]

    @override
    def publishers(self, topic: str) -> Sequence[Endpoint]:
        link = self._link
        return () if link is None else [_endpoint(one, link) for one in _publishers(link, topic)]

    @override
    def senders(self, topic: str) -> frozenset[bytes]:
        link = self._link
        return (
            frozenset[bytes]()
            if link is None
            else frozenset(one.gid for one in _publishers(link, topic))
        )

    @override
    def sender(self, gid: bytes) -> str | None:
        link = self._link
        found = None if link is None else link.graph.endpoint_of_gid(gid)
        return None if found is None else found.node.path

    @override
    def own_hash(self, type_name: str) -> str | None:
        link = self._link
        try:
            return None if link is None else link.shown_hash(type_name)
        except UnknownTypeError:
            return None

    @override
    def open(self, topic: str, fit: Fit, stream: Stream) -> RawSubscription:
        assert self._link is not None
        if self.past is None:
            return self._link.receive(topic, fit, stream)
        stream.inbox = self.past.begin(topic, fit, lambda: stream.kept(stream.depth))
        try:
            return self._link.receive(topic, fit, stream)
        except StudioError:
            stream.inbox.close()
            raise

    @override
    def measure(self, topic: str, kept_s: float) -> Meter | None:
        link = self._link
        return link.measure(topic, kept_s) if link and _publishers(link, topic) else None

    @override
    def refit(self) -> None:
        self._due_to_fit.set()

    @override
    def hand_over(self, subscription: Subscription) -> None:
        self._due.append(subscription)
        self._is_due.set()

    def _start(self) -> None:
        if not self._threads:
            self._threads = [
                threading.Thread(target=self._keep_fitting, name="topics fit", daemon=True),
                threading.Thread(target=self._keep_handing_over, name="topics take", daemon=True),
            ]
            for thread in self._threads:
                thread.start()

    def _keep_fitting(self) -> None:
        while not self._closed:
            self._due_to_fit.wait(_AGAIN_S if self.is_refused else None)
            self._due_to_fit.clear()
            try:
                self.fit_all()
            except Exception:  # noqa: BLE001 - what fails once must not end the rest
                _log.exception("Topics could not be subscribed.")
            time.sleep(_PAUSE_S)

    def _keep_handing_over(self) -> None:
        while not self._closed:
            self._is_due.wait()
            self._is_due.clear()
            while self._due:
                self._due.popleft().hand_over()


def _publishers(link: Link, topic: str) -> list[GraphEndpoint]:
    try:
        return link.graph.publishers(topic)
    except RosNameError:  # reported when it is subscribed
        return []


def _endpoint(found: GraphEndpoint, link: Link) -> Endpoint:
    own = found.node.zid == link.zid
    return Endpoint(found.node.path, own, found.type_name, found.type_hash, found.qos)
