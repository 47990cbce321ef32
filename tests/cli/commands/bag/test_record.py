"""`studio bag record` beside talkers, and what others read of its bags (row B1)."""

from __future__ import annotations

import signal
import sqlite3
from contextlib import closing
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
import yaml
from rosbags.rosbag2 import Reader

from tests.support.command_line import started, studio
from tests.support.demos import heard, node_at
from tests.support.wire import wait_until
from tests.support.written_bags import told_by_mcap, told_by_rosbags

if TYPE_CHECKING:
    from collections.abc import Generator

pytestmark = pytest.mark.network


@pytest.fixture(scope="module", autouse=True)
def talkers(endpoint: str) -> Generator[None]:
    words = ("topic", "pub", "/chatter", "std_msgs/msg/String", "data: hi", "-r", "50")
    numbers = ("topic", "pub", "/number", "std_msgs/msg/Int32", "data: 7", "-r", "50")
    with started(endpoint, *words) as one, started(endpoint, *numbers) as other:
        one.wait_for("publishing #1")
        other.wait_for("publishing #1")
        yield


def counts(bag: Path) -> dict[str, int]:
    with Reader(bag) as reader:
        return {name: one.msgcount for name, one in reader.topics.items()}


def grows(folder: Path) -> bool:
    return sum(one.stat().st_size for one in folder.glob("*_*")) > 8_000


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_b1_one_topic_by_name_until_ctrl_c(endpoint: str, tmp_path: Path, number: signal.Signals):
    bag = tmp_path / "bag1"
    with started(endpoint, "bag", "record", "/number", "-o", str(bag)) as recording:
        recording.wait_for("Recording...")
        wait_until("it has some", lambda: grows(bag))
        assert recording.stop(number) == 0
        said = [line.partition("]: ")[2] for line in recording.printed.splitlines()]
    assert said[:2] == ["Subscribed to topic '/number'", "Recording..."]
    assert said[-1].startswith("Recording stopped: ")
    told = told_by_mcap(bag / "bag1_0.mcap")
    assert told == told_by_rosbags(bag)
    assert {data for _, _, data in told} == {bytes([0, 1, 0, 0, 7, 0, 0, 0])}
    assert said[-1] == f"Recording stopped: {len(told)} messages in bag1"


def test_all_but_what_is_excluded_in_the_storage_of_humble(endpoint: str, tmp_path: Path):
    bag = tmp_path / "bag"
    words = ("-a", "-x", "number|rosout", "-s", "sqlite3", "--compression-mode", "message",
             "--compression-format", "zstd", "--custom-data", "who=me", "where=here")  # fmt: skip
    with started(endpoint, "bag", "record", *words, "-o", str(bag)) as recording:
        recording.wait_for("Subscribed to topic '/chatter'")
        wait_until("it has more than five", lambda: _rows(bag / "bag_0.db3") > 5)
        recording.stop()
    found = counts(bag)
    assert found.keys() == {"/chatter", "/events/write_split", "/parameter_events"}
    assert found["/chatter"] > 5
    about = yaml.safe_load((bag / "metadata.yaml").read_text())["rosbag2_bagfile_information"]
    assert about["custom_data"] == {"who": "me", "where": "here"}
    assert (about["version"], about["compression_mode"]) == (9, "MESSAGE")


