"""What a recording must answer, worked out the long way from what the libraries read of its file.

The libraries give all messages; each question is answered here by looking at every one of them.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Final

from mcap.reader import NonSeekingReader
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer

from tests.support.bags import BEGIN_NS, STRING
from tests.support.written_bags import told_by_rosbags

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from pathlib import Path

    from studio.bags.bag import Bag
    from studio.ros.node.samples import RawSample
    from tests.support.written_bags import Told

HASH: Final = "RIHS01_" + "0" * 64
ROSBAGS: Final = {
    "mcap": (StoragePlugin.MCAP, CompressionMode.NONE),
    "mcap, chunks": (StoragePlugin.MCAP, CompressionMode.STORAGE),
    "mcap, messages": (StoragePlugin.MCAP, CompressionMode.MESSAGE),
    "mcap, file": (StoragePlugin.MCAP, CompressionMode.FILE),
    "sqlite3": (StoragePlugin.SQLITE3, CompressionMode.NONE),
    "sqlite3, messages": (StoragePlugin.SQLITE3, CompressionMode.MESSAGE),
    "sqlite3, file": (StoragePlugin.SQLITE3, CompressionMode.FILE),
}
"""What rosbags can write, by its name."""


def write_rosbags(folder: Path, told: Iterable[Told], manner: str) -> Path:
    """Write a bag of `std_msgs/msg/String` with rosbags; see `ROSBAGS`."""
    storage, mode = ROSBAGS[manner]
    writer = Writer(folder, version=9, storage_plugin=storage)
    writer.set_compression(mode, CompressionFormat.ZSTD)
    with writer:
        known = {
            topic: writer.add_connection(topic, "std_msgs/msg/String", msgdef=STRING, rihs01=HASH)
            for topic in sorted({one[0] for one in told})
        }
        for topic, at_ns, payload in told:
            writer.write(known[topic], at_ns, payload)
    return folder


def oracle_of_mcap(file: Path) -> Oracle:
    """What mcap's own reader finds from the first byte to the last, without any index."""
    with file.open("rb") as stream:
        found = NonSeekingReader(stream).iter_messages(log_time_order=False)
        return Oracle([(channel.topic, one.log_time, one.data) for _, channel, one in found])


def oracle_of_rosbags(folder: Path) -> Oracle:
    """What rosbags' own reader finds."""
    return Oracle(told_by_rosbags(folder))


@dataclass(frozen=True, slots=True)
class Oracle:
    """Messages in the order of a file; those of one time are answered in that order."""

    told: Sequence[Told]

    def between(self, topics: Iterable[str], begin_ns: int, end_ns: int) -> list[Told]:
        """All in [begin_ns, end_ns), by time."""
        wanted = set(topics)
        found = [one for one in self.told if one[0] in wanted and begin_ns <= one[1] < end_ns]
        return sorted(found, key=lambda one: one[1])

    def times(self, topic: str) -> list[int]:
        """When the messages of a topic came."""
        return sorted(one[1] for one in self.told if one[0] == topic)

    def last(self, topic: str, at_ns: int, most: int, since_ns: int) -> list[Told]:
        """The newest in [since_ns, at_ns]."""
        found = self.between([topic], since_ns, at_ns + 1)
        return found[max(0, len(found) - most) :]

    def counts(self, topic: str, edges: Sequence[int]) -> list[int]:
        """How many lie between each two times."""
        times = self.times(topic)
        return [sum(begin <= one < end for one in times) for begin, end in pairwise(edges)]


def check_all_answers(bag: Bag, oracle: Oracle, last_ns: int) -> None:
    """Ask a bag everything at each ns of a short recording from `BEGIN_NS` to `last_ns` on."""
    topics = sorted({one[0] for one in oracle.told})
    assert [(one.name, one.count) for one in bag.topics if one.count] == [
        (topic, len(oracle.times(topic))) for topic in topics
    ]
    times = [one[1] for one in oracle.told]
    assert bag.message_count == len(times)
    assert (bag.begin_ns, bag.end_ns) == ((min(times), max(times)) if times else (0, 0))
    moments = range(BEGIN_NS - 2, BEGIN_NS + last_ns + 3)
    for at_ns in moments:
        _check_moment(bag, oracle, at_ns, [*topics, "/nobody"])
    for begin_ns in moments[::7]:
        for end_ns in moments[::5]:
            found = bag.messages(topics[:2], begin_ns, end_ns)
            expected = oracle.between(topics[:2], begin_ns, end_ns)
            assert [_told(topic, one) for topic, one in found] == expected
    for topic in topics:
        edges = [BEGIN_NS - 2 + 5 * k for k in range(12)]
        counts = bag.counts(topic, edges[0], edges[-1], len(edges) - 1)
        assert counts.tolist() == oracle.counts(topic, edges)


def _check_moment(bag: Bag, oracle: Oracle, at_ns: int, topics: Sequence[str]) -> None:
    latest = {topic: found[0] for topic in topics if (found := oracle.last(topic, at_ns, 1, 0))}
    assert {topic: _told(topic, one) for topic, one in bag.latest(topics, at_ns).items()} == latest
    for topic in topics:
        times = oracle.times(topic)
        assert bag.next_ns(topic, at_ns) == min((t for t in times if t > at_ns), default=None)
        assert bag.previous_ns(topic, at_ns) == max((t for t in times if t < at_ns), default=None)
        for most, since_ns in ((0, 0), (3, 0), (100, at_ns - 4)):
            found = bag.last(topic, at_ns, most, since_ns)
            expected = oracle.last(topic, at_ns, most, since_ns)
            assert [_told(topic, one) for one in found] == expected


def _told(topic: str, one: RawSample) -> Told:
    return topic, one.received_ns, bytes(one.payload)
