"""A recording in memory, made by a test message by message."""

from __future__ import annotations

import bisect
import threading
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from studio.bags.recording import Recorded, RecordedTopic
from studio.bags.writer import BagWriter
from studio.ros.attachment import Attachment
from studio.ros.cdr import codec_of
from studio.ros.messages import shared_types
from studio.ros.node.samples import RawSample
from studio.ros.qos import DurabilityPolicy, QoSProfile

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence
    from pathlib import Path

    from numpy.typing import NDArray

    from studio.bags.writer import Storing
    from studio.errors import BagError
    from studio.ros.types.library import TypeLibrary

BEGIN_NS = 1_700_000_000_000_000_000
MS = 1_000_000
LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class ToldRecording:
    """Messages by `tell`, at times in ms since `BEGIN_NS`; a Recording.

    Attributes:
        fails_at_ns: Reading fails here, with `failure`.
        gate: Reading waits for it; it is open at first.
    """

    def __init__(self, types: TypeLibrary | None = None) -> None:
        self._types = types or shared_types()
        self._topics: dict[str, RecordedTopic] = {}
        self._samples: dict[str, list[RawSample]] = {}
        self.fails_at_ns: int | None = None
        self.failure: BagError | None = None
        self.gate = threading.Event()
        self.gate.set()

    def topic(
        self,
        name: str,
        type_name: str = "std_msgs/msg/String",
        *qos: QoSProfile,
        type_hash: str | None = None,
        trouble: str = "",
    ) -> None:
        """Have a topic, with what its publishers offered."""
        known = type_hash if type_hash is not None else self._types.hash_of(type_name)
        self._topics[name] = RecordedTopic(name, type_name, known, qos, 0, trouble)
        self._samples[name] = []

    def tell(self, name: str, at_ms: float, **fields: Any) -> bytes:  # noqa: ANN401
        """Have a message, by its fields; its bytes."""
        kind = self._types.message(self._topics[name].type_name)
        payload = bytes(codec_of(kind).encode(kind(**fields)))
        self.tell_bytes(name, at_ms, payload)
        return payload

    def tell_bytes(self, name: str, at_ms: float, payload: bytes) -> None:
        """Have a message as it is."""
        at_ns = BEGIN_NS + round(at_ms * MS)
        samples = self._samples[name]
        attachment = Attachment(len(samples) + 1, at_ns, b"recorded" * 2)
        bisect.insort(samples, RawSample(payload, attachment, at_ns), key=lambda one: one[2])
        self._topics[name] = replace(self._topics[name], count=len(samples))

    @property
    def begin_ns(self) -> int:
        return min((one[0].received_ns for one in self._samples.values() if one), default=0)

    @property
    def end_ns(self) -> int:
        return max((one[-1].received_ns for one in self._samples.values() if one), default=0)

    @property
    def topics(self) -> Sequence[RecordedTopic]:
        return [self._topics[name] for name in sorted(self._topics)]

    @property
    def types(self) -> TypeLibrary:
        return self._types

    @property
    def troubles(self) -> Sequence[str]:
        return ()

    def latest(self, topics: Iterable[str], at_ns: int) -> dict[str, RawSample]:
        found = {name: self.last(name, at_ns, 1) for name in topics}
        return {name: one[0] for name, one in found.items() if one}

    def last(self, topic: str, at_ns: int, most: int, since_ns: int = 0) -> list[RawSample]:
        there = [one for one in self._samples[topic] if since_ns <= one.received_ns <= at_ns]
        return there[-most:]

    def messages(self, topics: Iterable[str], begin_ns: int, end_ns: int) -> Iterator[Recorded]:
        wanted = set(topics)
        found = [
            Recorded(name, one)
            for name, samples in self._samples.items()
            for one in samples
            if name in wanted and begin_ns <= one.received_ns < end_ns
        ]
        for one in sorted(found, key=lambda one: one.sample.received_ns):
            self.gate.wait()
            if self.failure is not None and one.sample.received_ns >= (self.fails_at_ns or 0):
                raise self.failure
            yield one

    def next_ns(self, topic: str, after_ns: int) -> int | None:
        later = (one.received_ns for one in self._samples[topic] if one.received_ns > after_ns)
        return min(later, default=None)

    def previous_ns(self, topic: str, before_ns: int) -> int | None:
        sooner = (one.received_ns for one in self._samples[topic] if one.received_ns < before_ns)
        return max(sooner, default=None)

    def counts(self, topic: str, begin_ns: int, end_ns: int, bins: int) -> NDArray[np.int64]:
        times = [one.received_ns for one in self._samples[topic]]
        return np.histogram(times, bins, (begin_ns, end_ns))[0].astype(np.int64)


def written(recording: ToldRecording, folder: Path, storing: Storing | None = None) -> Path:
    """Write a recording as a bag; its folder."""
    with BagWriter(folder, recording.types, storing) as writer:
        numbers = {one.name: writer.add_topic(one) for one in recording.topics}
        end_ns = recording.end_ns + 1
        for topic, sample in recording.messages(numbers, recording.begin_ns, end_ns):
            writer.write(numbers[topic], sample)
    return folder
