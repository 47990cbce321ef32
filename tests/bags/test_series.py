from __future__ import annotations

import math
import threading
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.bags.opening import open_bag
from studio.bags.series import COARSE_PARTS, RecordingSeries, Samples, SeriesPicture, columns_of
from studio.bags.series_memory import SeriesMemory
from studio.errors import RecordingError
from tests.support.bags import BEGIN_NS, Told, write_mcap
from tests.support.memory_recording import MemoryRecording
from tests.support.number_bags import PATH, write_numbers
from tests.support.wire import wait_until

if TYPE_CHECKING:
    from pathlib import Path

    from studio.bags.bag import Bag

S = 10**9


def naive(samples: list[tuple[int, float]], begin: int, end: int, count: int) -> list[Any]:
    """What the page's `columnsOf` makes of messages that run, one after another."""
    drawn: list[list[float]] = [[] for _ in range(count)]
    width = (end - begin) / count
    for time, value in samples:
        if not begin <= time <= end or not math.isfinite(value):
            continue
        pair = drawn[min(count - 1, int((time - begin) / width)) if width else 0]
        if not pair:
            pair[:] = [value, value]
        elif not min(pair) <= value <= max(pair):
            pair[:] = [min(pair) if value > max(pair) else max(pair), value]
    return [tuple(pair) if pair else None for pair in drawn]


@given(
    numbers=st.lists(
        st.tuples(
            st.integers(0, 64),
            st.one_of(st.integers(-9, 9).map(float), st.sampled_from([math.nan, math.inf])),
        ),
        max_size=60,
    ),
    begin=st.integers(-4, 70),
    width=st.integers(0, 16),
    count=st.sampled_from([1, 2, 4, 8]),
)
def test_columns_have_the_extremes_of_each_part_in_their_order(
    numbers: list[tuple[int, float]], begin: int, width: int, count: int
):
    numbers.sort(key=lambda one: one[0])
    times = np.array([time for time, _ in numbers], np.int64)
    values = np.array([value for _, value in numbers], np.float64)
    end = begin + width * count
    found = columns_of(Samples(times, values), begin, end, count)
    pairs = zip(found.first.tolist(), found.second.tolist(), strict=True)
    shown = [None if math.isnan(one) else (one, other) for one, other in pairs]
    if width:
        assert shown == naive(numbers, begin, end, count)
    finite = [one for one in numbers if math.isfinite(one[1])]
    before = [one for one in finite if one[0] < begin]
    assert found.before == (before[-1] if before else None)
    after = [one for one in finite if one[0] > end]
    assert found.after == (after[0] if after else None)


def whole(bag: Bag, series: RecordingSeries, path: str = PATH, columns: int = 10) -> SeriesPicture:
    return series.picture("/points", path, bag.begin_ns, bag.end_ns, columns)


def read(bag: Bag, series: RecordingSeries, path: str = PATH) -> Samples:
    series.ask("/points", path)
    wait_until("all is read", lambda: whole(bag, series, path).exact)
    return series.samples("/points", path)


def test_every_message_of_a_bag_is_read_and_kept(tmp_path: Path):
    numbers = [(n * 1_000_000, math.sin(n)) for n in range(5_000)]
    bag = open_bag(write_numbers(tmp_path / "a.mcap", numbers, chunk_bytes=20_000))
    series = RecordingSeries(bag)
    samples = read(bag, series)
    assert samples.values.tolist() == [value for _, value in numbers]
    assert (samples.times_ns - BEGIN_NS).tolist() == [time for time, _ in numbers]
    picture = whole(bag, series)
    assert (picture.exact, picture.done, picture.read, picture.trouble) == (True, 1.0, 5_000, "")
    shown = list(zip(picture.columns.first.tolist(), picture.columns.second.tolist(), strict=True))
    assert shown == naive(numbers, 0, bag.end_ns - bag.begin_ns, 10)
    series.close()


def test_a_picture_of_some_parts_comes_first_and_says_so(tmp_path: Path):
    numbers = [(n * 1_000_000, float(n)) for n in range(20_000)]
    bag = open_bag(write_numbers(tmp_path / "a.mcap", numbers, chunk_bytes=4_000))
    assert bag.part_count("/points", 0, 2**62) > 2 * COARSE_PARTS
    held = HeldBag(bag)
    series = RecordingSeries(held.bag)
    series.ask("/points", PATH).result(timeout=20)
    coarse = whole(bag, series)
    assert not coarse.exact
    assert 0 < coarse.read < 10_000
    assert coarse.done < 1
    # From the beginning to the end, and nothing that was not sent.
    assert not np.isnan(coarse.columns.first).any()
    assert coarse.columns.first.tolist() == sorted(coarse.columns.first.tolist())
    with pytest.raises(RecordingError, match="still being read"):
        series.samples("/points", PATH)
    held.go_on.set()
    assert read(bag, series).values.size == 20_000
    series.close()


class HeldBag:
    """A bag whose second reading waits until it may go on: the first one is the coarse one."""

    def __init__(self, bag: Bag) -> None:
        self.bag, self.go_on = bag, threading.Event()
        columns = bag.columns

        def held(topic: str, begin_ns: int, end_ns: int, *, every: int = 1) -> Any:  # noqa: ANN401
            for part in columns(topic, begin_ns, end_ns, every=every):
                if every == 1:
                    self.go_on.wait(20)
                yield part

        bag.columns = held


