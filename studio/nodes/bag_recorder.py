"""BagRecorder: records the topics of a ROS system into a bag, also those that come later.

Try: `studio bag record -a -o first`, then `studio bag info first`.
"""

from __future__ import annotations

import threading
import time
from collections import deque
from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING, Final

from studio.bags.definition_text import definition_text
from studio.bags.recording import RecordedTopic
from studio.bags.writer import BagWriter, Storing
from studio.bags.writing_thread import WAITING_BYTES_MAX, TopicInput, WritingThread
from studio.errors import StudioError
from studio.nodes.recorded_topics import TopicChoice, adapted
from studio.ros.node.raw_subscription import RawSubscription
from studio.ros.profiles import NO_HASH
from studio.ros.tokens import EndpointKind
from studio.ros.type_lookup import learn_from_any

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from pathlib import Path

    from studio.bags.writer import Written
    from studio.ros.graph.endpoints import GraphEndpoint
    from studio.ros.node.node import Node
    from studio.ros.node.samples import RawSample
    from studio.ros.qos import QoSProfile

_LOOK_EVERY_S: Final = 2.0
"""Between two looks at the graph where it did not change: a subscription may have been refused."""


@dataclass(frozen=True, slots=True)
class RecordSettings:
    """How topics are recorded.

    Attributes:
        topics: Which ones.
        storing: How they are written.
        qos: Of topics that are not subscribed as their publishers offer.
        discovers: Whether topics that come later are recorded as well.
        polling_s: Between two looks at the graph while it changes.
        waiting_bytes_max: May wait to be written; of snapshots, are kept.
        is_paused: Whether it begins with a pause.
        snapshots: Messages are kept in memory, and written when `snapshot` is called.
        snapshot_s: Messages are kept for so long; 0: as long as there is room.
        uses_node_time: Messages have the time of the node's clock, which /clock may set.
    """

    topics: TopicChoice
    storing: Storing = field(default_factory=Storing)
    qos: Mapping[str, QoSProfile] = field(default_factory=dict[str, "QoSProfile"])
    discovers: bool = True
    polling_s: float = 0.1
    waiting_bytes_max: int = WAITING_BYTES_MAX
    is_paused: bool = False
    snapshots: bool = False
    snapshot_s: float = 0.0
    uses_node_time: bool = False


@dataclass(frozen=True, slots=True)
class TopicCount:
    """What was recorded of a topic; `lost` was sent and is not in the bag."""

    name: str
    type_name: str
    count: int
    lost: int
    bytes: int


class _Line:
    """A topic that is recorded: its way into the bag, and its subscription."""

    def __init__(self, topic: RecordedTopic) -> None:
        self.input = TopicInput(topic)
        self.subscription: RawSubscription | None = None

    def count(self) -> TopicCount:
        """Return what was recorded."""
        taken, missed = self.input, self.subscription.lost if self.subscription else 0
        topic = taken.topic
        return TopicCount(
            topic.name, topic.type_name, taken.count, taken.lost + missed, taken.bytes
        )


