"""RecordingSource: the topics of a recording, as they were at the moment where it stands."""

from __future__ import annotations

import itertools
import logging
import threading
import time
from dataclasses import replace
from typing import TYPE_CHECKING, Final

from typing_extensions import override

from studio.bags.recording import latched_count
from studio.errors import (
    BagError,
    RecordingError,
    RosNameError,
    StudioError,
    UnknownTypeError,
)
from studio.live.time.moments import TF, TF_MAX, Moments, Wanted, is_latched, numbered
from studio.live.time.playhead import Playhead
from studio.live.topics.request import DEPTH_MAX, Endpoint
from studio.live.topics.shared_source import SharedSource
from studio.live.topics.source import Topic
from studio.live.topics.subscription import Stream
from studio.ros.qos import DurabilityPolicy, QoSProfile

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

    from studio.bags.recording import Recorded, RecordedTopic, Recording
    from studio.live.topics.request import Fit
    from studio.live.topics.source import Connection
    from studio.live.topics.subscription import Subscription
    from studio.ros.node.samples import RawSample
    from studio.ros.node.topic_statistics import Flow
    from studio.ros.types.library import TypeLibrary

FAR_NS: Final = 5_000_000_000
"""A jump ahead by more than this begins a new epoch, as one back does."""
_TICK_S: Final = 0.008
_READING_S: Final = 0.05
"""So long a tick reads at most."""
_LATE_NS: Final = 200_000_000
"""Where reading is too slow, and the time falls behind by more, messages are left out."""
_SKIPPING_S: Final = 3.0
"""So long it is said that messages were left out."""
_ELAPSED_MAX_NS: Final = 250_000_000
"""Time does not go further in a tick, as after the machine slept."""
_AHEAD_NS: Final = 300_000_000
_AHEAD_MAX: Final = 200
"""Messages wait that long for their transforms, and so many come then."""
_FLOW_NS: Final = 2_000_000_000
_SILENT_S: Final = 3.0
_WINDOW_MAX: Final = 10_000
_RUN_MAX: Final = 256
_FIRST: Final = ("/clock", "/tf_static", TF)
"""What others need to be drawn comes before them."""
_FAULT: Final = "The recording cannot be shown: the terminal says why."

_log = logging.getLogger(__name__)


class _Reader:
    """The subscription behind a stream: a topic that is read."""

    lost = 0

    def __init__(self, source: RecordingSource, topic: RecordedTopic, stream: Stream) -> None:
        self._source, self.topic, self.stream = source, topic, stream
        self.given: Mapping[int, int] = {}
        """The messages that it was given for the moment, by number; when they came."""

    @property
    def wanted(self) -> Wanted:
        """What it needs of the recording."""
        return Wanted(self.topic, self.stream.depth)

    def read(self, *, newest_only: bool) -> None:
        """Read all: nothing is copied for those who want only the newest."""

    def hurry(self, *, wanted: bool) -> None:
        """Do nothing: all come in time."""

    def deepen(self, depth: int, swapped: Callable[[], object]) -> None:
        """Read further back."""
        del depth
        swapped()
        self._source.give_again(self)

    def close(self) -> None:
        """Read it no more."""
        self._source.forget(self)


