"""A recording in memory, of messages that tests make."""

from __future__ import annotations

import bisect
import hashlib
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from studio.bags.recording import Recorded, RecordedTopic
from studio.ros.attachment import Attachment
from studio.ros.cdr import codec_of
from studio.ros.messages import message, shared_types
from studio.ros.node.samples import RawSample

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from numpy.typing import NDArray

    from studio.ros.qos import QoSProfile
    from studio.ros.types.library import TypeLibrary


class MemoryRecording:
    """Filled by `add`; what was read of it is counted.

    Attributes:
        reads: Messages that were asked for, by topic.
    """

    def __init__(self, types: TypeLibrary | None = None) -> None:
        self.types = types or shared_types()
        self.troubles: Sequence[str] = ()
        self.reads: dict[str, int] = {}
        self.topics: tuple[RecordedTopic, ...] = ()
        self._samples: dict[str, list[RawSample]] = {}

    def add_topic(self, name: str, type_name: str, *qos: QoSProfile, **more: Any) -> None:  # noqa: ANN401
        """Let there be a topic."""
        found = RecordedTopic(name, type_name, qos=qos, **more)
        self.topics = tuple(sorted((*self.topics, found), key=lambda one: one.name))
        self._samples[name] = []

    def add(self, name: str, at_ns: int, payload: bytes) -> None:
        """Record a message."""
        gid = hashlib.sha256(name.encode()).digest()[:16]
        number = len(self._samples[name]) + 1
        self.put(name, RawSample(payload, Attachment(number, at_ns, gid), at_ns))

    def put(self, name: str, sample: RawSample) -> None:
        """Record a message as it came."""
        kept = self._samples[name]
        bisect.insort(kept, sample, key=lambda one: one.received_ns)
        self.topics = tuple(
            replace(one, count=len(kept)) if one.name == name else one for one in self.topics
        )

    def say(self, name: str, at_ns: int, /, **fields: Any) -> None:  # noqa: ANN401
        """Record a message of these fields."""
        kind = message(self.type_of(name))
        self.add(name, at_ns, bytes(codec_of(kind).encode(kind(**fields))))

    def type_of(self, name: str) -> str:
        """Return the type of a topic."""
        return next(one.type_name for one in self.topics if one.name == name)

    def forget(self, name: str, before_ns: int) -> None:
        """Drop the messages of a topic before a time."""
        del self._samples[name][: self._place(name, before_ns)]

    def topic(self, name: str) -> RecordedTopic | None:
        return next((one for one in self.topics if one.name == name), None)

    @property
    def begin_ns(self) -> int:
        return min((one[0].received_ns for one in self._samples.values() if one), default=0)

    @property
    def end_ns(self) -> int:
        return max((one[-1].received_ns for one in self._samples.values() if one), default=0)

    def latest(self, topics: Iterable[str], at_ns: int) -> dict[str, RawSample]:
        found = {one: self.last(one, at_ns, 1) for one in topics}
        return {name: samples[0] for name, samples in found.items() if samples}

    def last(self, topic: str, at_ns: int, most: int, since_ns: int = 0) -> list[RawSample]:
        kept = self._samples.get(topic, [])
        end = self._place(topic, at_ns + 1)
        found = kept[max(self._place(topic, since_ns), end - most) : end]
        self.reads[topic] = self.reads.get(topic, 0) + len(found)
        return found

    def messages(self, topics: Iterable[str], begin_ns: int, end_ns: int) -> Iterator[Recorded]:
        found = [
            Recorded(name, one)
            for name in topics
            for one in self._samples.get(name, [])[
                self._place(name, begin_ns) : self._place(name, end_ns)
            ]
        ]
        return iter(sorted(found, key=lambda one: one.sample.received_ns))

    def next_ns(self, topic: str, after_ns: int) -> int | None:
        kept, at = self._samples.get(topic, []), self._place(topic, after_ns + 1)
        return kept[at].received_ns if at < len(kept) else None

    def previous_ns(self, topic: str, before_ns: int) -> int | None:
        at = self._place(topic, before_ns)
        return self._samples[topic][at - 1].received_ns if at else None

    def counts(self, topic: str, begin_ns: int, end_ns: int, bins: int) -> NDArray[np.int64]:
        times = [one.received_ns for one in self._samples.get(topic, [])]
        edges = np.linspace(begin_ns, end_ns, bins + 1)
        return np.histogram([one for one in times if begin_ns <= one < end_ns], edges)[0]

    def _place(self, topic: str, at_ns: int) -> int:
        """The index of the first message at a time or after it."""
        kept = self._samples.get(topic, [])
        return bisect.bisect_left(kept, at_ns, key=lambda one: one.received_ns)
