"""Numbers over a whole recording for the page's plots, and as tables."""

from __future__ import annotations

import asyncio
import csv
import io
import math
from typing import TYPE_CHECKING, Final, Protocol

from studio.errors import CommandError
from studio.protocol.commands import Commands, Limits, Scope
from studio.protocol.playback import GetSeries, Series

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    import numpy as np
    from numpy.typing import NDArray

    from studio.bags.series import RecordingSeries, Samples, SeriesPicture
    from studio.live.time.shown import ShownRecording

_S: Final = 1_000_000_000
_FIRST_S: Final = 0.5
"""So long the first answer waits for a picture; then it says that there is none yet."""
_ROWS: Final = 20_000
"""Of a table, at a time."""
Line = tuple[str, str]
"""A topic, and the path of a number in its messages."""


class ShowsRecording(Protocol):
    """The time of a document."""

    @property
    def shown(self) -> ShownRecording | None:
        """The recording that is shown; None: what runs now."""
        ...

    @property
    def zero_ns(self) -> int:
        """What the times of pages count from, since the Unix epoch."""
        ...


class SeriesReader:
    """Answers with numbers over the recording that a document shows.

    Args:
        time: What is shown.
    """

    def __init__(self, time: ShowsRecording) -> None:
        self._time = time

    async def series(self, command: GetSeries) -> Series:
        """Return what can be shown now of a number; a coarse picture is better than waiting."""
        series, zero_ns = self._series(), self._time.zero_ns
        shown = await asyncio.to_thread(series.ask, command.topic, command.path)
        await asyncio.wait([asyncio.wrap_future(shown)], timeout=_FIRST_S)
        found = await asyncio.to_thread(
            series.picture,
            command.topic,
            command.path,
            zero_ns + round(command.begin_s * _S),
            zero_ns + round(command.end_s * _S),
            command.columns,
        )
        return _answer(command.request, found, zero_ns)

    async def table(self, lines: Sequence[tuple[str, str]]) -> Iterator[bytes]:
        """Return all samples of numbers that were plotted, by topic and path, as CSV.

        Raises:
            CommandError: What runs now is shown.
            RecordingError: Not all were read yet, or there are none.
        """
        return await asyncio.to_thread(table_of, self._series(), lines)

    def _series(self) -> RecordingSeries:
        shown = self._time.shown
        if shown is None:
            raise CommandError("The document shows what runs now: open a bag first.")
        return shown.series


def _answer(request: int, found: SeriesPicture, zero_ns: int) -> Series:
    columns = found.columns
    return Series(
        request=request,
        first=_values(columns.first),
        second=_values(columns.second),
        before=_sample(columns.before, zero_ns),
        after=_sample(columns.after, zero_ns),
        exact=found.exact,
        done=found.done,
        count=found.read,
        trouble=found.trouble,
    )


def _values(column: NDArray[np.float64]) -> tuple[float | None, ...]:
    return tuple(None if math.isnan(one) else one for one in column.tolist())


def _sample(sample: tuple[int, float] | None, zero_ns: int) -> tuple[float, float] | None:
    return None if sample is None else ((sample[0] - zero_ns) / _S, sample[1])


def table_of(series: RecordingSeries, lines: Sequence[Line]) -> Iterator[bytes]:
    """Return a table of all samples, one line for each number, in pieces.

    Raises:
        RecordingError: Not all were read, or there are none.
    """
    all_samples = [series.samples(topic, path) for topic, path in lines]
    return _table(lines, all_samples)


def _table(lines: Sequence[Line], all_samples: Sequence[Samples]) -> Iterator[bytes]:
    yield b"topic,path,time_s,value\n"
    for line, samples in zip(lines, all_samples, strict=True):
        head = _cells(line)
        for at in range(0, samples.values.size, _ROWS):
            times_ns = samples.times_ns[at : at + _ROWS].tolist()
            values = samples.values[at : at + _ROWS].tolist()
            yield "".join(
                f"{head}{time_ns // _S}.{time_ns % _S:09d},{value}\n"
                for time_ns, value in zip(times_ns, values, strict=True)
                if value == value  # noqa: PLR0124 - NaN: a message without a number
            ).encode()


def _cells(line: Line) -> str:
    """Write the first cells of a row: texts that no spreadsheet takes for a formula."""
    text = io.StringIO()
    harmless = [f"'{one}" if one[:1] in tuple("=+-@\t\r") else one for one in line]
    csv.writer(text, lineterminator=",").writerow(harmless)
    return text.getvalue()


COMMANDS: Final = Commands[SeriesReader](Scope.DOCUMENT)
COMMANDS.viewer(GetSeries, lambda one, c, _: one.series(c), limits=Limits(per_second=120))
