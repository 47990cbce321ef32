"""Numbers over a whole recording for the page's plots, and as tables."""

from __future__ import annotations

import asyncio
import csv
import io
import math
from typing import TYPE_CHECKING, Final

from studio.protocol.playback import GetSeries, Series

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    import numpy as np
    from numpy.typing import NDArray

    from studio.bags.series import RecordingSeries, Samples

_S: Final = 1_000_000_000
_FIRST_S: Final = 0.5
"""So long the first answer waits for a picture; then it says that there is none yet."""
_ROWS: Final = 20_000
"""Of a table, at a time."""
Line = tuple[str, str]
"""A topic, and the path of a number in its messages."""


async def series_answer(series: RecordingSeries, command: GetSeries, zero_ns: int) -> Series:
    """Return what can be shown now of a number; a coarse picture is better than waiting.

    Args:
        series: Of the recording that is shown.
        command: The question; its times count from `zero_ns`.
        zero_ns: Since the Unix epoch.
    """
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
    columns = found.columns
    return Series(
        request=command.request,
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
