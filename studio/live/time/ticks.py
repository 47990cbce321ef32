"""RecordingTicks: where a recording has warnings and errors, by `/rosout` and `/diagnostics`."""

from __future__ import annotations

import threading
import time
from typing import TYPE_CHECKING, Final, NamedTuple

from studio.errors import StudioError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from typing import Literal

    from studio.bags.recording import Recorded, Recording
    from studio.ros.types.classes import MessageValue

TICKS_MAX: Final = 2_000
_TEXT_MAX: Final = 300
_NAME_MAX: Final = 200
_PARTS_MAX: Final = 10_000
_READING_S: Final = 0.15
"""So long is read for one question; the next goes on from there."""
_LATE_NS: Final = 1_000_000_000
"""A message that came so late was latched, and belongs to when it was sent."""
_WARN, _ERROR = 30, 40
_DIAGNOSTIC_ERROR: Final = 2
"""ERROR, or STALE beyond it."""
_LOG: Final = "/rosout"
_DIAGNOSTICS: Final = "/diagnostics"
_TYPES: Final = {
    _LOG: "rcl_interfaces/msg/Log",
    _DIAGNOSTICS: "diagnostic_msgs/msg/DiagnosticArray",
}


class Tick(NamedTuple):
    """A warning or an error, and who gave it."""

    at_ns: int
    level: Literal["warn", "error"]
    source: str
    text: str


class RecordingTicks:
    """Reads a little with each question, and a recording that grows further and further.

    Only messages of two topics are read. Of a part of `/diagnostics`, which repeats itself, there
    is one tick each time that it becomes worse or better than it was, but not well. Thread-safe.
    """

    def __init__(self, recording: Recording) -> None:
        self._recording = recording
        self._lock = threading.Lock()
        self._ticks: list[Tick] = []
        self._more = 0
        self._found: tuple[tuple[Tick, ...], int, float] = ((), 0, 0.0)
        self._reading: Iterator[Recorded] | None = None
        self._until_ns = self._end_ns = -1
        self._levels: dict[str, int] = {}
        self._decoders: dict[str, Callable[[bytes], MessageValue] | None] = {}

    def read(self) -> tuple[tuple[Tick, ...], int, float]:
        """Read on, and return the ticks by time, how many were left out, and the share read.

        In a thread, for it reads files; while another reads on, what that found before.

        Raises:
            BagError: The file cannot be read any more.
        """
        if not self._lock.acquire(blocking=False):
            return self._found
        try:
            begin_ns, end_ns = self._recording.begin_ns, self._recording.end_ns
            self._read_on(end_ns)
            kept = sorted(one for one in self._ticks if one.at_ns >= begin_ns)
            self._ticks = kept
            length_ns = max(1, end_ns - begin_ns)
            done = 1.0 if self._reading is None else (self._until_ns - begin_ns) / length_ns
            self._found = tuple(kept), self._more, max(0.0, min(1.0, done))
            return self._found
        finally:
            self._lock.release()

    def _read_on(self, end_ns: int) -> None:
        until_s = time.monotonic() + _READING_S
        if self._reading is None:
            if self._until_ns >= end_ns:
                return
            topics = {one.name: one.type_name for one in self._recording.topics}
            names = [name for name, kind in _TYPES.items() if topics.get(name) == kind]
            self._end_ns = end_ns
            self._reading = iter(self._recording.messages(names, self._until_ns + 1, end_ns + 1))
        reading, self._reading = self._reading, None  # of one that fails nothing more comes
        for topic, sample in reading:
            self._until_ns = sample.received_ns
            decode = self._decoder(topic)
            if decode is not None:
                sent_ns = sample.attachment.source_time_ns
                is_late = self._recording.begin_ns <= sent_ns < sample.received_ns - _LATE_NS
                self._take(topic, decode, sample.payload, sent_ns if is_late else self._until_ns)
            if time.monotonic() > until_s:
                self._reading = reading
                return
        self._until_ns = self._end_ns

    def _decoder(self, topic: str) -> Callable[[bytes], MessageValue] | None:
        if topic not in self._decoders:
            from studio.ros.cdr import codec_of  # noqa: PLC0415 - takes its time

            try:
                kind = self._recording.types.message(_TYPES[topic])
                self._decoders[topic] = codec_of(kind).decode
            except StudioError:
                self._decoders[topic] = None
        return self._decoders[topic]

    def _take(
        self, topic: str, decode: Callable[[bytes], MessageValue], payload: bytes, at_ns: int
    ) -> None:
        try:
            message = decode(payload)
            found = (
                _of_log(message, at_ns)
                if topic == _LOG
                else [*self._of_diagnostics(message, at_ns)]
            )
        except (StudioError, AttributeError, TypeError, ValueError):
            return  # a message of another form than its type has no level
        self._ticks += found
        if len(self._ticks) > TICKS_MAX:
            self._thin()

    def _of_diagnostics(self, message: MessageValue, at_ns: int) -> Iterator[Tick]:
        for status in message.status:
            level = int(status.level)
            if self._levels.get(status.name, 0) == level:
                continue
            if level or status.name in self._levels:
                self._levels[status.name] = level
            if len(self._levels) > _PARTS_MAX:
                del self._levels[next(iter(self._levels))]
            if level:
                grade = "error" if level >= _DIAGNOSTIC_ERROR else "warn"
                yield Tick(at_ns, grade, status.name[:_NAME_MAX], status.message[:_TEXT_MAX])

    def _thin(self) -> None:
        """Leave out every second warning, or every second of all where errors are the most."""
        before = len(self._ticks)
        warnings = [one for one in self._ticks if one.level == "warn"]
        errors = [one for one in self._ticks if one.level == "error"]
        if len(warnings) < before // 2:
            errors = errors[::2]
        self._ticks = sorted([*warnings[::2], *errors])
        self._more += before - len(self._ticks)


def _of_log(message: MessageValue, at_ns: int) -> list[Tick]:
    level = int(message.level)
    if level < _WARN:
        return []
    grade = "error" if level >= _ERROR else "warn"
    return [Tick(at_ns, grade, message.name[:_NAME_MAX], message.msg[:_TEXT_MAX])]
