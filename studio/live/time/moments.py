"""The messages that subscribers of each topic are given at a moment of a recording."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final, NamedTuple

from studio.errors import CdrError

if TYPE_CHECKING:
    from collections.abc import Iterable

    from studio.bags.recording import RecordedTopic, Recording
    from studio.ros.columns.transforms import TransformCodec
    from studio.ros.node.samples import RawSample

TF: Final = "/tf"
TF_STATIC: Final = "/tf_static"
LOG: Final = "/rosout"
TF_HISTORY_NS: Final = 10_000_000_000
"""As long as a buffer of tf2 remembers."""
TF_MAX: Final = 4_096
RECENT_NS: Final = 10_000_000_000
"""Older messages of a topic that is not latched are of no use but for the newest."""
SETTLED_MAX: Final = 1_000
DRAGGED_MAX: Final = 30
"""So many messages of a topic are read at most, while a bar is dragged."""
_DRAGGED_TF: Final = (32, 256)
"""So many messages of /tf are read while it is dragged, and then, where frames are missing."""


class Wanted(NamedTuple):
    """A topic, and how many of its last messages are wanted."""

    topic: RecordedTopic
    depth: int

    @property
    def is_latched(self) -> bool:
        """Whether what was said once holds until it is said otherwise."""
        return is_latched(self.topic)


def is_latched(topic: RecordedTopic) -> bool:
    """Return whether what a topic said holds on: it was latched, or is a log."""
    return topic.is_latched or topic.name == LOG


@dataclass(slots=True)
class _Held:
    """The messages of a latched topic, and the times between which they are its last ones."""

    samples: list[RawSample]
    begin_ns: int
    end_ns: int | None


@dataclass(slots=True)
class Moments:
    """Reads them; used in one thread at a time.

    Attributes:
        recording: What is read.
    """

    recording: Recording
    _held: dict[tuple[str, int], _Held] = field(default_factory=dict[tuple[str, int], "_Held"])
    _frames: frozenset[str] = frozenset()
    """Which moved in the ten seconds before the last moment that was read whole."""
    _codec: TransformCodec | None = None

    def at(
        self, wanted: Iterable[Wanted], at_ns: int, since_ns: int = 0, *, settled: bool = True
    ) -> dict[str, list[RawSample]]:
        """Return what each topic has at a time, the oldest first.

        Args:
            wanted: The topics, each once.
            at_ns: The time.
            since_ns: What is older is not wanted.
            settled: Whether it stays there; else no more is read than shows where things are.

        Raises:
            BagError: The file cannot be read any more.
        """
        wanted = tuple(wanted)
        single = [one.topic.name for one in wanted if self._is_single(one)]
        newest = self.recording.latest(single, at_ns) if single else {}
        found: dict[str, list[RawSample]] = {}
        for one in wanted:
            name = one.topic.name
            if self._is_single(one):
                sample = newest.get(name)
                found[name] = [] if sample is None or sample.received_ns < since_ns else [sample]
            else:
                found[name] = self._last(one, at_ns, since_ns, settled=settled)
        return found

    def _is_single(self, one: Wanted) -> bool:
        return one.depth == 1 and not one.is_latched and one.topic.name != TF

    def _last(self, one: Wanted, at_ns: int, since_ns: int, *, settled: bool) -> list[RawSample]:
        name = one.topic.name
        if name == TF:
            return self._tf(at_ns, max(since_ns, at_ns - TF_HISTORY_NS), settled=settled)
        most = min(one.depth, SETTLED_MAX)
        if one.is_latched and (settled or name == TF_STATIC or one.depth <= DRAGGED_MAX):
            return [each for each in self._kept(name, at_ns, most) if each.received_ns >= since_ns]
        if not settled:
            most = min(most, DRAGGED_MAX)
        if one.is_latched:
            return self.recording.last(name, at_ns, most, since_ns)
        recent = self.recording.last(name, at_ns, most, max(since_ns, at_ns - RECENT_NS))
        return recent or self.recording.last(name, at_ns, 1, since_ns)

    def _kept(self, name: str, at_ns: int, most: int) -> list[RawSample]:
        """Return the last of a latched topic; while they are the same, the same list."""
        held = self._held.get((name, most))
        if (
            held is not None
            and held.begin_ns <= at_ns
            and (held.end_ns is None or at_ns < held.end_ns)
        ):
            return held.samples
        samples = self.recording.last(name, at_ns, most)
        begin_ns = samples[-1].received_ns if samples else 0
        # Of one that still grows, the end is not known.
        end_ns = self.recording.next_ns(name, at_ns)
        if end_ns is None:
            end_ns = self.recording.end_ns + 1
        self._held[name, most] = _Held(samples, begin_ns, end_ns)
        return samples

    def _tf(self, at_ns: int, since_ns: int, *, settled: bool) -> list[RawSample]:
        if settled:
            found = self.recording.last(TF, at_ns, TF_MAX, since_ns)
            self._frames = self._moving(found[-_DRAGGED_TF[1] :])
            return found
        found: list[RawSample] = []
        for most in _DRAGGED_TF:
            found = self.recording.last(TF, at_ns, most, since_ns)
            if len(found) < most or self._frames <= self._moving(found):
                break
        return found

    def _moving(self, samples: Iterable[RawSample]) -> frozenset[str]:
        """Return the frames that these place."""
        if self._codec is None:
            from studio.ros.columns.transforms import TransformCodec  # noqa: PLC0415 - takes its time

            self._codec = TransformCodec()
        frames: set[str] = set()
        for sample in samples:
            try:
                frames.update(self._codec.decode(sample.payload).children)
            except CdrError:
                continue
        return frozenset(frames)


def numbered(samples: Iterable[RawSample]) -> dict[int, int]:
    """Return by its number when each came."""
    return {one.attachment.sequence: one.received_ns for one in samples}
