"""Recording: messages of the past by topic and time, whether files or memory hold them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, NamedTuple, Protocol

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence
    from pathlib import Path

    import numpy as np
    from numpy.typing import NDArray

    from studio.ros.node.samples import RawSample
    from studio.ros.qos import QoSProfile
    from studio.ros.types.library import TypeLibrary

LATCHED_BY_NAME: Final = frozenset({"/tf_static", "/robot_description", "/map"})
"""Taken as latched where a recording does not say how they were published."""
KEPT_MAX: Final = 1_000
"""So many messages of a latched topic are given to late subscribers at most."""
_DEPTH_UNKNOWN: Final = 10
"""That of a publisher whose depth was not recorded, as with DDS: ROS's usual one."""
_TRANSFORM_TYPE: Final = "tf2_msgs/msg/TFMessage"


@dataclass(frozen=True, slots=True)
class RecordedTopic:
    """A topic of a recording.

    Attributes:
        name: Full name.
        type_name: As `std_msgs/msg/String`.
        type_hash: As in liveliness tokens, `RIHS01_…`; empty: the recording has none.
        qos: What its publishers offered; empty: the recording does not say.
        count: Messages of it.
        trouble: Why its messages cannot be read here, in a sentence; empty: they can.
        note: What is left out of it, in a sentence, as of a large topic that is thinned.
        encoding: Of its messages; in ROS 2 that is `cdr`.
    """

    name: str
    type_name: str
    type_hash: str = ""
    qos: tuple[QoSProfile, ...] = ()
    count: int = 0
    trouble: str = ""
    note: str = ""
    encoding: str = "cdr"

    @property
    def is_latched(self) -> bool:
        """Whether a publisher offered its last messages to late subscribers, as far as is known."""
        if not self.qos:
            return self.name in LATCHED_BY_NAME
        from studio.ros.qos import DurabilityPolicy  # noqa: PLC0415 - values alone need none of ros

        return any(one.durability is DurabilityPolicy.TRANSIENT_LOCAL for one in self.qos)


def latched_count(topic: RecordedTopic) -> int:
    """Return how many last messages of a latched topic a late subscriber would have been given.

    Each publisher gives as many as it keeps, and a bag does not tell whose a message is: of their
    last ones together those of a quiet publisher may be missing, the more the fewer are taken.
    So the depths are added up. Static transforms add up besides, and a bag does not tell of
    publishers that came after its topic was first met: of those all are taken that may be.
    """
    from studio.ros.qos import HistoryPolicy  # noqa: PLC0415 - values alone need none of ros

    if topic.type_name == _TRANSFORM_TYPE:
        return KEPT_MAX
    kept = [
        KEPT_MAX if one.history is HistoryPolicy.KEEP_ALL else one.depth or _DEPTH_UNKNOWN
        for one in topic.qos
    ]
    return min(KEPT_MAX, sum(kept) or _DEPTH_UNKNOWN)


class Recorded(NamedTuple):
    """A message and its topic."""

    topic: str
    sample: RawSample


class Split(NamedTuple):
    """The place at which one file of a bag ends and the next begins; `begin_ns` is the next's."""

    begin_ns: int
    closed: Path
    opened: Path


class Recording(Protocol):
    """Messages by time of reception, ns since the Unix epoch.

    In a `RawSample` of it, `received_ns` is the time at which the message was recorded, and the
    attachment has the number within its topic, the time of publishing, and a GID that is the same
    for all messages of a topic. Thread-safe. What reads files may wait: call it in a thread.

    Each method raises a BagError where the file cannot be read any more; a damaged part is left
    out, and `troubles` says so.
    """

    @property
    def begin_ns(self) -> int:
        """When the first message came; 0 without one."""
        ...

    @property
    def end_ns(self) -> int:
        """When the last message came; 0 without one."""
        ...

    @property
    def topics(self) -> Sequence[RecordedTopic]:
        """All topics by name."""
        ...

    @property
    def types(self) -> TypeLibrary:
        """Message types as the recording defines them; where it does not, as the studio does."""
        ...

    @property
    def troubles(self) -> Sequence[str]:
        """What is damaged or left out, a sentence each."""
        ...

    def topic(self, name: str) -> RecordedTopic | None:
        """Return a topic; None: there is none of that name."""
        ...

    def latest(self, topics: Iterable[str], at_ns: int) -> dict[str, RawSample]:
        """Return the newest sample of each topic at or before a time."""
        ...

    def last(self, topic: str, at_ns: int, most: int, since_ns: int = 0) -> list[RawSample]:
        """Return the newest samples in [since_ns, at_ns], at most so many, the oldest first."""
        ...

    def messages(self, topics: Iterable[str], begin_ns: int, end_ns: int) -> Iterator[Recorded]:
        """Yield the messages of some topics in [begin_ns, end_ns), in the order of their times."""
        ...

    def next_ns(self, topic: str, after_ns: int) -> int | None:
        """Return the time of the first message of a topic after a time."""
        ...

    def previous_ns(self, topic: str, before_ns: int) -> int | None:
        """Return the time of the last message of a topic before a time."""
        ...

    def counts(self, topic: str, begin_ns: int, end_ns: int, bins: int) -> NDArray[np.int64]:
        """Return how many messages of a topic lie in each of so many equal parts of a range."""
        ...
