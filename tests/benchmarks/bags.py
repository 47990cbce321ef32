"""Bags read by the studio beside the libraries `mcap` and `rosbags`, all of them on one bag.

The bag is that of `bag_drag`: 70 s, 52 topics and 1 GB, here in chunks of zstd, with the IMU, the
joints and TF at 1 kHz. All payloads are bytes as they were recorded; nobody decodes them.
Contenders take turns, and the file is in the system's cache for all of them. Reading all is
measured in processor time: none of them uses a second thread, and it is the same whoever else uses
the machine. The memory is that of processes of their own, which read a sparse file of 10 GB.
"""

from __future__ import annotations

import json
import random
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from mcap.reader import make_reader
from rosbags.highlevel import AnyReader

from studio.bags.mcap_writer import Chunking
from studio.bags.opening import open_bag
from studio.bags.writer import Storing
from tests.benchmarks.bag_drag import write_bench_bag
from tests.benchmarks.bags_process import STATES, write_sparse_bag
from tests.benchmarks.report import (
    Timings,
    judge,
    judge_ratio,
    judge_that,
    note,
    say,
    say_beside,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from mcap.reader import McapReader

    from studio.bags.bag import Bag

RATES_HZ: Final = {"/imu": 1_000.0, "/joint_states": 1_000.0, "/tf": 1_000.0}
_TIMES: Final = 15
_READINGS: Final = 5
_OPENINGS: Final = 15
_SUMMARY_BYTES: Final = 4096
"""So much at the end of a file is cut off: its footer, and with it the way to its index."""
_MEMORY_MB: Final = 128.0
"""64 MB of chunks, 32 MB of indexes, its table, and what is read ahead and handed out."""
_END_NS: Final = 2**63 - 1
State = dict[str, bytes]


def run() -> None:
    """Make the bag and put the same questions to all."""
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        bag = write_bench_bag(
            folder / "drive", Storing(chunking=Chunking(compression="zstd")), RATES_HZ
        )
        (file,) = bag.glob("*.mcap")
        say(f"a bag of {file.stat().st_size / 1e6:.0f} MB, chunks of zstd")
        _openings(bag, file, folder)
        _states(bag, file)
        _readings(bag, file)
    with tempfile.TemporaryDirectory() as scratch:
        _memory(write_sparse_bag(Path(scratch) / "sparse.mcap"))


# Opening


def _openings(bag: Path, file: Path, folder: Path) -> None:
    """Open the bag, and one that was cut off, beside the library's summary of the whole one."""
    cut = _cut_off(file, folder / "cut.mcap")
    kept_in = folder / "kept"
    begin_s = time.perf_counter()
    _open(cut, kept_in)
    note("a bag that was cut off: its index is made in", f"{time.perf_counter() - begin_s:.2f} s")
    ours, kept = Timings("the studio, and its topics"), Timings("cut off, its index kept")
    library = Timings("mcap: get_summary")
    for _ in range(_OPENINGS):
        for timings, opened in (
            (ours, lambda: _open(bag, kept_in)),
            (library, lambda: _summary(file)),
            (kept, lambda: _open(cut, kept_in)),
        ):
            with timings.measure():
                opened()
    say_beside("a bag is opened", ours, kept, library)
    for what, timings in (("", ours), (" that was cut off, its index kept,", kept)):
        judge(
            f"a bag{what} is opened with its topics, beside mcap's summary",
            timings.median_ms / library.median_ms,
            at_most=1.5,
            unit="of it",
        )
    _first_openings(bag, file)


def _first_openings(bag: Path, file: Path) -> None:
    """Open it as the first of a process, in which nothing is at hand: neither types nor caches."""
    ours, topics = (
        Timings("the studio"),
        Timings("the studio, until its topics and types are there"),
    )
    library = Timings("mcap: get_summary")
    for _ in range(_READINGS):
        found = _in_process("ours", "open", bag)
        ours.values_ms.append(found["open_ms"])
        topics.values_ms.append(found["topics_ms"])
        library.values_ms.append(_in_process("mcap", "open", file)["open_ms"])
    say_beside("a bag is opened, the first of a process", ours, topics, library)
    judge(
        "a bag is opened as the first of a process, beside mcap's summary",
        ours.median_ms / library.median_ms,
        at_most=1.5,
        unit="of it",
    )
    note("the same, with its topics and types", f"{topics.median_ms / library.median_ms:.3g} of it")


def _cut_off(file: Path, target: Path) -> Path:
    shutil.copyfile(file, target)
    with target.open("r+b") as stream:
        stream.truncate(file.stat().st_size - _SUMMARY_BYTES)
    return target


def _open(path: Path, kept_in: Path) -> None:
    bag = open_bag(path, kept_in=kept_in)
    assert len(bag.topics) == 52
    bag.close()


def _summary(file: Path) -> None:
    with file.open("rb") as stream:
        summary = make_reader(stream).get_summary()
        assert summary is not None
        assert len(summary.channels) == 52


# The state at a time


def _states(bag_path: Path, file: Path) -> None:
    """Ask for the newest message of each topic at times anywhere in the bag."""
    hand = random.Random(3)
    with ExitStack() as stack:
        bag = open_bag(bag_path)
        stack.callback(bag.close)
        reader = make_reader(stack.enter_context(file.open("rb")))
        topics = [one.name for one in bag.topics]
        ways: list[tuple[Timings, Callable[[int], State]]] = [
            (Timings("the studio"), lambda at_ns: _our_state(bag, topics, at_ns)),
            (Timings("mcap, backwards"), lambda at_ns: _backwards(reader, topics, at_ns)),
            (Timings("mcap, from the begin"), lambda at_ns: _forwards(reader, at_ns)),
            (Timings("mcap, topic by topic"), lambda at_ns: _by_topic(reader, topics, at_ns)),
        ]
        same = True
        for _ in range(_TIMES):
            at_ns = bag.begin_ns + round(hand.random() * (bag.end_ns - bag.begin_ns))
            found = [_timed(timings, way, at_ns) for timings, way in ways]
            same = same and all(one == found[0] for one in found)
    (ours, *peers) = [timings for timings, _ in ways]
    say_beside("the state of all topics at a time", ours, *peers)
    judge_that("the state at a time is that of mcap, byte by byte", holds=same)
    judge_ratio(
        "the state at a time, beside mcap's reader until all topics came",
        min(peers[0].median_ms, peers[1].median_ms) / ours.median_ms,
        at_least=50,
    )
    note("the same, beside mcap asked topic by topic", f"{_times(peers[2], ours)} times")


def _timed(timings: Timings, way: Callable[[int], State], at_ns: int) -> State:
    with timings.measure():
        return way(at_ns)


def _our_state(bag: Bag, topics: list[str], at_ns: int) -> State:
    return {topic: one.payload for topic, one in bag.latest(topics, at_ns).items()}


def _backwards(reader: McapReader, topics: list[str], at_ns: int) -> State:
    missing, found = set(topics), State()
    for _, channel, message in reader.iter_messages(ending_at=at_ns, reverse=True):
        if channel.topic in missing:
            missing.remove(channel.topic)
            found[channel.topic] = message.data
            if not missing:
                break
    return found


def _forwards(reader: McapReader, at_ns: int) -> State:
    found = State()
    for _, channel, message in reader.iter_messages(ending_at=at_ns):
        found[channel.topic] = message.data
    return found


def _by_topic(reader: McapReader, topics: list[str], at_ns: int) -> State:
    found = State()
    for topic in topics:
        for _, _, message in reader.iter_messages(topic, ending_at=at_ns, reverse=True):
            found[topic] = message.data
            break
    return found


# All messages


def _readings(bag_path: Path, file: Path) -> None:
    """Read all messages by their times, by each in turn."""
    with ExitStack() as stack:
        bag = open_bag(bag_path)
        stack.callback(bag.close)
        topics = [one.name for one in bag.topics]
        reader = make_reader(stack.enter_context(file.open("rb")))
        other = stack.enter_context(AnyReader([bag_path]))

        def ours() -> Iterator[bytes]:
            return (one.payload for _, one in bag.messages(topics, 0, _END_NS))

        def by_mcap() -> Iterator[bytes]:
            return (message.data for _, _, message in reader.iter_messages())

        def by_rosbags() -> Iterator[bytes]:
            return (data for _, _, data in other.messages())

        ways = [
            (Timings("the studio"), ours),
            (Timings("mcap"), by_mcap),
            (Timings("rosbags"), by_rosbags),
        ]
        counts: set[tuple[int, int]] = set()
        for turn in range(_READINGS):
            for timings, payloads in (ways, ways[::-1])[turn % 2]:
                begin_s = time.process_time()
                counts.add(_counted(payloads()))
                timings.values_ms.append((time.process_time() - begin_s) * 1e3)
    (mine, library, rosbags) = [timings for timings, _ in ways]
    say_beside("all messages are read, processor time", mine, library, rosbags)
    judge_that("all messages: as many, and as many bytes, by each", holds=len(counts) == 1)
    for peer, at_least in ((library, 1.8), (rosbags, 1.4)):
        judge_ratio(
            f"all messages of a bag are read, beside {peer.name}",
            peer.median_ms / mine.median_ms,
            at_least=at_least,
        )


def _counted(payloads: Iterator[bytes]) -> tuple[int, int]:
    count = size = 0
    for one in payloads:
        count += 1
        size += len(one)
    return count, size


# Memory


def _memory(file: Path) -> None:
    """Read a file that is larger than the memory of many machines, in processes of their own."""
    say(f"a sparse bag of {file.stat().st_size / 1e9:.1f} GB")
    ours = _in_process("ours", "all", file)
    library = _in_process("mcap", "all", file)
    for name, found in (("the studio", ours), ("mcap, without states", library)):
        say(f"  {name:<24}{json.dumps(found)}")
    judge(
        f"a bag of 10 GB: memory for opening, {STATES} states and reading all",
        ours["peak_mb"],
        at_most=_MEMORY_MB,
        unit="MB",
    )
    note("the same, mcap opening it and reading all", f"{library['peak_mb']:.0f} MB")
    judge_that("a bag of 10 GB: as many messages", holds=ours["count"] == library["count"])


def _in_process(reader: str, what: str, path: Path) -> dict[str, Any]:
    words = [sys.executable, "-m", "tests.benchmarks.bags_process", reader, what, str(path)]
    done = subprocess.run(words, check=True, capture_output=True, text=True)
    return json.loads(done.stdout.splitlines()[-1])


def _times(peer: Timings, ours: Timings) -> str:
    return f"{statistics.median(peer.values_ms) / ours.median_ms:.3g}"
