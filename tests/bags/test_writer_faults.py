"""Faults of the disk, and a process that is killed: what was written before can be read."""

from __future__ import annotations

import os
import resource
import signal
import sqlite3
import subprocess
import sys
import time
from contextlib import contextmanager
from typing import TYPE_CHECKING

import pytest

from studio.bags.mcap_writer import Chunking
from studio.bags.opening import open_bag
from studio.bags.writer import BagWriter, Storing
from studio.bags.writing_thread import TopicInput, WritingThread
from studio.errors import BagNotReadableError, BagNotWrittenError
from tests.support.permissions import open_folder, unprivileged
from tests.support.read_bags import read_bag
from tests.support.wire import wait_until
from tests.support.written_bags import (
    BEGIN_NS,
    TYPES,
    kept_in_mcap,
    recorded_topic,
    sample,
    told_by_mcap,
    told_by_rosbags,
)

if TYPE_CHECKING:
    from collections.abc import Generator
    from pathlib import Path

    from studio.bags.mcap_writer import ChunkCompression
    from studio.bags.writer import Storage

CHUNK = 40_000
KILLED = """
import sys
from pathlib import Path
from studio.bags.mcap_writer import Chunking
from studio.bags.writer import BagWriter, Storing
from tests.support.written_bags import BEGIN_NS, TYPES, recorded_topic, sample
how = Storing(storage=sys.argv[2], chunking=Chunking(bytes=40_000))
writer = BagWriter(Path(sys.argv[1]), TYPES, how)
number = writer.add_topic(recorded_topic("/words"))
for place in range(10_000_000):
    writer.write(number, sample(BEGIN_NS + place, place.to_bytes(4, "little") * 250))
    print(place, flush=True)
"""


