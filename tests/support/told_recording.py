"""A recording in memory, made by a test message by message."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING, Any

from studio.bags.writer import BagWriter
from studio.ros.cdr import codec_of
from studio.ros.qos import DurabilityPolicy, QoSProfile
from tests.support.memory_recording import MemoryRecording

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator
    from pathlib import Path

    from studio.bags.recording import Recorded
    from studio.bags.writer import Storing
    from studio.errors import BagError
    from studio.ros.types.library import TypeLibrary

BEGIN_NS = 1_700_000_000_000_000_000
MS = 1_000_000
LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class ToldRecording(MemoryRecording):
    """Messages by `tell`, at times in ms since `BEGIN_NS`.

    Attributes:
        fails_at_ns: Reading fails here, with `failure`.
        gate: Reading waits for it; it is open at first.
    """

    def __init__(self, types: TypeLibrary | None = None) -> None:
        super().__init__(types)
        self.fails_at_ns: int | None = None
        self.failure: BagError | None = None
        self.gate = threading.Event()
        self.gate.set()

    def add_topic(
        self,
        name: str,
        type_name: str = "std_msgs/msg/String",
        *qos: QoSProfile,
        **more: Any,  # noqa: ANN401
    ) -> None:
        """Have a topic, with what its publishers offered."""
        known = {} if "type_hash" in more else {"type_hash": self.types.hash_of(type_name)}
        super().add_topic(name, type_name, *qos, **known, **more)

    def tell(self, name: str, at_ms: float, **fields: Any) -> bytes:  # noqa: ANN401
        """Have a message, by its fields; its bytes."""
        kind = self.types.message(self.type_of(name))
        payload = bytes(codec_of(kind).encode(kind(**fields)))
        self.tell_bytes(name, at_ms, payload)
        return payload

    def tell_bytes(self, name: str, at_ms: float, payload: bytes) -> None:
        """Have a message as it is."""
        self.add(name, BEGIN_NS + round(at_ms * MS), payload)

    def messages(self, topics: Iterable[str], begin_ns: int, end_ns: int) -> Iterator[Recorded]:
        for one in super().messages(topics, begin_ns, end_ns):
            self.gate.wait()
            if self.failure is not None and one.sample.received_ns >= (self.fails_at_ns or 0):
                raise self.failure
            yield one


def written(recording: ToldRecording, folder: Path, storing: Storing | None = None) -> Path:
    """Write a recording as a bag; its folder."""
    with BagWriter(folder, recording.types, storing) as writer:
        numbers = {one.name: writer.add_topic(one) for one in recording.topics}
        end_ns = recording.end_ns + 1
        for topic, sample in recording.messages(numbers, recording.begin_ns, end_ns):
            writer.write(numbers[topic], sample)
    return folder
