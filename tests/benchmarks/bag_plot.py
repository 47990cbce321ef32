"""One number of ten million messages over a whole bag: coarse, exact, and zoomed into."""

from __future__ import annotations

import random
import tempfile
import time
from itertools import islice
from pathlib import Path
from statistics import median

from mcap.reader import make_reader

from studio.bags.opening import open_bag
from studio.bags.series import RecordingSeries
from studio.ros.cdr import codec_of
from studio.ros.types.library import TypeLibrary
from tests.benchmarks.report import judge, judge_that, say
from tests.support.number_bags import PATH, TYPE, write_many

SAMPLES = 10_000_000
SHARE = 50
"""One in so many is read by the library, for a comparison."""
COLUMNS = 1_200
_ZOOMS = 60
_TOPIC = "/points"


def run() -> None:
    """Make the bag, plot it, look closer, and read a part of it by the library."""
    with tempfile.TemporaryDirectory() as folder:
        file = write_many(Path(folder) / "wave.mcap", SAMPLES)
        exact_s = _plot(file)
        peer_s = _peer_s(file) * SHARE
        say(f"  mcap and the decoder, of 1/{SHARE}: {peer_s:.0f} s ({peer_s / exact_s:.0f} x)")


def _plot(file: Path) -> float:
    bag = open_bag(file)
    series = RecordingSeries(bag)
    begin = time.perf_counter()
    series.ask(_TOPIC, PATH).result(timeout=60)
    coarse = series.picture(_TOPIC, PATH, bag.begin_ns, bag.end_ns, COLUMNS)
    coarse_s = time.perf_counter() - begin
    slowest_s = 0.0
    while True:
        asked = time.perf_counter()
        exact = series.picture(_TOPIC, PATH, bag.begin_ns, bag.end_ns, COLUMNS)
        slowest_s = max(slowest_s, time.perf_counter() - asked)
        if exact.exact:
            break
        time.sleep(0.1)
    exact_s = time.perf_counter() - begin
    judge_that("plot: all samples are there", holds=exact.read == SAMPLES)
    zooms = [_zoom_s(series, bag.begin_ns, bag.end_ns) for _ in range(_ZOOMS)]
    say(
        f"  {SAMPLES:,} samples: coarse {coarse_s:.2f} s ({coarse.read:,} samples), "
        f"exact {exact_s:.1f} s, a picture meanwhile {slowest_s * 1000:.0f} ms at most, "
        f"zoom {median(zooms) * 1000:.1f} ms (at most {max(zooms) * 1000:.0f})"
    )
    judge("plot: coarse picture", coarse_s * 1000, at_most=1_000)
    judge("plot: zoom", max(zooms) * 1000, at_most=100)
    series.close()
    bag.close()
    return exact_s


def _zoom_s(series: RecordingSeries, begin_ns: int, end_ns: int) -> float:
    width = round((end_ns - begin_ns) * 10 ** -random.uniform(0, 4))
    from_ns = begin_ns + round(random.random() * (end_ns - begin_ns - width))
    begin = time.perf_counter()
    series.picture(_TOPIC, PATH, from_ns, from_ns + width, COLUMNS)
    return time.perf_counter() - begin


def _peer_s(file: Path) -> float:
    decode = codec_of(TypeLibrary("jazzy").message(TYPE)).decode
    begin = time.perf_counter()
    with file.open("rb") as stream:
        messages = make_reader(stream).iter_messages(topics=[_TOPIC])
        for _, _, message in islice(messages, SAMPLES // SHARE):
            _ = decode(message.data).point.x
    return time.perf_counter() - begin