class RecordingSource(SharedSource):
    """Plays a recording to whoever subscribes, and gives whom comes later what there is now.

    A thread of its own reads, and hands samples over. After a jump each subscription has the state
    of that moment: the newest, or as much as is latched, and of TF what a buffer remembers.

    Args:
        recording: What is played.
        node: Full name of the node that publishes all of it, as far as anybody can tell.
        at_ns: Where it stands at first.
        settling: Held while a jump replaces what all have been given.
    """

    def __init__(
        self,
        recording: Recording,
        node: str = "/bag",
        at_ns: int | None = None,
        settling: threading.Lock | None = None,
    ) -> None:
        super().__init__()
        self.recording, self._node = recording, node
        self._settling = settling or threading.Lock()
        self._moments = Moments(recording)
        self._head = Playhead(recording.begin_ns if at_ns is None else at_ns)
        self._heads = threading.Lock()
        self._given_ns = self._head.at_ns
        """All up to this time was given to all who subscribe."""
        self._is_rough = False
        """Whether the last jump left out what takes long."""
        self._wanted_jump: tuple[int, bool] | None = None
        self._jumped: list[Callable[[StudioError | None], object]] = []
        self._readers: dict[_Reader, None] = {}
        self._reading: Iterator[Recorded] = iter(())
        self._next: Recorded | None = None
        self._later: Sequence[RawSample] = ()
        self._later_at_ns = -1
        self._begins_reading, self._read_end_ns = True, 0
        self._feeding = threading.RLock()
        """Held while anybody is given anything."""
        self._due_to_fit = self._closed = False
        self._ticked_ns = time.monotonic_ns()
        self._late_ns = 0
        """By how much the time stayed behind in the last ticks without a pause."""
        self._skipped_s = -_SKIPPING_S
        self._wake = threading.Event()
        self.on_stop: Callable[[str], object] = _nothing
        """Called in the thread when it came to its end, or could not be read: then why."""
        self._thread = threading.Thread(target=self._run, name="recording", daemon=True)
        self._thread.start()

    # Time

    @property
    def is_skipping(self) -> bool:
        """Whether messages were left out just now, for they are read more slowly than played."""
        return self.playhead.playing and time.monotonic() - self._skipped_s < _SKIPPING_S

    @property
    def playhead(self) -> Playhead:
        """Where it stands now."""
        return self._head

    def change(self, change: Callable[[Playhead], Playhead]) -> None:
        """Change how the time goes on; where it goes elsewhere, that is a jump."""
        with self._heads:
            before = self._head
            after = change(before)
            self._head = replace(after, at_ns=before.at_ns)
            if after.playing and not before.playing:
                self._ticked_ns = time.monotonic_ns()
        if after.at_ns != before.at_ns:
            self.jump(after.at_ns)
        self._wake.set()

    def jump(
        self,
        at_ns: int,
        jumped: Callable[[StudioError | None], object] | None = None,
        *,
        settled: bool = True,
    ) -> None:
        """Go to another moment soon; of several jumps that wait only the last is made.

        Args:
            at_ns: The moment.
            jumped: Called in the thread once all have been given what there is then, with what
                went wrong.
            settled: Whether it stays there: else what takes longer is left out.
        """
        with self._heads:
            self._wanted_jump = at_ns, settled
            if jumped is not None:
                self._jumped.append(jumped)
        self._wake.set()

    def close(self) -> None:
        """Play no more; in a thread."""
        self._closed = True
        self._wake.set()
        if threading.current_thread() is not self._thread:
            self._thread.join()
        with self._feeding, self.fitting:  # in the order of `fit_all`
            self.end_all()

    # The source

    @property
    @override
    def is_live(self) -> bool:
        return False

    @property
    @override
    def now_ns(self) -> int:
        return self._head.at_ns

    @property
    @override
    def later_tf(self) -> Sequence[RawSample]:
        return () if self._head.playing else self._later

    @property
    @override
    def types(self) -> TypeLibrary:
        return self.recording.types

    @property
    @override
    def connection(self) -> Connection:
        return "none" if self._closed else "there"

    @override
    def catalogue(self) -> list[Topic]:
        return [
            Topic(one.name, (one.type_name,), self._ends(one), ()) for one in self.recording.topics
        ]

    @override
    def publishers(self, topic: str) -> Sequence[Endpoint]:
        found = self._topic(topic)
        return () if found is None else self._ends(found)

    @override
    def senders(self, topic: str) -> frozenset[bytes]:
        return frozenset()

    @override
    def sender(self, gid: bytes) -> str | None:
        return self._node

    @override
    def own_hash(self, type_name: str) -> str | None:
        from studio.ros.messages import shared_types  # noqa: PLC0415 - takes its time

        try:
            return shared_types().hash_of(type_name)
        except (UnknownTypeError, RosNameError):
            return None

    @override
    def deepened(self, topic: str, fit: Fit) -> Fit:
        recorded = self._topic(topic)
        return fit if recorded is None else fit._replace(depth=_depth(recorded, fit.depth))

    @override
    def begin(self, topic: str, fit: Fit) -> Stream:
        stream = Stream(fit, lambda made: self.open(topic, fit, made), self.hand_over, keeps=True)
        for one in tuple(self._readers):
            if one.stream is stream:
                self.give_again(one)
        return stream

    @override
    def open(self, topic: str, fit: Fit, stream: Stream) -> _Reader:
        recorded = self._topic(topic)
        if recorded is None:
            raise RecordingError(f"{topic} is not in the recording.")
        if recorded.trouble:
            raise RecordingError(recorded.trouble)
        reader = _Reader(self, recorded, stream)
        if fit.type_hash in {None, self._hash_of(recorded)}:
            self._readers[reader] = None
            self._begins_reading = True
        return reader

    @override
    def measure(self, topic: str, kept_s: float) -> None:
        return None

    @override
    def flows(self, topics: Iterable[str]) -> dict[str, Flow]:
        """Return how messages came in the two seconds before."""
        names = [one for one in topics if self._topic(one) is not None]
        at_ns = self._head.at_ns
        try:
            newest = self.recording.latest(names, at_ns)
            return {one: self._flow(one, newest.get(one), at_ns) for one in names}
        except BagError as error:
            _log.warning("Rates of a recording are not known: %s", error)
            return {}

    @override
    def latest(self, topics: Iterable[str], at_ns: int) -> dict[str, RawSample]:
        return self.recording.latest(topics, at_ns)

    @override
    def window(self, topic: str, begin_ns: int, end_ns: int) -> list[RawSample]:
        return self.recording.last(topic, end_ns - 1, _WINDOW_MAX, begin_ns)

    @override
    def refit(self) -> None:
        self._due_to_fit = True
        self._wake.set()

    @override
    def fit_all(self) -> None:
        with self._feeding:
            super().fit_all()

    @override
    def hand_over(self, subscription: Subscription) -> None:
        subscription.hand_over()

    # What follows is for the readers.

    def give_again(self, reader: _Reader) -> None:
        """Give what there is now to a stream that has nothing yet, or not enough."""
        with self._feeding:
            try:
                found = self._moments.at([reader.wanted], self._given_ns)[reader.topic.name]
            except BagError as error:
                raise RecordingError(str(error)) from error
            reader.given = numbered(found)
            reader.stream.take_past(found)

    def forget(self, reader: _Reader) -> None:
        """Read a topic no more for a stream."""
        with self._feeding:
            self._readers.pop(reader, None)
            self._begins_reading = True

    # What follows is the thread's.

    def _run(self) -> None:
        while not self._closed:
            self._wake.wait(_TICK_S if self._head.playing else None)
            self._wake.clear()
            try:
                self._step()
            except StudioError as error:
                self._begins_reading = True  # who plays on is told again
                self._stop(str(error))
            except Exception:  # noqa: BLE001 - what fails once must not end the rest
                _log.exception("A tick of a recording failed.")
                self._stop(_FAULT)
        self._make_jump()  # nobody waits for one any more

    def _step(self) -> None:
        if self._due_to_fit:
            self._due_to_fit = False
            self.fit_all()
        if self._wanted_jump is not None:
            self._make_jump()
        if self._head.playing:
            self._go_on()
        elif self._later_at_ns != self._given_ns:
            self._look_ahead(self._given_ns)

    def _stop(self, why: str) -> None:
        with self._heads:
            self._head = replace(self._head, playing=False)
        self.on_stop(why)

    def _make_jump(self) -> None:
        with self._heads:
            jump, self._wanted_jump = self._wanted_jump, None
            jumped, self._jumped = self._jumped, []
        trouble: StudioError | None = None
        try:
            if jump is not None:
                self._go_to(jump[0], settled=jump[1])
        except StudioError as error:
            trouble = error
        except Exception:  # noqa: BLE001 - those who wait must not wait for ever
            _log.exception("A moment of a recording could not be shown.")
            trouble = RecordingError(_FAULT)
        for one in jumped:
            one(trouble)

    def _go_to(self, at_ns: int, *, settled: bool) -> None:
        """Give all what there is at a time."""
        begin_ns, end_ns = self.recording.begin_ns, self.recording.end_ns
        at_ns = max(begin_ns, min(end_ns, at_ns))
        with self._feeding:
            goes_on = 0 <= at_ns - self._given_ns <= FAR_NS and not (settled and self._is_rough)
            since_ns = self._given_ns + 1 if goes_on else 0
            readers = sorted(self._readers, key=_place)
            wanted: dict[str, Wanted] = {}
            for one in readers:
                name = one.topic.name
                if name not in wanted or wanted[name].depth < one.stream.depth:
                    wanted[name] = one.wanted
            found = self._moments.at(wanted.values(), at_ns, since_ns, settled=settled)
            if not self._head.playing:
                self._look_ahead(at_ns)
            with self._settling:
                self._give(readers, found, goes_on=goes_on)
                self._given_ns, self._is_rough = at_ns, not settled
                self._begins_reading = True
                with self._heads:
                    self._head = self._head.within(at_ns, begin_ns, end_ns)
                    self._ticked_ns = time.monotonic_ns()

    def _give(
        self, readers: Sequence[_Reader], found: Mapping[str, list[RawSample]], *, goes_on: bool
    ) -> None:
        of_each = {one: _newest(found[one.topic.name], one.stream.depth) for one in readers}
        if goes_on:
            for reader, samples in of_each.items():
                reader.given = {} if samples else reader.given
                reader.stream.take_past(samples)
            return
        others = [one for one in readers if not _stays(one, of_each[one])]
        self.change_epoch([each for one in others for each in one.stream.subscribers()])
        for reader in others:
            reader.given = numbered(of_each[reader])
            reader.stream.begin_anew(of_each[reader])

    def _look_ahead(self, at_ns: int) -> None:
        """Read the transforms for which messages wait that are there at a time."""
        self._later_at_ns = at_ns
        is_wanted = any(one.topic.name == TF for one in self._readers)
        until_ns = at_ns + _AHEAD_NS
        found = self.recording.messages([TF], at_ns + 1, until_ns) if is_wanted else ()
        self._later = [one.sample for one in itertools.islice(found, _AHEAD_MAX)]

    def _go_on(self) -> None:
        """Let the time go on, and give all what came meanwhile.

        Where that is more than can be read, each gets its newest, as many as it wants.
        """
        now_ns = time.monotonic_ns()
        elapsed_ns, self._ticked_ns = min(now_ns - self._ticked_ns, _ELAPSED_MAX_NS), now_ns
        before = self._head
        after = before.advanced(elapsed_ns, self.recording.begin_ns, self.recording.end_ns)
        if after.at_ns < before.at_ns:
            self._go_to(after.at_ns, settled=True)
            return
        reached_ns = self._feed(after.at_ns)
        late_ns = after.at_ns - reached_ns
        self._late_ns = self._late_ns + late_ns if late_ns else 0
        if self._late_ns > _LATE_NS * before.rate:
            self._late_ns, self._skipped_s = 0, time.monotonic()
            self._go_to(after.at_ns, settled=True)
            reached_ns = after.at_ns
            self._ticked_ns = now_ns  # what that took is time that went by
        has_ended = not after.playing and reached_ns == after.at_ns
        with self._heads:
            self._head = replace(
                self._head, at_ns=reached_ns, playing=self._head.playing and not has_ended
            )
        if has_ended:
            self.on_stop("")

    def _feed(self, until_ns: int) -> int:
        """Give all what came up to a time, and return up to which that was read."""
        until_s = time.perf_counter() + _READING_S
        with self._feeding:
            readers: dict[str, list[_Reader]] = {}
            for one in self._readers:
                readers.setdefault(one.topic.name, []).append(one)
            while run := self._run_until(until_ns):
                samples = [one.sample for one in run]
                for reader in readers.get(run[0].topic, ()):
                    reader.given = {}
                    reader.stream.take(samples, len(samples), 0)
                self._given_ns = max(self._given_ns, samples[-1].received_ns)
                if time.perf_counter() > until_s:
                    return self._given_ns
            self._given_ns = max(self._given_ns, until_ns)
            return until_ns

    def _run_until(self, until_ns: int) -> list[Recorded]:
        """Return the messages of one topic that come next, up to a time."""
        run: list[Recorded] = []
        self._read_on()
        while (found := self._next) is not None and found.sample.received_ns <= until_ns:
            if len(run) >= _RUN_MAX or (run and run[0].topic != found.topic):
                break
            run.append(found)
            self._next = next(self._reading, None)
        return run

    def _read_on(self) -> None:
        """Begin to read where all were given what came; a live past grows meanwhile."""
        end_ns = self.recording.end_ns + 1
        if self._begins_reading or (self._next is None and end_ns > self._read_end_ns):
            self._begins_reading, self._read_end_ns = False, end_ns
            names = {one.topic.name for one in self._readers}
            self._reading, self._next = iter(()), None
            self._reading = iter(self.recording.messages(names, self._given_ns + 1, end_ns))
            self._next = next(self._reading, None)

    # What the recording has

    def _topic(self, name: str) -> RecordedTopic | None:
        return self.recording.topic(name)

    def _ends(self, topic: RecordedTopic) -> tuple[Endpoint, ...]:
        type_hash = self._hash_of(topic) or ""
        return tuple(
            Endpoint(self._node, False, topic.type_name, type_hash, one)  # noqa: FBT003 - of a tuple
            for one in topic.qos or (_usual_qos(topic),)
        )

    def _hash_of(self, topic: RecordedTopic) -> str | None:
        """Return the hash of a topic's type as it was recorded, or as the recording defines it."""
        if topic.type_hash:
            return topic.type_hash
        try:
            return self.recording.types.hash_of(topic.type_name)
        except (UnknownTypeError, RosNameError):
            return None

    def _flow(self, topic: str, newest: RawSample | None, at_ns: int) -> Flow:
        from studio.ros.node.topic_statistics import Flow  # noqa: PLC0415 - imports zenoh

        if newest is None:
            return Flow(is_silent=True)
        count = int(self.recording.counts(topic, at_ns - _FLOW_NS, at_ns + 1, 1).sum())
        age_s = (at_ns - newest.received_ns) / 1e9
        if count < 2:
            return Flow(age_s=age_s, is_silent=age_s > _SILENT_S)
        rate_hz = count * 1e9 / _FLOW_NS
        return Flow(rate_hz, rate_hz * len(newest.payload), age_s)


def _place(reader: _Reader) -> tuple[int, str]:
    name = reader.topic.name
    return (_FIRST.index(name) if name in _FIRST else len(_FIRST)), name


def _newest(samples: list[RawSample], depth: int) -> list[RawSample]:
    return samples[-depth:]


def _stays(reader: _Reader, samples: list[RawSample]) -> bool:
    """Whether those who take by themselves have just these: what takes for them may forget."""
    if not reader.given or reader.given != numbered(samples):
        return False
    return not any(one.is_taken_by_source for one in reader.stream.subscribers())


def _depth(topic: RecordedTopic, depth: int) -> int:
    """Return how many messages are kept of a topic: all publishers of it share one number."""
    if topic.name == TF:
        return TF_MAX
    if is_latched(topic):
        return min(DEPTH_MAX, max(depth, latched_count(topic)))
    return depth


def _usual_qos(topic: RecordedTopic) -> QoSProfile:
    if is_latched(topic):
        return QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    return QoSProfile(depth=10)


def _nothing(_why: str) -> None:
    """Do nothing: the default of `on_stop`."""