class BagRecorder:
    """Records from its making until `close`; thread-safe.

    Args:
        node: Whose subscriptions it makes.
        folder: Of the new bag.
        settings: What is recorded, and how.
        say: Takes sentences for the terminal, from several threads; a warning begins so.
        ended: Called in a thread where the bag cannot be written any further.

    Raises:
        BagNotWrittenError: The bag cannot be begun.
        SettingsError: What is asked for does not go together.
    """

    def __init__(
        self,
        node: Node,
        folder: Path,
        settings: RecordSettings,
        say: Callable[[str], object],
        ended: Callable[[], object] | None = None,
    ) -> None:
        settings.topics.check()
        self._node, self._settings, self._say = node, settings, say
        self._is_paused = settings.is_paused
        writer = BagWriter(folder, node.wire.types, settings.storing)
        writer.on_split = self._note_split
        self.on_split: Callable[[Path, Path], object] | None = None
        """Called in a thread with the file that is complete and the one that begins."""
        self._path = writer.path
        self._writing = WritingThread(writer, settings.waiting_bytes_max, ended)
        self._snapshots = _Snapshots(settings) if settings.snapshots else None
        self._lines: dict[str, _Line] = {}
        self._refused: set[str] = set()
        """Topics that cannot be recorded, as was said."""
        self._asked: set[str] = set()
        """Types that were asked for, where they were not known."""
        self._is_closing = False
        self._turn = threading.Lock()
        self._has_changed = threading.Event()
        self._is_discovering = settings.discovers
        self.look()
        self._forget = node.graph.on_change(self._has_changed.set)
        self._thread = threading.Thread(target=self._discover, name="bag topics", daemon=True)
        self._thread.start()

    @property
    def path(self) -> Path:
        """The folder of the bag."""
        return self._path

    @property
    def trouble(self) -> str:
        """Why the bag ended by itself, in a sentence; else empty."""
        return self._writing.trouble

    @property
    def size(self) -> int:
        """Bytes of the bag."""
        return self._writing.size

    @property
    def kept_bytes(self) -> int:
        """Bytes in memory that wait for a snapshot."""
        return 0 if self._snapshots is None else self._snapshots.bytes

    @property
    def is_paused(self) -> bool:
        """Whether what comes is left out."""
        return self._is_paused

    @property
    def is_discovering(self) -> bool:
        """Whether topics that come are recorded as well."""
        return self._is_discovering

    def counts(self) -> list[TopicCount]:
        """Return what was recorded of each topic, by name."""
        return [line.count() for _, line in sorted(self._lines.items())]

    def pause(self) -> None:
        """Leave out what comes; again is harmless."""
        self._is_paused = True

    def resume(self) -> None:
        """Record again."""
        self._is_paused = False

    def discover(self, *, wanted: bool) -> None:
        """Record topics that come from now on, or no others than those that are recorded."""
        self._is_discovering = wanted
        self._has_changed.set()

    def split(self) -> None:
        """Let another file begin."""
        self._writing.split()

    def snapshot(self) -> bool:
        """Write what is kept in memory; False where it keeps none."""
        if self._snapshots is None:
            return False
        self._snapshots.write(self._writing)
        return True

    def close(self) -> Written:
        """End; the bag is whole then, and `trouble` says whether all that came is in it."""
        self._is_closing = True
        self._forget()
        self._has_changed.set()
        if self._thread is not threading.current_thread():
            self._thread.join()
        with self._turn:
            for line in self._lines.values():
                if line.subscription is not None:
                    line.subscription.close()
        return self._writing.close()

    def look(self) -> None:
        """Record the topics that are there now."""
        graph = self._node.graph
        published = graph.all_of(EndpointKind.PUBLISHER)
        subscribed = graph.all_of(EndpointKind.SUBSCRIPTION)
        with self._turn:
            for name in sorted(published.keys() | subscribed.keys()):
                if name not in self._lines and name not in self._refused and not self._is_closing:
                    self._consider(name, published.get(name, ()), subscribed.get(name, ()))

    def _note_split(self, closed: Path, opened: Path) -> None:
        if self.on_split is not None:
            self.on_split(closed, opened)

    def _discover(self) -> None:
        while not self._is_closing:
            self._has_changed.wait(_LOOK_EVERY_S)
            self._has_changed.clear()
            if self._is_discovering and not self._is_closing:
                self.look()
                time.sleep(self._settings.polling_s)

    def _consider(
        self, name: str, published: Sequence[GraphEndpoint], subscribed: Sequence[GraphEndpoint]
    ) -> None:
        choice, own = self._settings.topics, self._node.wire.zid
        ends = [*published] or [*(subscribed if choice.unpublished else ())]
        types = sorted({one.type_name for one in ends})
        if not types or not any(choice.takes(name, one) for one in types):
            return
        if choice.ignore_leaves and all(one.node.zid == own for one in subscribed):
            return
        if len(types) > 1:
            self._refuse(
                name,
                f"Topic '{name}' has more than one type associated. Only topics with one type are "
                f"supported: {', '.join(types)}",
            )
            return
        try:
            self._subscribe(name, ends[0], [one.qos for one in published])
        except StudioError as error:
            self._refuse(name, f"Topic '{name}' is not recorded: {error}")

    def _refuse(self, name: str, sentence: str) -> None:
        self._refused.add(name)
        self._say(f"WARNING: {sentence}")

    def _subscribe(self, name: str, end: GraphEndpoint, offered: Sequence[QoSProfile]) -> None:
        found = adapted(name, offered)
        for warning in found.warnings:
            self._say(f"WARNING: {warning}")
        qos = self._settings.qos.get(name, found.qos)
        self._learn(end)
        known_hash = "" if end.type_hash == NO_HASH else end.type_hash
        once = tuple(one for place, one in enumerate(offered) if one not in offered[:place])
        line = _Line(RecordedTopic(name, end.type_name, known_hash, once))
        take = partial(self._take, line.input)
        line.subscription = RawSubscription(
            self._node, name, end.type_name, end.type_hash, qos, take
        )
        self._lines[name] = line
        self._writing.announce(line.input)
        self._say(f"Subscribed to topic '{name}'")

    def _learn(self, end: GraphEndpoint) -> None:
        """Ask other nodes for a type that is not known, once; without it, say so."""
        types, name = self._node.wire.types, end.type_name
        if name in self._asked:
            return
        self._asked.add(name)
        if not definition_text(types, name):
            learn_from_any(self._node, self._node.graph.publishers(end.name), lambda _: None)
        if not definition_text(types, name, end.type_hash):
            self._say(
                f"WARNING: The type {name} is not known here in the form that {end.node.path} has: "
                "its messages are recorded, its definition is left out."
            )

    def _take(self, topic: TopicInput, samples: list[RawSample], _count: int, size: int) -> None:
        if self._is_paused:
            return
        if self._settings.uses_node_time:
            clock = self._node.get_clock()
            if not clock.ros_time_is_active:
                return
            now_ns = clock.now_ns()
            samples = [one._replace(received_ns=now_ns) for one in samples]
        if self._snapshots is None:
            self._writing.post(topic, samples, size)
        else:
            self._snapshots.keep(topic, samples, size)