def test_stamps_that_go_back_are_put_in_order(tmp_path: Path):
    numbers = [((n * 7919) % 3_000 * 1_000_000, float(n)) for n in range(3_000)]
    bag = open_bag(write_numbers(tmp_path / "a.mcap", numbers, chunk_bytes=10_000))
    series = RecordingSeries(bag)
    samples = read(bag, series)
    assert (np.diff(samples.times_ns) >= 0).all()
    assert samples.values.tolist() == [value for _, value in sorted(numbers)]
    series.close()


def test_what_memory_has_no_room_for_lies_in_files_that_go_with_it(tmp_path: Path):
    numbers = [(n * 1_000_000, float(n)) for n in range(5_000)]
    bag = open_bag(write_numbers(tmp_path / "a.mcap", numbers))
    memory = SeriesMemory(bytes_max=50_000)
    series = RecordingSeries(bag, memory)
    samples = read(bag, series)
    assert samples.values.tolist() == [value for _, value in numbers]
    assert memory.used_bytes <= 50_000
    assert memory.files_bytes > 0
    series.close()
    del samples, series
    assert (memory.used_bytes, memory.files_bytes) == (0, 0)


def test_no_room_at_all_is_a_sentence_and_other_lines_stay(tmp_path: Path):
    numbers = [(n * 1_000_000, float(n)) for n in range(5_000)]
    bag = open_bag(write_numbers(tmp_path / "a.mcap", numbers))
    series = RecordingSeries(bag, SeriesMemory(90_000, 50_000))
    read(bag, series)
    series.ask("/points", ".point.y").result(timeout=20)
    picture = whole(bag, series, ".point.y")
    assert picture.exact
    assert picture.trouble.startswith("The samples of all plots take more than")
    assert whole(bag, series).read == 5_000
    series.close()


@pytest.mark.parametrize(
    ("topic", "path", "reason"),
    [
        ("/nobody", ".x", "no topic /nobody"),
        ("/chatter", ".data", "a text lies there"),
        ("/chatter", ".date", "no field date"),
        ("/chatter", "..", "looks like"),
        ("/other", ".x", "in the form"),
    ],
)
def test_where_there_is_no_number_a_sentence_says_why(
    tmp_path: Path, topic: str, path: str, reason: str
):
    encoding = "json" if topic == "/other" else "cdr"
    file = write_mcap(tmp_path / "a.mcap", [Told(topic, 0)], encoding=encoding)
    if topic == "/nobody":
        file = write_mcap(tmp_path / "b.mcap", [Told("/chatter", 0)])
    series = RecordingSeries(open_bag(file))
    series.ask(topic, path).result(timeout=20)
    picture = series.picture(topic, path, 0, S, 4)
    assert picture.exact
    assert reason in picture.trouble
    with pytest.raises(RecordingError):
        series.samples(topic, path)
    series.close()


def test_a_number_that_is_decoded_message_by_message_is_read_as_well(tmp_path: Path):
    bag = open_bag(write_mcap(tmp_path / "a.mcap", [Told("/chatter", n * S) for n in range(3)]))
    series = RecordingSeries(bag)
    series.ask("/chatter", ".data.@length").result(timeout=20)
    wait_until(
        "it is read",
        lambda: series.picture("/chatter", ".data.@length", 0, 1, 1).exact,
    )
    assert series.samples("/chatter", ".data.@length").values.tolist() == [5.0] * 3
    series.close()


def test_closing_ends_what_is_being_read(tmp_path: Path):
    numbers = [(n * 1_000_000, float(n)) for n in range(20_000)]
    bag = open_bag(write_numbers(tmp_path / "a.mcap", numbers, chunk_bytes=4_000))
    series = RecordingSeries(bag)
    shown = series.ask("/points", PATH)
    series.close()
    shown.result(timeout=20)
    assert "closed" in whole(bag, series).trouble
    assert not any(one.name == "series" for one in threading.enumerate())


def test_of_what_goes_on_only_what_came_since_is_read_and_what_it_forgot_is_dropped():
    memory = SeriesMemory()
    recording = MemoryRecording()
    recording.add_topic("/numbers", "std_msgs/msg/Float64")
    for n in range(3_000):
        recording.say("/numbers", S + n, data=float(n))
    series = RecordingSeries(recording, memory)

    def count() -> int:
        picture = series.picture("/numbers", ".data", recording.begin_ns, recording.end_ns, 4)
        return picture.read if picture.exact else -1

    wait_until("what there is, is read", lambda: count() == 3_000)
    for n in range(3_000, 3_100):
        recording.say("/numbers", S + n, data=float(n))
    wait_until("what came since, too", lambda: count() == 3_100)
    assert series.samples("/numbers", ".data").values.tolist() == [*map(float, range(3_100))]
    recording.forget("/numbers", S + 2_000)
    recording.say("/numbers", S + 3_100, data=7.0)
    wait_until("what it forgot is gone", lambda: count() == 1_101)
    assert series.samples("/numbers", ".data").times_ns[0] == S + 2_000
    series.close()