def test_files_are_split_and_services_steer_the_recorder(endpoint: str, tmp_path: Path):
    bag = tmp_path / "bag"
    at = ("--connect", endpoint)

    def called(name: str, kind: str) -> str:
        words = ("service", "call", f"/rec/{name}", f"rosbag2_interfaces/srv/{kind}")
        ran = studio(*words, *at)
        assert ran.code == 0, ran.err
        return ran.out

    words = ("--topic-types", "std_msgs/msg/Int32", "--node-name", "rec", "--start-paused",
             "--storage-preset-profile", "zstd_fast", "-o", str(bag))  # fmt: skip
    with (
        node_at(endpoint) as listener,
        started(endpoint, "bag", "record", *words) as recording,
    ):
        splits = heard(listener, "rosbag2_interfaces/msg/WriteSplitEvent", "/events/write_split")
        recording.wait_for("Recording...")
        assert "True" in called("is_paused", "IsPaused")
        assert "False" in called("snapshot", "Snapshot")
        called("resume", "Resume")
        wait_until("it has some", lambda: grows(bag) or _size(bag) > 3_000)
        called("split_bagfile", "SplitBagfile")
        wait_until("there are two", lambda: len(list(bag.glob("*.mcap"))) == 2)
        assert told_by_mcap(bag / "bag_0.mcap")
        wait_until("the split is told", lambda: bool(splits))
        told = (splits[0].closed_file, splits[0].opened_file, splits[0].node_name)
        assert told == (str(bag / "bag_0.mcap"), str(bag / "bag_1.mcap"), "/rec")
        called("stop", "Stop")
        assert recording.wait() == 0
    assert counts(bag)["/number"] > 10


def test_little_is_said_where_only_errors_are_wanted(endpoint: str, tmp_path: Path):
    bag = tmp_path / "bag"
    words = ("/number", "--log-level", "error", "-o", str(bag))
    with started(endpoint, "bag", "record", *words) as recording:
        wait_until("it has some", lambda: grows(bag))
        assert recording.stop() == 0
        assert recording.printed == ""


def _rows(database: Path) -> int:
    with closing(sqlite3.connect(f"file:{database}?mode=ro", uri=True)) as reader:
        return reader.execute("SELECT count(*) FROM messages").fetchone()[0]


def _size(bag: Path) -> int:
    return (bag / "bag_0.mcap").stat().st_size


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ((), "Say what to record"),
        (("--all-actions",), "--include-hidden-topics -e _action/ records them"),
        (("-a", "--repeat-transient-local", "/map=1"), "only the first file of a split bag"),
        (("-e", "("), "no regular expression"),
        (("-a", "-b", "100"), "1024 bytes or more"),
        (("-a", "-d", "-1"), "--max-bag-duration: give 0 or more"),
        (("-a", "--compression-format", "zstd"), "--compression-mode file or message"),
        (("-a", "--compression-mode", "message"), "zstd_fast"),
        (("-a", "--storage-preset-profile", "resilient"), "none of mcap"),
        (("-a", "--use-sim-time", "--no-discovery"), "leave --no-discovery out"),
        (("-a", "--custom-data", "=x"), "KEY=VALUE"),
        (("-a", "--storage-config-file", "none.yaml"), "cannot be used"),
        (("-a", "--qos-profile-overrides-path", "none.yaml"), "cannot be read"),
    ],
)
def test_what_cannot_be_done_is_told_in_a_sentence(
    endpoint: str, words: tuple[str, ...], said: str
):
    ran = studio("bag", "record", *words, "-o", "bag", "--connect", endpoint)
    assert (ran.code, ran.out) == (2, "")
    assert said in ran.err
    assert not Path("bag").exists()


def test_a_folder_that_is_there_is_not_written_into(endpoint: str, tmp_path: Path):
    ran = studio("bag", "record", "-a", "-o", str(tmp_path), "--connect", endpoint)
    assert ran.code == 2
    assert "there is something of that name already" in ran.err


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("noChunking: true", "noChunking is not offered"),
        ("compression: Brotli", "compression is one of None, Zstd, Lz4"),
        ("chunkSize: 0", "chunkSize is from 1"),
        ("- 1", "give keys"),
    ],
)
def test_a_storage_configuration_is_read_or_told(
    endpoint: str, tmp_path: Path, text: str, said: str
):
    file = tmp_path / "storage.yaml"
    file.write_text(text)
    words = ("-a", "--storage-config-file", str(file), "-o", "bag", "--connect", endpoint)
    assert said in studio("bag", "record", *words).err
