"""Subscription: one subscriber's queue; Stream: the subscription on the wire that many share."""

from __future__ import annotations

import logging
import threading
from collections import deque
from dataclasses import replace
from typing import TYPE_CHECKING, Final, Protocol

from studio.live.topics.request import WAITING_BYTES_MAX, SubscriptionState

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from studio.live.time.past import Inbox
    from studio.live.topics.request import Fit, Request
    from studio.ros.node.samples import RawSample

_CACHE_BYTES: Final = 16 << 20
"""Limit of the latched messages of a topic that are kept for later subscribers."""
_SENDERS_MAX: Final = 10_000
_ARRIVALS_MAX: Final = 400
_RATE_OVER_NS: Final = 2_000_000_000

_log = logging.getLogger(__name__)


class Subscription:
    """Holds what came for one subscriber until it is taken; made by a source.

    Attributes:
        request: What is wanted.
        state: How it stands.
        received: Samples that came for it.
        dropped: Samples that fell out of its queue.
        beginnings: How often what came before did not belong to what followed.
    """

    def __init__(
        self,
        request: Request,
        left: Callable[[Subscription], object],
        take: Callable[[RawSample], object] | None,
        arrived: Callable[[], object] | None,
        changed: Callable[[], object] | None,
    ) -> None:
        self.request = request
        self.state = SubscriptionState(request.topic)
        self.received = self.dropped = self.beginnings = 0
        self._left, self._take, self._changed = left, take, changed
        self.arrived = arrived
        self._most = 1 if request.newest_only else request.waiting_max
        self._lock = threading.Lock()
        self._waiting: deque[RawSample] = deque()
        self._waiting_bytes = 0
        self._taking = threading.RLock()
        self.is_closed = False
        self._stream: Stream | None = None
        self._missed = self._missed_before = 0

    @property
    def fit(self) -> Fit | None:
        """Type and QoS, or those of the last stream."""
        return self.state.fit

    @property
    def lost(self) -> int:
        """Samples that were sent and did not get here, or fell out of the queue."""
        stream = self._stream
        missed = 0 if stream is None else stream.lost - self._missed_before
        return max(0, self._missed + missed) + self.dropped

    def rate_hz(self, now_ns: int) -> float:
        """Return how many samples come in a second, recently; `now_ns` is since the Unix epoch."""
        stream = self._stream
        return 0.0 if stream is None else stream.arrivals.rate_hz(now_ns)

    def age_ns(self, now_ns: int) -> int | None:
        """Return how long ago the last sample came, None where none did."""
        stream = self._stream
        last_ns = None if stream is None else stream.arrivals.last_ns
        return None if last_ns is None or not self.received else now_ns - last_ns

    def take(self) -> list[RawSample]:
        """Take all that waits, the oldest first."""
        with self._lock:
            taken = list(self._waiting)
            self._waiting.clear()
            self._waiting_bytes = 0
        return taken

    def take_each(self) -> Iterator[RawSample]:
        """Take one after the other, the oldest first: what is not asked for stays."""
        while self._waiting:
            with self._lock:
                if not self._waiting:
                    return
                sample = self._waiting.popleft()
                self._waiting_bytes -= len(sample.payload)
            yield sample

    def kept(self) -> list[RawSample]:
        """Return the latched messages, as many of each sender as the depth; they stay."""
        stream, fit = self._stream, self.fit
        return [] if stream is None or fit is None else stream.kept(fit.depth)

    def give_again(self) -> None:
        """Put in what is kept once more: its subscriber forgot it."""
        kept = self.kept()
        self.clear()
        if kept:
            self.post(kept)

    def close(self) -> None:
        """Receive nothing more; afterwards `take` of the subscriber is not called any more."""
        self.is_closed = True
        self.leave()
        self.clear()
        self._left(self)

    def clear(self) -> None:
        """Forget what waits: afterwards the subscriber is handed nothing that came before."""
        with self._taking:
            self.take()

    # What follows is for the source.

    def post(self, samples: Sequence[RawSample]) -> None:
        """Put in what came; what there is no room for falls out, the oldest first."""
        with self._lock:
            self.received += len(samples)
            waiting = self._waiting
            if self._most == 1:
                waiting.clear()
                waiting.append(samples[-1])
                self._waiting_bytes = len(samples[-1].payload)
                return
            waiting.extend(samples)
            self._waiting_bytes += sum([len(one.payload) for one in samples])
            while len(waiting) > self._most or (
                self._waiting_bytes > WAITING_BYTES_MAX and len(waiting) > 1
            ):
                self._waiting_bytes -= len(waiting.popleft().payload)
                self.dropped += 1

    @property
    def is_taken_by_source(self) -> bool:
        """Whether the source hands over what waits."""
        return self._take is not None

    def hand_over(self) -> None:
        """Call the subscriber with all that waits."""
        take = self._take
        if take is None:
            return
        with self._taking:
            for sample in self.take_each():
                if self.is_closed:
                    return
                try:
                    take(sample)
                except Exception:  # noqa: BLE001 - one message that cannot be used must not end the rest
                    _log.exception("A message on %s could not be used.", self.request.topic)

    def take_state(self, state: SubscriptionState) -> None:
        """Take another state, and notify if it is new."""
        if state != self.state:
            self.state = state
            if self._changed is not None:
                self._changed()

    def change_type(self, fit: Fit) -> None:
        """Share no stream, and forget what waits: what comes from now on is of another type."""
        self.leave()
        self.clear()
        self.state = replace(self.state, fit=fit)

    def join(self, stream: Stream, depth: int) -> None:
        """Share a stream from now on, and no other."""
        if stream is not self._stream:
            self.leave()
            self._stream, self._missed_before = stream, stream.lost
        stream.join(self, depth)

    def leave(self) -> None:
        """Share no stream; what waits may still be taken."""
        stream, self._stream = self._stream, None
        if stream is not None:
            self._missed += stream.lost - self._missed_before
            stream.remove(self)


