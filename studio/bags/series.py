"""Numbers of messages over a whole recording: read once in the background, then kept.

At first there is a coarse picture, made of some parts of the files; then what was read so far; and
at last every sample.
"""

from __future__ import annotations

import math
import threading
from concurrent.futures import Future
from itertools import islice
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from studio.bags.bag import Bag
from studio.bags.blocks import Columns
from studio.bags.series_memory import GrowingArray, SeriesMemory
from studio.errors import BagError, FieldPathError, RecordingError, UnknownTypeError
from studio.ros.cdr import codec_of
from studio.ros.columns.fields import FieldReader

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from numpy.typing import NDArray

    from studio.bags.recording import RecordedTopic, Recording

MEMORY: Final = SeriesMemory()
"""Of all recordings together."""
COARSE_PARTS: Final = 64
"""So many parts of the files make the coarse picture."""
LINES_MAX: Final = 64
"""Kept of one recording; the one that was asked for longest ago goes first."""
_TOGETHER: Final = 4_096
_EXPECTED_MAX: Final = 20_000_000
"""A file may say that it holds more: room for those is made when they come."""
_NO_TIMES: Final = np.empty(0, np.int64)
_NO_VALUES: Final = np.empty(0, np.float64)


class Samples(NamedTuple):
    """Times and values, shape (N,) each, by time; a value is NaN where there is no number."""

    times_ns: NDArray[np.int64]
    values: NDArray[np.float64]


class ColumnPicture(NamedTuple):
    """The least and the largest value of each part of a range, in the order in which they came.

    Attributes:
        first: Shape (N,); NaN where nothing came.
        second: The same; of one message equal to `first`.
        before: The last sample before the range, its time and value; None: there is none.
        after: The first one after it.
    """

    first: NDArray[np.float64]
    second: NDArray[np.float64]
    before: tuple[int, float] | None
    after: tuple[int, float] | None


class SeriesPicture(NamedTuple):
    """What can be shown of a series now.

    Attributes:
        columns: What lies in the range.
        exact: Whether all messages were read.
        done: The share that was read, 0 to 1.
        read: Numbers that were read.
        trouble: Why there are none, in a sentence; else empty.
    """

    columns: ColumnPicture
    exact: bool
    done: float
    read: int
    trouble: str


def columns_of(samples: Samples, begin_ns: int, end_ns: int, count: int) -> ColumnPicture:
    """Return the extremes of each of so many equal parts of [begin_ns, end_ns].

    What is no number, or not finite, is left out.
    """
    edges = begin_ns + np.linspace(0, end_ns - begin_ns, count + 1).round().astype(np.int64)
    edges[-1] = end_ns + 1
    places = np.searchsorted(samples.times_ns, edges)
    low, high = int(places[0]), int(places[-1])
    values = samples.values[low:high]
    with np.errstate(all="ignore"):
        seems_finite = math.isfinite(values.sum())  # the quickest that tells
    if not seems_finite:
        finite = np.isfinite(values)
        passed = np.concatenate(([0], np.cumsum(finite)))
        values, starts = values[finite], passed[places - low]
    else:
        starts = places - low
    first, second = np.full(count, math.nan), np.full(count, math.nan)
    bounds = starts.tolist()
    for n in np.flatnonzero(np.diff(starts)).tolist():
        part = values[bounds[n] : bounds[n + 1]]
        least, largest = int(part.argmin()), int(part.argmax())
        if least > largest:
            least, largest = largest, least
        first[n], second[n] = part[least], part[largest]
    return ColumnPicture(first, second, _finite_before(samples, low), _finite_from(samples, high))


_LOOKED_BACK: Final = 10_000


def _finite_before(samples: Samples, place: int) -> tuple[int, float] | None:
    start = max(0, place - _LOOKED_BACK)
    found = np.flatnonzero(np.isfinite(samples.values[start:place]))
    return _sample(samples, start + int(found[-1])) if found.size else None


def _finite_from(samples: Samples, place: int) -> tuple[int, float] | None:
    found = np.flatnonzero(np.isfinite(samples.values[place : place + _LOOKED_BACK]))
    return _sample(samples, place + int(found[0])) if found.size else None