class _Snapshots:
    """The newest messages, kept in memory until a snapshot is wanted."""

    def __init__(self, settings: RecordSettings) -> None:
        self._most_bytes = settings.waiting_bytes_max
        self._kept_ns = int(settings.snapshot_s * 1e9)
        self._kept: deque[tuple[TopicInput, list[RawSample], int]] = deque()
        self.bytes = 0
        self._lock = threading.Lock()
        self._has_written = False

    def keep(self, topic: TopicInput, samples: list[RawSample], size: int) -> None:
        """Keep samples, and let go of what is too old."""
        now_ns = samples[-1].received_ns
        with self._lock:
            self._kept.append((topic, samples, size))
            self.bytes += size
            while len(self._kept) > 1 and self._is_too_old(now_ns):
                self.bytes -= self._kept.popleft()[2]

    def write(self, writing: WritingThread) -> None:
        """Let all that is kept be written into a file of its own."""
        with self._lock:
            kept, self._kept, self.bytes = self._kept, deque(), 0
        if self._has_written:
            writing.split()
        self._has_written = True
        for one in kept:
            writing.post(*one)

    def _is_too_old(self, now_ns: int) -> bool:
        if self.bytes > self._most_bytes:
            return True
        oldest_ns = self._kept[0][1][-1].received_ns
        return self._kept_ns > 0 and now_ns - oldest_ns > self._kept_ns
