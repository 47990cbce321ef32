"""LivePast: the last minutes of the live system, kept in memory within a bound."""

from __future__ import annotations

import heapq
import threading
from collections import deque
from typing import TYPE_CHECKING, Final

import numpy as np

from studio.bags.recording import Recorded, RecordedTopic
from studio.live.time.kept_topic import KeptTopic

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sequence

    from numpy.typing import NDArray

    from studio.live.time.kept_topic import Part
    from studio.live.topics.request import Fit
    from studio.ros.node.samples import RawSample
    from studio.ros.qos import QoSProfile
    from studio.ros.types.library import TypeLibrary

COUNT_MAX: Final = 1_000_000
"""Limit of all messages together."""
TOPICS_MAX: Final = 2_000
_OFFERED_MAX: Final = 20
_INBOX_SAMPLES_MAX: Final = 200_000
"""Of a topic, between two calls of `collect`."""
_LONG_NS: Final = 300_000_000_000
"""For so long large topics are thinned: what is older is let go instead."""
_LARGE_SHARE: Final = 4
"""A topic that takes more than one of so many parts of the memory is large."""


class Inbox:
    """What came on one subscription and is not collected yet.

    Attributes:
        name: Of the topic.
        fit: How it is subscribed.
        kept: Returns the messages that its publishers have latched.
        topic: Where it goes; None: nowhere.
        may_repeat: Whether some of it may come by another subscription, or again.
        put: Keeps a list, which must not be changed afterwards; called by the thread of the source.
    """

    __slots__ = ("_came", "_past", "fit", "kept", "may_repeat", "name", "put", "topic")

    def __init__(
        self, past: LivePast, name: str, fit: Fit, kept: Callable[[], Sequence[RawSample]]
    ) -> None:
        self.name, self.fit, self.kept = name, fit, kept
        self.may_repeat = fit.latched
        self._past = past
        self._came: deque[list[RawSample]] = deque()
        self.topic: KeptTopic | None = None
        self.put: Callable[[list[RawSample]], object] = _nowhere

    def lead_to(self, topic: KeptTopic | None) -> None:
        """Keep what comes from now on in a topic, or nowhere."""
        self.topic = topic
        self._came.clear()
        self.put = _nowhere if topic is None else self._came.append

    def take(self) -> list[RawSample]:
        """Take all out, in the order in which it came; the newest, if nobody did for long."""
        taken: list[RawSample] = []
        for _ in range(len(self._came)):
            taken += self._came.popleft()
        return taken[-_INBOX_SAMPLES_MAX:]

    def close(self) -> None:
        """Keep nothing more; what came stays."""
        self._past.end(self)


def _nothing() -> None:
    """Do nothing: the default of `on_clear`."""


def _nowhere(_samples: list[RawSample]) -> None:
    """Keep nothing."""