@contextmanager
def at_most(size: int) -> Generator[None]:
    """Files of this process grow no larger: the system refuses, as it does on a full disk."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    handler = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
        signal.signal(signal.SIGXFSZ, handler)


def write_on(writer: BagWriter, number: int) -> None:
    """Write what is not compressed until the disk refuses."""
    for place in range(30_000):
        writer.write(number, sample(BEGIN_NS + place, os.urandom(1_000)))


@pytest.mark.parametrize("compression", ["", "zstd"])
def test_a_full_disk_ends_an_mcap_with_a_sentence_and_a_whole_file(
    tmp_path: Path, compression: ChunkCompression
):
    writer = BagWriter(tmp_path / "bag", TYPES, Storing(chunking=Chunking(CHUNK, compression)))
    number = writer.add_topic(recorded_topic("/words"))
    with at_most(1_000_000):
        with pytest.raises(BagNotWrittenError, match="written before is whole: free some room"):
            write_on(writer, number)
        written = writer.close()
    told = told_by_mcap(tmp_path / "bag" / "bag_0.mcap")
    assert told_by_rosbags(tmp_path / "bag") == told
    assert written.messages == len(told) == writer.count(number) > 900
    assert [at_ns for _, at_ns, _ in told] == list(range(BEGIN_NS, BEGIN_NS + len(told)))


def test_a_full_disk_ends_a_db3_with_a_sentence_and_a_whole_file(tmp_path: Path):
    writer = BagWriter(tmp_path / "bag", TYPES, Storing(storage="sqlite3"))
    number = writer.add_topic(recorded_topic("/words"))
    with at_most(9_000_000):
        with pytest.raises(BagNotWrittenError, match="What was written before is whole"):
            write_on(writer, number)
        written = writer.close()
    told = told_by_rosbags(tmp_path / "bag")
    assert written.messages == len(told) > 3_000
    database = sqlite3.connect(tmp_path / "bag" / "bag_0.db3")
    assert database.execute("PRAGMA integrity_check").fetchall() == [("ok",)]
    database.close()


def test_room_is_left_on_the_disk(tmp_path: Path):
    with pytest.raises(BagNotWrittenError, match="the disk is full"):
        BagWriter(tmp_path / "bag", TYPES, Storing(floor_bytes=2**62))


def test_messages_that_the_disk_refused_are_counted_as_lost(tmp_path: Path):
    ended: list[bool] = []
    writer = BagWriter(tmp_path / "bag", TYPES, Storing(chunking=Chunking(bytes=CHUNK)))
    with at_most(500_000):
        writing = WritingThread(writer, 2**40, lambda: ended.append(True))
        topic = TopicInput(recorded_topic("/words"))
        for place in range(1_000):
            writing.post(topic, [sample(BEGIN_NS + place, bytes(1_000))], 1_000)
        wait_until("the disk to refuse", lambda: bool(ended))
        writing.post(topic, [sample(BEGIN_NS + 1_000, b"late")], 4)
        written = writing.close()
    assert "whole" in writing.trouble
    assert topic.count == written.messages == len(told_by_rosbags(tmp_path / "bag")) > 300
    assert topic.lost == 1_001 - written.messages


def test_what_waits_beyond_the_room_is_dropped_and_counted(tmp_path: Path):
    writing = WritingThread(BagWriter(tmp_path / "bag", TYPES), 10_000)
    topic = TopicInput(recorded_topic("/words"))
    writing.post(topic, [sample(BEGIN_NS, bytes(4_000))] * 2, 8_000)
    writing.post(topic, [sample(BEGIN_NS, bytes(20_000))], 20_000)
    written = writing.close()
    assert (topic.count, topic.lost, topic.bytes) == (2, 1, 8_000)
    assert (written.messages, writing.trouble) == (2, "")


def test_a_folder_that_is_there_and_one_that_is_read_only_are_refused(tmp_path: Path):
    (tmp_path / "bag").mkdir()
    with pytest.raises(BagNotWrittenError, match="bag cannot be written: there is something"):
        BagWriter(tmp_path / "bag", TYPES)
    (tmp_path / "file").write_text("")
    with pytest.raises(BagNotWrittenError, match="Not a directory"):
        BagWriter(tmp_path / "file" / "bag", TYPES)


def test_a_read_only_folder_is_refused():
    with open_folder() as folder:
        folder.chmod(0o555)
        with unprivileged(), pytest.raises(BagNotWrittenError, match="Permission denied"):
            BagWriter(folder / "bag", TYPES)
        folder.chmod(0o755)


@pytest.mark.parametrize("storage", ["mcap", "sqlite3"])
def test_kill_9_leaves_all_but_the_last_chunk(tmp_path: Path, storage: Storage):
    bag = tmp_path / "bag"
    words = [sys.executable, "-c", KILLED, str(bag), storage]
    with subprocess.Popen(words, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        enough = 1_000 if storage == "mcap" else 10_000
        for line in process.stdout:
            if int(line) >= enough:
                process.kill()
                break
        last = max((int(one) for one in process.stdout.read().split() if one), default=enough)
    opened = read_bag(bag).messages
    if storage == "mcap":
        kept = kept_in_mcap(bag / "bag_0.mcap")
        assert len(kept) >= last - CHUNK / 1_000 - 1
    else:
        database = sqlite3.connect(bag / "bag_0.db3")
        kept = [one for (one,) in database.execute("SELECT data FROM messages ORDER BY id")]
        database.close()
        assert len(kept) >= last - 4_300
    assert [int.from_bytes(one[:4], "little") for one in kept] == list(range(len(kept)))
    assert [payload for _, _, payload in opened[: len(kept)]] == kept
    assert (bag / "metadata.yaml").is_file()


def test_a_slow_topic_is_on_the_disk_a_moment_later(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    writer = BagWriter(tmp_path / "bag", TYPES)
    number = writer.add_topic(recorded_topic("/words"))
    writer.write(number, sample(BEGIN_NS, b"word"))
    assert kept_in_mcap(tmp_path / "bag" / "bag_0.mcap") == []
    later_s = time.monotonic() + 10
    monkeypatch.setattr(time, "monotonic", lambda: later_s)
    writer.tend()
    assert kept_in_mcap(tmp_path / "bag" / "bag_0.mcap") == [b"word"]
    writer.close()


def test_what_is_no_bag_yet_is_told(tmp_path: Path):
    (tmp_path / "bag").mkdir()
    with pytest.raises(BagNotReadableError):
        open_bag(tmp_path / "bag")


@pytest.fixture
def small_disk(tmp_path: Path) -> Generator[Path]:
    """A file system of four megabytes, where this process may mount one."""
    disk = tmp_path / "disk"
    disk.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=4m", "tmpfs", str(disk)]
    if os.geteuid() != 0 or subprocess.run(mount, capture_output=True, check=False).returncode:
        pytest.skip("only root mounts a file system")
    yield disk
    subprocess.run(["umount", str(disk)], check=True)


@pytest.mark.parametrize("storage", ["mcap", "sqlite3"])
@pytest.mark.parametrize("floor", [0, 1_000_000])
def test_a_file_system_without_room_ends_a_bag_that_is_whole(
    small_disk: Path, storage: Storage, floor: int
):
    storing = Storing(storage=storage, chunking=Chunking(CHUNK), floor_bytes=floor)
    writer = BagWriter(small_disk / "bag", TYPES, storing)
    number = writer.add_topic(recorded_topic("/words"))
    with pytest.raises(BagNotWrittenError, match="written before is whole: free some room"):
        write_on(writer, number)
    told = told_by_rosbags(small_disk / "bag")
    assert writer.close().messages == len(told)
    assert storage == "sqlite3" or len(told) > 1_000


def test_a_bag_that_cannot_be_begun_leaves_no_folder(tmp_path: Path):
    folder = tmp_path / ("\u00e4" * 125)  # a name that a folder may have, and its file may not
    with pytest.raises(BagNotWrittenError):
        BagWriter(folder, TYPES)
    with pytest.raises(BagNotWrittenError, match="the disk is full"):
        BagWriter(tmp_path / "bag", TYPES, Storing(floor_bytes=2**62))
    assert list(tmp_path.iterdir()) == []