def _sample(samples: Samples, at: int) -> tuple[int, float]:
    return int(samples.times_ns[at]), float(samples.values[at])


class _Line:
    """One number of a topic, and what was read of it; used with the lock of its series held."""

    def __init__(self, topic: str, reader: FieldReader | None, trouble: str) -> None:
        self.topic, self.reader, self.trouble = topic, reader, trouble
        self.shown: Future[None] = Future()
        """Done once there is a picture, coarse or exact, or none can be."""
        self.coarse: Samples | None = None
        self.reading: _Reading | None = None
        self.values: GrowingArray | None = None
        self.count = 0
        if trouble:
            self.show()

    def show(self) -> None:
        if not self.shown.done():
            self.shown.set_result(None)

    def fail(self, trouble: str) -> None:
        self.trouble = trouble
        self.show()

    def forget(self) -> None:
        """Let go of what was read."""
        self.coarse = self.reading = self.values = None


class _Reading:
    """Lines of one topic that are read together: the times of all of them."""

    def __init__(self, topic: str, lines: Sequence[_Line], times: GrowingArray) -> None:
        self.topic, self.lines, self.times = topic, lines, times
        self.next_ns: int | None = None
        """What comes from here on has not been read; None: nothing has."""
        self.last_ns: int | None = None
        self.ordered = True
        self.parts: Iterator[Columns] | None = None
        self.end_ns = 0
        self.done = 0.0