class LivePast:
    """Implements `Recording` by what came lately; `size` is never above `size_max` for long.

    What came is put into inboxes, which costs next to nothing, and every reader collects it first.
    When it is too much, a large topic loses every second message of what is not quite new, and
    otherwise the oldest goes, whatever its topic.

    Attributes:
        size_max: Bytes of memory.
        epoch: Another number once earlier messages are forgotten.
        zero_ns: When the first message of an epoch came, though it is gone; 0 before.
        on_clear: Called when all is forgotten, in any thread.
    """

    def __init__(
        self,
        size_max: int,
        types: Callable[[], TypeLibrary],
        publishers: Callable[[str], Iterable[QoSProfile]] = lambda _: (),
    ) -> None:
        self.size_max, self.epoch, self.zero_ns = size_max, 0, 0
        self.on_clear: Callable[[], object] = _nothing
        self._library, self._publishers = types, publishers
        self._lock = threading.Lock()
        self._topics: dict[str, KeptTopic] = {}
        self._inboxes: list[Inbox] = []
        self._troubles: dict[str, str] = {}
        self._is_keeping = False

    # What is kept

    @property
    def is_keeping(self) -> bool:
        """Whether what comes is kept; at first it is not."""
        return self._is_keeping

    def keep(self, *, keeping: bool) -> None:
        """Keep what comes from now on, or forget all and keep nothing."""
        self._is_keeping = keeping
        self.clear()

    def begin(self, topic: str, fit: Fit, kept: Callable[[], Sequence[RawSample]]) -> Inbox:
        """Keep what comes on one more subscription, until its inbox is closed.

        Args:
            topic: Full name.
            fit: How it is subscribed.
            kept: Returns the messages that its publishers have latched, the oldest first.
        """
        made = Inbox(self, topic, fit, kept)
        with self._lock:
            self._inboxes.append(made)
            self._lead(made)
        return made

    def end(self, inbox: Inbox) -> None:
        """Close an inbox."""
        with self._lock:
            self._collect()
            inbox.lead_to(None)
            self._inboxes = [one for one in self._inboxes if one is not inbox]
            for one in self._inboxes:
                if one.name == inbox.name and one.topic is None:
                    self._lead(one)

    def clear(self) -> None:
        """Forget all that came: it begins anew."""
        with self._lock:
            self.epoch, self.zero_ns = self.epoch + 1, 0
            self._topics, self._troubles = {}, {}
            for one in self._inboxes:
                one.lead_to(None)
            for one in self._inboxes:
                self._lead(one)
        self.on_clear()

    def _lead(self, inbox: Inbox) -> None:
        """Lead an inbox to its topic, if there is room for that."""
        kept = self._topic(inbox.name, inbox.fit) if self._is_keeping else None
        if kept is None:
            return
        for one in self._inboxes:
            if one.topic is kept:  # what comes to two subscriptions comes twice
                one.may_repeat = inbox.may_repeat = True
        kept.is_latched = kept.is_latched or inbox.fit.latched
        inbox.lead_to(kept)
        if latched := inbox.kept() if inbox.fit.latched else ():
            kept.add_latched(latched)

    def collect(self) -> None:
        """Take in what came, and make room; to be called several times in a second."""
        with self._lock:
            self._collect()

    def note_publishers(self) -> None:
        """Note the QoS that publishers offer now; of those that are gone, the last stays."""
        with self._lock:
            topics = tuple(self._topics.values())
        for one in topics:
            one.qos = self._offered(one.name) or one.qos

    @property
    def size(self) -> int:
        """Bytes of memory that it takes, about."""
        with self._lock:
            return self._size()

    def _topic(self, name: str, fit: Fit) -> KeptTopic | None:
        """Return a topic, begun anew where its type is another; None: there is no room for it."""
        known = self._topics.get(name)
        if known is not None and known.type_name == fit.type_name:
            return known
        if known is not None and any(one.topic is known for one in self._inboxes):
            self._troubles[name] = (
                f"{name} comes as {known.type_name} and as {fit.type_name}: "
                f"only {known.type_name} is kept."
            )
            return None
        if known is None and len(self._topics) >= TOPICS_MAX:
            self._troubles[""] = f"Only the first {TOPICS_MAX} topics are kept."
            return None
        made = KeptTopic(name, fit.type_name, fit.type_hash or "")
        made.qos = self._offered(name)
        self._topics[name] = made
        return made

    def _offered(self, topic: str) -> tuple[QoSProfile, ...]:
        """Return what publishers offer, each once."""
        offered: list[QoSProfile] = []
        for one in self._publishers(topic):
            if one not in offered and len(offered) < _OFFERED_MAX:
                offered.append(one)
        return tuple(offered)

    def _collect(self) -> None:
        for one in self._inboxes:
            if one.topic is not None and (came := one.take()):
                one.topic.add(came, may_repeat=one.may_repeat)
        self.zero_ns = self.zero_ns or self._begin_ns()
        size, count = self._size(), self._count()
        while size > self.size_max or count > COUNT_MAX:
            if not self._make_room():
                break
            size, count = self._size(), self._count()

    def _size(self) -> int:
        return sum([one.size for one in self._topics.values()])

    def _count(self) -> int:
        return sum([one.count for one in self._topics.values()])

    def _make_room(self) -> bool:
        """Let go of a little; returns whether there was any."""
        largest = max(self._topics.values(), key=lambda one: one.size)
        is_short = self._end_ns() - self._begin_ns() < _LONG_NS
        if is_short and largest.size > self.size_max // _LARGE_SHARE and largest.thin():
            return True
        oldest = min(self._topics.values(), key=_age_order)
        if not oldest.count:
            return False
        oldest.drop_oldest()
        return True

    # What is asked of it

    @property
    def begin_ns(self) -> int:
        """When the first message came, beside those that are latched; 0 without one."""
        with self._lock:
            self._collect()
            return self._begin_ns()

    @property
    def end_ns(self) -> int:
        """When the last message came; 0 without one."""
        with self._lock:
            self._collect()
            return self._end_ns()

    def _begin_ns(self) -> int:
        begins = [one.begin_ns for one in self._topics.values()]
        return min((one for one in begins if one is not None), default=self._end_ns())

    def _end_ns(self) -> int:
        return max((one.end_ns or 0 for one in self._topics.values()), default=0)

    @property
    def topics(self) -> Sequence[RecordedTopic]:
        """All topics by name."""
        with self._lock:
            self._collect()
            return [_recorded(one) for _, one in sorted(self._topics.items()) if one.count]

    def topic(self, name: str) -> RecordedTopic | None:
        """Implement `Recording.topic`."""
        with self._lock:
            self._collect()
            kept = self._topics.get(name)
            return _recorded(kept) if kept is not None and kept.count else None

    @property
    def types(self) -> TypeLibrary:
        """Message types of the system."""
        return self._library()

    @property
    def troubles(self) -> Sequence[str]:
        """What is left out, a sentence each."""
        with self._lock:
            return tuple(self._troubles.values())

    def latest(self, topics: Iterable[str], at_ns: int) -> dict[str, RawSample]:
        """Implement `Recording.latest`."""
        found = {name: self.last(name, at_ns, 1) for name in topics}
        return {name: samples[0] for name, samples in found.items() if samples}

    def last(self, topic: str, at_ns: int, most: int, since_ns: int = 0) -> list[RawSample]:
        """Implement `Recording.last`."""
        with self._lock:
            self._collect()
            kept = self._topics.get(topic)
            return [] if kept is None else kept.last(at_ns, most, since_ns)

    def messages(self, topics: Iterable[str], begin_ns: int, end_ns: int) -> Iterator[Recorded]:
        """Implement `Recording.messages`; what is let go meanwhile is yielded nevertheless."""
        with self._lock:
            self._collect()
            kept = [self._topics[name] for name in dict.fromkeys(topics) if name in self._topics]
            parts = [(one, one.parts(begin_ns, end_ns)) for one in kept]
        return heapq.merge(*(_recorded_of(*one) for one in parts), key=_time_of)

    def next_ns(self, topic: str, after_ns: int) -> int | None:
        """Implement `Recording.next_ns`."""
        with self._lock:
            self._collect()
            kept = self._topics.get(topic)
            return None if kept is None else kept.next_ns(after_ns)

    def previous_ns(self, topic: str, before_ns: int) -> int | None:
        """Implement `Recording.previous_ns`."""
        with self._lock:
            self._collect()
            kept = self._topics.get(topic)
            return None if kept is None else kept.previous_ns(before_ns)

    def counts(self, topic: str, begin_ns: int, end_ns: int, bins: int) -> NDArray[np.int64]:
        """Implement `Recording.counts`."""
        with self._lock:
            self._collect()
            kept = self._topics.get(topic)
            if kept is None or end_ns <= begin_ns:
                return np.zeros(bins, dtype=np.int64)
            return kept.counts(begin_ns, end_ns, bins)


def _age_order(topic: KeptTopic) -> tuple[bool, bool, int]:
    """Order topics by what goes first: the oldest, then what only latching keeps."""
    begin_ns = topic.begin_ns
    return not topic.count, begin_ns is None, topic.end_ns or 0 if begin_ns is None else begin_ns


def _recorded(topic: KeptTopic) -> RecordedTopic:
    note = ""
    if topic.level:
        note = (
            f"{topic.name} is too large to be kept whole: of what is not quite new, one message in "
            f"up to {1 << topic.level} is kept."
        )
    return RecordedTopic(
        topic.name, topic.type_name, topic.type_hash, topic.qos, topic.count, note=note
    )


def _recorded_of(topic: KeptTopic, parts: Sequence[Part]) -> Iterator[Recorded]:
    return (Recorded(topic.name, one) for part in parts for one in topic.samples(part))


def _time_of(recorded: Recorded) -> int:
    return recorded.sample.received_ns