class WireSubscription(Protocol):
    """The subscription of a source behind a stream."""

    @property
    def lost(self) -> int:
        """Samples that were sent and did not come."""
        ...

    def read(self, *, newest_only: bool) -> None:
        """Take only the newest of samples that came together, or all."""
        ...

    def hurry(self, *, wanted: bool) -> None:
        """Take samples as soon as possible, or as usual."""
        ...

    def deepen(self, depth: int, swapped: Callable[[], object]) -> None:
        """Subscribe with a greater depth; calls `swapped` before the first that may come again."""
        ...

    def close(self) -> None:
        """Receive nothing more."""
        ...


class Stream:
    """One subscription of a source, shared by all subscribers with the same fit.

    The deepest subscriber sets the depth. Latched messages are kept for later subscribers, as many
    of each sender as the depth.

    Args:
        fit: Type, QoS, and the first depth.
        subscribe: Starts to receive; its callback takes the samples, in a thread of the source.
        hand_over: Makes sure that `Subscription.hand_over` is called.
        keeps: Whether the last messages are kept for later subscribers though they are not latched.

    Raises:
        StudioError: It cannot be subscribed.
    """

    def __init__(
        self,
        fit: Fit,
        subscribe: Callable[[Stream], WireSubscription],
        hand_over: Callable[[Subscription], object],
        *,
        keeps: bool = False,
    ) -> None:
        self.depth = fit.depth
        self.arrivals = Arrivals()
        self._hand_over = hand_over
        self._lock = threading.Lock()
        self._subscribers: tuple[Subscription, ...] = ()
        self._cache = Cache() if fit.latched or keeps else None
        self._repeats_to: dict[bytes, int] = {}
        """By sender: samples up to this number came before the depth grew, and come again."""
        self._late: frozenset[Subscription] = frozenset()
        """Subscribers that joined since then, and take those that come again."""
        self.inbox: Inbox | None = None
        """Keeps what comes for those who look back."""
        self._wire = subscribe(self)

    @property
    def is_used(self) -> bool:
        """Whether it has subscribers."""
        return bool(self._subscribers)

    @property
    def lost(self) -> int:
        """Samples that were sent and did not come."""
        return self._wire.lost

    def kept(self, depth: int) -> list[RawSample]:
        """Return the latched messages in order of arrival, at most `depth` of each sender."""
        with self._lock:
            return [] if self._cache is None else self._cache.samples(depth)

    def forget_senders(self, there: frozenset[bytes]) -> None:
        """Keep nothing of latched senders that were among those there, and are not any more."""
        with self._lock:
            if self._cache is not None:
                self._cache.keep_senders(there)

    def join(self, one: Subscription, depth: int) -> None:
        """Add a subscriber and give it the latched messages; call in a thread, for it may wait."""
        if one in self._subscribers:
            if depth <= self.depth:
                return
            self._remove(one)
        if depth > self.depth:
            self._deepen(one, depth)
            return
        with self._lock:
            kept = [] if self._cache is None else self._cache.samples(depth)
            if kept:
                one.post(kept)
            self._add(one)
        if kept:
            self._notify((one,))

    def begin_anew(self, samples: list[RawSample]) -> None:
        """Give all subscribers these samples, and nothing of what came before."""
        with self._lock:
            self._repeats_to, self._late = {}, frozenset()
            if self._cache is not None:
                self._cache = Cache()
            for one in self._subscribers:
                one.clear()
        self.arrivals = Arrivals()
        self.take_past(samples)

    def take_past(self, samples: list[RawSample]) -> None:
        """Pass samples to all subscribers that came one after the other, and not just now."""
        if samples:
            for one in samples[-_ARRIVALS_MAX:-1]:
                self.arrivals.add(one.received_ns, 1)
            self.take(samples, 1, 0)

    def subscribers(self) -> tuple[Subscription, ...]:
        """Who shares it."""
        return self._subscribers

    def remove(self, one: Subscription) -> None:
        """Remove a subscriber."""
        self._remove(one)

    def close(self) -> None:
        """Receive nothing more; in a thread, for it may wait."""
        self._wire.close()
        if self.inbox is not None:
            self.inbox.close()

    def take(self, samples: list[RawSample], count: int, _size: int) -> None:
        """Pass samples to all subscribers; called in a thread of the source."""
        self.arrivals.add(samples[-1].received_ns, count)
        if self.inbox is not None:
            self.inbox.put(samples)
        with self._lock:
            fresh = samples
            if self._cache is not None:
                if self._repeats_to:
                    fresh = [one for one in samples if not self._is_repeated(one)]
                self._cache.put(samples, self.depth)
            given: list[Subscription] = []
            for one in self._subscribers:
                if share := samples if one in self._late else fresh:
                    one.post(share)
                    given.append(one)
        self._notify(given)

    def _notify(self, given: Sequence[Subscription]) -> None:
        for one in given:
            if one.arrived is not None:
                one.arrived()
            if one.is_taken_by_source:
                self._hand_over(one)

    def _is_repeated(self, sample: RawSample) -> bool:
        return _place(sample) <= self._repeats_to.get(sample.attachment.gid, -1)

    def _deepen(self, one: Subscription, depth: int) -> None:
        self.depth = depth

        def swapped() -> None:
            with self._lock:
                if self._cache is not None:
                    self._repeats_to |= self._cache.last
                    self._cache = Cache()
                    self._late = frozenset({one})
                self._add(one)

        self._wire.deepen(depth, swapped)

    def _add(self, one: Subscription) -> None:
        if one.is_closed:
            return
        self._subscribers = (*self._subscribers, one)
        if self._repeats_to:
            self._late |= {one}
        self._fit_reading()

    def _remove(self, one: Subscription) -> None:
        with self._lock:
            self._subscribers = tuple(each for each in self._subscribers if each is not one)
            self._late -= {one}
            self._fit_reading()

    def _fit_reading(self) -> None:
        """Read as much and as soon as the subscribers want."""
        requests = [one.request for one in self._subscribers]
        newest_only = all(one.newest_only for one in requests)
        self._wire.read(newest_only=newest_only and self._cache is None)
        self._wire.hurry(wanted=any(one.at_once for one in requests))


