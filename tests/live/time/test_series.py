from __future__ import annotations

import asyncio
import csv
import io
from typing import TYPE_CHECKING

import pytest

from studio.bags.opening import open_bag
from studio.bags.series import RecordingSeries
from studio.errors import CommandError, RecordingError
from studio.live.time.series import SeriesReader, table_of
from studio.live.time.shown import ShownRecording
from studio.protocol.playback import GetSeries
from tests.support.bags import BEGIN_NS, Told, write_mcap
from tests.support.number_bags import PATH, write_numbers
from tests.support.wire import wait_until

if TYPE_CHECKING:
    from pathlib import Path

    from studio.protocol.playback import Series


def answer(reader: SeriesReader, topic: str, path: str, begin_s: float = 0.0) -> Series:
    command = GetSeries(topic=topic, path=path, begin_s=begin_s, end_s=3.0, columns=3, request=7)
    return asyncio.run(reader.series(command))


class Shows:
    """The time of a document that shows one recording."""

    zero_ns = BEGIN_NS

    def __init__(self, shown: ShownRecording | None) -> None:
        self.shown = shown


def test_a_small_bag_is_answered_exactly_at_once_in_seconds_of_the_page(tmp_path: Path):
    numbers = [(n * 500_000_000, float(n * n)) for n in range(8)]
    shown = ShownRecording(open_bag(write_numbers(tmp_path / "a.mcap", numbers)), "bag")
    found = answer(SeriesReader(Shows(shown)), "/points", PATH, begin_s=1.5)
    assert (found.request, found.exact, found.done, found.count) == (7, True, 1.0, 8)
    assert found.first == (9.0, 16.0, 25.0)
    assert found.second == (9.0, 16.0, 36.0)
    assert (found.before, found.after) == ((1.0, 4.0), (3.5, 49.0))
    shown.let_go()
    with pytest.raises(RecordingError, match="closed"):
        answer(SeriesReader(Shows(shown)), "/points", PATH)


def test_of_what_runs_now_there_is_no_series():
    with pytest.raises(CommandError):
        answer(SeriesReader(Shows(None)), "/points", PATH)


def test_a_part_without_messages_has_nothing_and_why_there_is_no_line_is_said(tmp_path: Path):
    bag = open_bag(write_mcap(tmp_path / "a.mcap", [Told("/chatter", 0)]))
    shown = ShownRecording(bag, "bag")
    reader = SeriesReader(Shows(shown))
    lengths = answer(reader, "/chatter", ".data.@length")
    assert lengths.first == (5.0, None, None)
    refused = answer(reader, "/chatter", ".data")
    assert (refused.first, refused.exact) == ((None, None, None), True)
    assert "a text lies there" in refused.trouble
    shown.let_go()


def test_a_table_has_every_sample_and_no_formula(tmp_path: Path):
    numbers = [(0, 1.5), (1, float("nan")), (2, float("inf")), (3_000_000_000, -2.0)]
    bag = open_bag(write_numbers(tmp_path / "a.mcap", numbers, topic="/points"))
    series = RecordingSeries(bag)
    lines = [("/points", PATH), ("/points", ".header.stamp")]
    for topic, path in lines:
        series.ask(topic, path)
    wait_until(
        "both are read",
        lambda: all(series.picture(*line, 0, 1, 1).exact for line in lines),
    )
    rows = list(csv.reader(io.StringIO(b"".join(table_of(series, lines)).decode())))
    assert rows[0] == ["topic", "path", "time_s", "value"]
    assert [row[2:] for row in rows if row[1] == PATH] == [
        ["1700000000.000000000", "1.5"],
        ["1700000000.000000002", "inf"],
        ["1700000003.000000000", "-2.0"],
    ]
    assert len(rows) == 1 + 3 + 4
    with pytest.raises(RecordingError):
        table_of(series, [("/nobody", PATH)])
    series.close()
