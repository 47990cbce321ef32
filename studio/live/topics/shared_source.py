"""SharedSource: what sources have in common that share a subscription among many subscribers."""

from __future__ import annotations

import logging
import threading
import time
from abc import ABC, abstractmethod
from dataclasses import replace
from typing import TYPE_CHECKING, Final, NamedTuple

from studio.errors import StudioError
from studio.live.topics.request import SubscriptionState, fit_request
from studio.live.topics.subscription import Stream, Subscription
from studio.live.topics.topic_rates import TopicRates

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from studio.live.topics.request import Endpoint, Fit, Request, StateKind
    from studio.live.topics.source import Connection, Topic
    from studio.live.topics.subscription import WireSubscription
    from studio.live.topics.topic_rates import Meter
    from studio.ros.node.samples import RawSample
    from studio.ros.node.topic_statistics import Flow
    from studio.ros.types.library import TypeLibrary

_HASHED: Final = "RIHS01_"

_log = logging.getLogger(__name__)


class _Key(NamedTuple):
    """Key of a stream: the properties that its subscribers share."""

    topic: str
    type_name: str
    type_hash: str | None
    reliable: bool
    latched: bool


class SharedSource(ABC):
    """Keeps the subscriptions, and one stream for all of a topic that fit together.

    A subclass knows the publishers and starts to receive; it calls `fit_all` after `refit`, and
    `change_epoch` when earlier messages do not belong to those that follow.
    """

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._subscriptions: dict[Subscription, None] = {}
        self._streams: dict[_Key, Stream] = {}
        self.rates = TopicRates(self.measure)
        self.fitting = threading.Lock()
        """Held while the source is attached, detached or fitted."""
        self._epoch = 0

    @property
    def epoch(self) -> int:
        """Another number once earlier messages do not belong to those that follow."""
        return self._epoch

    @property
    @abstractmethod
    def types(self) -> TypeLibrary:
        """Message types as this source defines them."""

    @abstractmethod
    def catalogue(self) -> list[Topic]:
        """Return all topics by name."""

    @abstractmethod
    def publishers(self, topic: str) -> Sequence[Endpoint]:
        """Return the publishers of a topic; none if the name is not valid."""

    @abstractmethod
    def sender(self, gid: bytes) -> str | None:
        """Return the full name of the node that sent samples with a GID; None: it is not known."""

    @property
    @abstractmethod
    def connection(self) -> Connection:
        """Whether anything can come."""

    @abstractmethod
    def own_hash(self, type_name: str) -> str | None:
        """Return the hash of our definition of a type, as in tokens; None: it is not known."""

    @abstractmethod
    def senders(self, topic: str) -> frozenset[bytes]:
        """Return the GIDs of a topic's publishers."""

    @abstractmethod
    def open(self, topic: str, fit: Fit, stream: Stream) -> WireSubscription:
        """Begin to receive for a stream.

        Raises:
            StudioError: It cannot be subscribed so.
        """

    @abstractmethod
    def measure(self, topic: str, kept_s: float) -> Meter | None:
        """Count the messages of a topic, until nobody asked for `kept_s`.

        None: nobody publishes it, or the source has ended.
        """

    @abstractmethod
    def refit(self) -> None:
        """Have all subscriptions fitted again soon; thread-safe."""

    @abstractmethod
    def hand_over(self, subscription: Subscription) -> None:
        """Make sure that the subscription hands over what waits."""

    def subscribe(
        self,
        request: Request,
        *,
        take: Callable[[RawSample], object] | None = None,
        arrived: Callable[[], object] | None = None,
        changed: Callable[[], object] | None = None,
    ) -> Subscription:
        """Implement `TopicSource.subscribe`."""
        made = Subscription(request, self.release, take, arrived, changed)
        self.adopt(made)
        return made

    def adopt(self, subscription: Subscription) -> None:
        """Receive for a subscription from now on; it may come from another source."""
        with self._lock:
            self._subscriptions[subscription] = None
        self.refit()

    def release(self, subscription: Subscription) -> None:
        """Receive nothing more for a subscription; it need not be there."""
        with self._lock:
            self._subscriptions.pop(subscription, None)
        subscription.leave()
        self.refit()

    def flows(self, topics: Iterable[str]) -> dict[str, Flow]:
        """Implement `TopicSource.flows`."""
        return self.rates.flows(topics)

    def latest(self, topics: Iterable[str], at_ns: int) -> dict[str, RawSample]:
        """Return the newest sample of each topic at or before a time, of those that are latched."""
        found = {topic: self._kept(topic, 0, at_ns + 1) for topic in topics}
        return {topic: samples[-1] for topic, samples in found.items() if samples}

    def window(self, topic: str, begin_ns: int, end_ns: int) -> list[RawSample]:
        """Return the latched samples in [begin_ns, end_ns)."""
        return self._kept(topic, begin_ns, end_ns)

    def fit_all(self) -> None:
        """Subscribe everything as fits who publishes now; in a thread, for it may wait."""
        with self.fitting:
            self._fit_all()

    def end_all(self) -> None:
        """Receive nothing for anybody until all are fitted again; the caller holds `fitting`."""
        self.rates.clear()
        streams, self._streams = self._streams, {}
        for one in self._wanted():
            one.leave()
            one.clear()
        for stream in streams.values():
            stream.close()

    def change_epoch(self, anew: Iterable[Subscription] | None = None) -> None:
        """Begin a new epoch: earlier messages do not belong to those that follow.

        Args:
            anew: For the others what came before is still what they would be given now; None: it is
                so for none.
        """
        for one in self._wanted() if anew is None else anew:
            one.beginnings += 1
        self._epoch += 1

    @property
    def is_live(self) -> bool:
        """Whether it is of what runs now, and not a recording."""
        return True

    @property
    def now_ns(self) -> int:
        """The time of the messages that come now, since the Unix epoch."""
        return time.time_ns()

    @property
    def later_tf(self) -> Sequence[RawSample]:
        """The messages of /tf that come next, where the time stands still; else none."""
        return ()

    @property
    def is_refused(self) -> bool:
        """Whether something was refused that may be possible later: a type may be learned."""
        return any(one.state.kind == "refused" for one in self._wanted())

    def _wanted(self) -> tuple[Subscription, ...]:
        with self._lock:
            return tuple(self._subscriptions)

    def _kept(self, topic: str, begin_ns: int, end_ns: int) -> list[RawSample]:
        streams = [one for key, one in tuple(self._streams.items()) if key.topic == topic]
        kept = [sample for one in streams for sample in one.kept(one.depth)]
        inside = (one for one in kept if begin_ns <= one.received_ns < end_ns)
        return sorted(inside, key=lambda one: one.received_ns)

    def _fit_all(self) -> None:
        connection = self.connection
        publishers: dict[str, Sequence[Endpoint]] = {}
        for one in self._wanted():
            topic = one.request.topic
            if connection == "there" and topic not in publishers:
                publishers[topic] = self.publishers(topic)
            try:
                one.take_state(self._fitted(one, connection, publishers.get(topic, ())))
            except Exception:  # noqa: BLE001 - one topic that fails must not silence the others
                _log.exception("%s could not be subscribed.", topic)
        for key, stream in tuple(self._streams.items()):
            if not stream.is_used:
                del self._streams[key]
                stream.close()
            elif key.latched:
                stream.forget_senders(self.senders(key.topic))

    def _fitted(
        self, one: Subscription, connection: Connection, publishers: Sequence[Endpoint]
    ) -> SubscriptionState:
        """Let a subscription share the stream that fits, and return its state."""
        request = one.request
        if connection != "there":
            kind = "not_connected" if connection == "none" else "connection_lost"
            return SubscriptionState(request.topic, kind, one.fit)
        fit = fit_request(request, publishers, one.fit, self.own_hash)
        types = tuple(dict.fromkeys(each.type_name for each in publishers))
        state = SubscriptionState(
            request.topic, "no_publisher", fit, len(publishers), types, is_live=self.is_live
        )
        if fit is None:
            one.leave()
            return state
        fit = self.deepened(request.topic, fit)
        state = replace(state, fit=fit)
        if one.fit is not None and one.fit.type_name != fit.type_name:
            one.change_type(fit)
        try:
            one.join(self._stream(request.topic, fit), fit.depth)
        except StudioError as error:
            one.leave()
            return replace(state, kind="refused", reason=str(error))
        return replace(state, kind=self._kind(request, fit, publishers))

    def _stream(self, topic: str, fit: Fit) -> Stream:
        key = _Key(topic, fit.type_name, fit.type_hash, fit.reliable, fit.latched)
        stream = self._streams.get(key)
        if stream is None:
            stream = self._streams[key] = self.begin(topic, fit)
        return stream

    def deepened(self, topic: str, fit: Fit) -> Fit:
        """Return a fit as deep as this source has it."""
        return fit

    def begin(self, topic: str, fit: Fit) -> Stream:
        """Begin to receive for all who share a fit; errors as for `open`."""
        return Stream(fit, lambda made: self.open(topic, fit, made), self.hand_over)

    def _kind(self, request: Request, fit: Fit, publishers: Sequence[Endpoint]) -> StateKind:
        if not publishers:
            return "no_publisher"
        fitting = [one for one in publishers if one.type_name == fit.type_name]
        if not fitting:
            return "other_type"
        if request.as_known_here and self._is_foreign(fit.type_name, fitting):
            return "other_form"
        return "receiving"

    def _is_foreign(self, type_name: str, fitting: Sequence[Endpoint]) -> bool:
        """Whether all have the type in another form than here; Humble's tokens carry no hash."""
        own = self.own_hash(type_name)
        return own is not None and all(
            one.type_hash.startswith(_HASHED) and one.type_hash != own for one in fitting
        )