class RecordingSeries:
    """The series of one recording; thread-safe, with a thread that reads while there is something.

    Args:
        recording: What is read; of the last minutes, what came since is read with each request.
        memory: Where samples are kept.
    """

    def __init__(self, recording: Recording, memory: SeriesMemory = MEMORY) -> None:
        self._recording, self._memory = recording, memory
        self._lock = threading.RLock()
        self._lines: dict[tuple[str, str], _Line] = {}
        """The one that was asked for last is the last."""
        self._readings: list[_Reading] = []
        self._thread: threading.Thread | None = None
        self._closed = False

    def close(self) -> None:
        """Read no more, and forget all; waits for the part that is being read."""
        with self._lock:
            self._closed = True
            thread = self._thread
            for line in self._lines.values():
                line.fail("The recording was closed.")
        if thread is not None and thread is not threading.current_thread():
            thread.join()
        with self._lock:
            for line in self._lines.values():
                line.forget()
            self._lines.clear()
            self._readings.clear()

    def ask(self, topic: str, path: str) -> Future[None]:
        """Have a number read, if it is not; done when there is something to show.

        Args:
            topic: Full name.
            path: As `studio.ros.columns.field_paths` has it.
        """
        with self._lock:
            line = self._line(topic, path)
            self._begin()
            return line.shown

    def picture(
        self, topic: str, path: str, begin_ns: int, end_ns: int, columns: int
    ) -> SeriesPicture:
        """Return what can be shown now of a number over a range."""
        with self._lock:
            line = self._line(topic, path)
            self._begin()
            pieces = _pieces(line)
            exact = self._is_read(line)
            done = 1.0 if exact else line.reading.done if line.reading else 0.0
            count, trouble = line.count, line.trouble
        if exact and not count and not trouble:
            trouble = f"No message of {topic} has a number there."
        end_ns = max(begin_ns, end_ns)
        found = _together([columns_of(one, begin_ns, end_ns, columns) for one in pieces])
        return SeriesPicture(found, exact or bool(trouble), done, count, trouble)

    def samples(self, topic: str, path: str) -> Samples:
        """Return all samples of a number that has been read.

        Raises:
            RecordingError: It has not, or not wholly, or there is none.
        """
        with self._lock:
            line = self._line(topic, path)
            self._begin()
            if line.trouble:
                raise RecordingError(line.trouble)
            if not self._is_read(line) and not (
                line.values and line.reading and line.reading.done == 1
            ):
                raise RecordingError(f"{topic} is still being read: try again in a moment.")
            return _pieces(line)[0]

    # With the lock held

    def _line(self, topic: str, path: str) -> _Line:
        line = self._lines.pop((topic, path), None) or self._new_line(topic, path)
        self._lines[topic, path] = line
        while len(self._lines) > LINES_MAX:
            self._lines.pop(next(iter(self._lines))).forget()
        return line

    def _new_line(self, topic: str, path: str) -> _Line:
        if self._closed:
            return _Line(topic, None, "The recording was closed.")
        found = self._topic(topic)
        if found is None:
            return _Line(topic, None, f"The recording has no topic {topic[:200]}.")
        if found.trouble:
            return _Line(topic, None, found.trouble)
        try:
            kind = self._recording.types.message(found.type_name)
            return _Line(topic, FieldReader(kind, path, codec_of(kind).decode), "")
        except (FieldPathError, UnknownTypeError) as error:
            return _Line(topic, None, str(error))

    def _topic(self, name: str) -> RecordedTopic | None:
        return self._recording.topic(name)

    def _is_read(self, line: _Line) -> bool:
        reading = line.reading
        if reading is None or reading.parts is not None or reading.next_ns is None:
            return False
        return reading.next_ns > self._recording.end_ns

    def _begin(self) -> None:
        """Have the thread read, if there is something."""
        waits = any(not one.trouble and not self._is_read(one) for one in self._lines.values())
        if waits and not self._closed and self._thread is None:
            self._thread = threading.Thread(target=self._run, name="series", daemon=True)
            self._thread.start()

    # In the thread

    def _run(self) -> None:
        while True:
            with self._lock:
                new = self._new_lines()
                reading = None if new else self._next_reading()
                if self._closed or (not new and reading is None):
                    self._thread = None
                    return
            lines = new or (reading.lines if reading else ())
            try:
                if new:
                    self._show_coarse(new)
                elif reading is not None:
                    self._read_on(reading)
            except (BagError, UnknownTypeError) as error:
                self._give_up(lines, str(error))
            except Exception as error:
                self._give_up(lines, f"It cannot be read ({error!r}).")
                with self._lock:
                    self._thread = None
                raise

    def _give_up(self, lines: Sequence[_Line], trouble: str) -> None:
        with self._lock:
            for line in lines:
                line.fail(trouble)
                line.forget()
            self._readings = [one for one in self._readings if one.lines is not lines]

    def _new_lines(self) -> list[_Line]:
        """Return the lines of one topic of which nothing was read."""
        new = [one for one in self._lines.values() if not one.trouble and one.reading is None]
        return [one for one in new if one.topic == new[0].topic]

    def _next_reading(self) -> _Reading | None:
        wanted = [one for one in self._lines.values() if not one.trouble]
        readings = {id(one.reading) for one in wanted if not self._is_read(one)}
        kept = {id(one.reading) for one in wanted}
        self._readings = [one for one in self._readings if id(one) in kept]
        return next((one for one in self._readings if id(one) in readings), None)

    def _show_coarse(self, lines: list[_Line]) -> None:
        """Read some parts of the files, if there are many; and make ready for all of them."""
        topic = lines[0].topic
        begin_ns, end_ns = self._recording.begin_ns, self._recording.end_ns + 1
        many = (
            self._recording.part_count(topic, begin_ns, end_ns)
            if isinstance(self._recording, Bag)
            else 0
        )
        found: list[Samples] = []
        if many > 2 * COARSE_PARTS:
            parts = list(self._parts(topic, begin_ns, end_ns, every=many // COARSE_PARTS))
            found = [_joined(parts, line) for line in lines]
        with self._lock:
            known = self._topic(topic)
            expected = min(known.count, _EXPECTED_MAX) if known else 0
            times = GrowingArray(self._memory, np.int64, expected)
            reading = _Reading(topic, lines, times)
            self._readings.append(reading)
            for n, line in enumerate(lines):
                line.reading = reading
                line.values = GrowingArray(self._memory, np.float64, expected)
                if found:
                    line.coarse = found[n]
                    line.count = int(np.isfinite(found[n].values).sum())
                    line.show()

    def _parts(self, topic: str, begin_ns: int, end_ns: int, every: int = 1) -> Iterator[Columns]:
        if isinstance(self._recording, Bag):
            yield from self._recording.columns(topic, begin_ns, end_ns, every=every)
            return
        messages = self._recording.messages([topic], begin_ns, end_ns)
        while batch := [one.sample for one in islice(messages, _TOGETHER)]:
            lengths = np.array([len(one.payload) for one in batch], np.int64)
            times_ns = np.array([one.received_ns for one in batch], np.int64)
            data = b"".join(one.payload for one in batch)
            yield Columns(times_ns, data, np.cumsum(lengths) - lengths, lengths)

    def _read_on(self, reading: _Reading) -> None:
        """Read the next part."""
        recording = self._recording
        if reading.parts is None:
            begin_ns = recording.begin_ns if reading.next_ns is None else reading.next_ns
            reading.end_ns = recording.end_ns + 1
            reading.parts = self._parts(reading.topic, begin_ns, reading.end_ns)
        part = next(reading.parts, None)
        if part is None:
            self._finish(reading)
            return
        values = [_read(line, part) for line in reading.lines]
        with self._lock:
            first_ns, last_ns = int(part.times_ns[0]), int(part.times_ns[-1])
            if reading.last_ns is not None and first_ns < reading.last_ns:
                reading.ordered = False
            reading.last_ns = max(last_ns, reading.last_ns or last_ns)
            reading.times.append(part.times_ns)
            for line, numbers in zip(reading.lines, values, strict=True):
                if line.values is not None:
                    line.values.append(numbers)
            span_ns = max(1, reading.end_ns - recording.begin_ns)
            share = (reading.last_ns - recording.begin_ns) / span_ns
            reading.done = max(reading.done, min(share, 0.999))

    def _finish(self, reading: _Reading) -> None:
        order = None
        if not reading.ordered:
            order = np.argsort(reading.times.filled(), kind="stable")
        with self._lock:
            if order is not None:
                reading.times.reorder(order)
            for line in reading.lines:
                if line.values is not None and order is not None:
                    line.values.reorder(order)
                line.coarse = None
            reading.ordered, reading.parts, reading.done = True, None, 1.0
            reading.next_ns = reading.end_ns
            self._drop_old(reading)
            for line in reading.lines:
                if line.values is not None:
                    line.count = int(np.isfinite(line.values.filled()).sum())
                line.show()

    def _drop_old(self, reading: _Reading) -> None:
        """Drop what the recording itself has forgotten, if it is much."""
        old = int(np.searchsorted(reading.times.filled(), self._recording.begin_ns))
        if 2 * old > reading.times.size:
            reading.times.drop_first(old)
            for line in reading.lines:
                if line.values is not None:
                    line.values.drop_first(old)


def _read(line: _Line, part: Columns) -> NDArray[np.float64]:
    if line.reader is None:
        return np.full(part.times_ns.size, math.nan)
    return line.reader.read(part.data, part.offsets, part.lengths)


def _joined(parts: Sequence[Columns], line: _Line) -> Samples:
    if not parts:
        return Samples(_NO_TIMES, _NO_VALUES)
    times_ns = np.concatenate([one.times_ns for one in parts])
    values = np.concatenate([_read(line, one) for one in parts])
    order = np.argsort(times_ns, kind="stable")
    return Samples(times_ns[order], values[order])


def _pieces(line: _Line) -> list[Samples]:
    """Return what was read, and behind it what the coarse picture has; the lock is held."""
    reading, coarse = line.reading, line.coarse
    if reading is None or line.values is None:
        return [coarse or Samples(_NO_TIMES, _NO_VALUES)]
    times_ns, values = reading.times.filled(), line.values.filled()
    if coarse is None and not reading.ordered:
        order = np.argsort(times_ns, kind="stable")
        return [Samples(times_ns[order], values[order])]
    if coarse is None:
        return [Samples(times_ns, values)]
    if reading.last_ns is None or not reading.ordered:
        return [coarse]
    rest = int(np.searchsorted(coarse.times_ns, reading.last_ns, "right"))
    return [Samples(times_ns, values), Samples(coarse.times_ns[rest:], coarse.values[rest:])]


def _together(pictures: Sequence[ColumnPicture]) -> ColumnPicture:
    """Put pictures of one range together; where both have something, the first counts."""
    made = pictures[0]
    for other in pictures[1:]:
        empty = np.isnan(made.first)
        made = ColumnPicture(
            np.where(empty, other.first, made.first),
            np.where(empty, other.second, made.second),
            other.before or made.before,
            made.after or other.after,
        )
    return made