def _place(sample: RawSample) -> int:
    """Return what grows from each sample of a sender to the next: DDS tells its time only."""
    return sample.attachment.sequence or sample.attachment.source_time_ns


class Arrivals:
    """Times at which samples came recently; samples that came together are one entry."""

    def __init__(self) -> None:
        self._entries: deque[tuple[int, int]] = deque(maxlen=_ARRIVALS_MAX)

    def add(self, at_ns: int, count: int) -> None:
        """Count samples that came together, at a time since the Unix epoch."""
        self._entries.append((at_ns, count))

    @property
    def last_ns(self) -> int | None:
        """When the last one came; None: none did."""
        return self._entries[-1][0] if self._entries else None

    def rate_hz(self, now_ns: int) -> float:
        """Return how many came in a second, over the last two."""
        late = [one for one in tuple(self._entries) if now_ns - one[0] <= _RATE_OVER_NS]
        if not late or late[-1][0] <= late[0][0]:
            return 0.0
        return (sum(count for _, count in late) - 1) * 1e9 / (late[-1][0] - late[0][0])


class Cache:
    """The last samples of each sender of a latched topic.

    Attributes:
        last: The place of the last sample of each sender.
    """

    def __init__(self) -> None:
        self.last: dict[bytes, int] = {}
        self._kept: dict[bytes, deque[RawSample]] = {}
        self._count = self._bytes = 0
        self._seen: frozenset[bytes] = frozenset()

    def put(self, samples: Sequence[RawSample], depth: int) -> None:
        """Keep more of them, of each sender as many as that."""
        for sample in samples:
            sender = sample.attachment.gid
            self.last[sender] = _place(sample)
            kept = self._kept.setdefault(sender, deque())
            kept.append(sample)
            self._count += 1
            self._bytes += len(sample.payload)
            if len(kept) > depth:
                self._drop_first(sender)
        while len(self._kept) > _SENDERS_MAX or (self._bytes > _CACHE_BYTES and self._count > 1):
            self._drop_first(min(self._kept, key=lambda one: self._kept[one][0].received_ns))
        if len(self.last) > _SENDERS_MAX:
            self.last = {sender: self.last[sender] for sender in self._kept}

    def samples(self, most_each: int) -> list[RawSample]:
        """Return the newest of each sender, so many at most, in the order in which they came."""
        found = [one for kept in self._kept.values() for one in tuple(kept)[-most_each:]]
        return sorted(found, key=lambda one: one.received_ns)

    def keep_senders(self, there: frozenset[bytes]) -> None:
        """Drop the latched messages of senders that were seen before and are gone."""
        for gone in (self._seen - there) & self._kept.keys():
            while gone in self._kept:
                self._drop_first(gone)
        self._seen = there

    def _drop_first(self, sender: bytes) -> None:
        kept = self._kept[sender]
        self._count -= 1
        self._bytes -= len(kept.popleft().payload)
        if not kept:
            del self._kept[sender]
