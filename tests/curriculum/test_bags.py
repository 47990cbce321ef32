"""The course's row on bags, B1: record /number, look at the file, and play it to a node."""

from __future__ import annotations

import signal
import time
from typing import TYPE_CHECKING

import pytest
from rosbags.rosbag2 import Reader

from studio.bags.opening import open_bag
from tests.support.command_line import started, studio
from tests.support.demos import heard, node_at
from tests.support.wire import wait_until

if TYPE_CHECKING:
    from pathlib import Path

pytestmark = pytest.mark.network
INT = "example_interfaces/msg/Int64"


def test_b1_number_is_recorded_reopened_with_equal_counts_and_played(
    endpoint: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("HOME", str(tmp_path))
    (tmp_path / "bags").symlink_to(tmp_path)
    with node_at(endpoint) as node:
        told = heard(node, INT, "/number")
        publisher = node.create_publisher(node.wire.types.message(INT), "/number", 10)
        with started(endpoint, "bag", "record", "/number", "-o", "bag1") as recorder:
            recorder.wait_for("Subscribed to topic '/number'")
            wait_until("it listens", lambda: node.count_subscribers("/number") == 2)
            for at in range(50):
                publisher.publish(publisher.msg_type(data=at))
                time.sleep(0.002)
            wait_until("all were told", lambda: len(told) == 50)
            wait_until("all are written", lambda: size_of(tmp_path / "bag1") > 0)
            assert recorder.stop(signal.SIGINT) == 0, recorder.printed
        node.destroy_publisher(publisher)
        names = sorted(one.name for one in (tmp_path / "bag1").iterdir())
        assert names == ["bag1_0.mcap", "metadata.yaml"]
        with Reader(tmp_path / "bag1") as theirs:
            assert theirs.message_count == 50
        bag = open_bag(tmp_path / "bag1")
        assert [(one.name, one.type_name, one.count) for one in bag.topics] == [
            ("/number", INT, 50)
        ]
        bag.close()
        played = heard(node, INT, "/number")
        ran = studio("bag", "play", "~/bags/bag1/", "--connect", endpoint)
        assert ran.code == 0, ran.err
        wait_until("a node hears all of it", lambda: [one.data for one in played] == [*range(50)])


def size_of(folder: Path) -> int:
    return sum(one.stat().st_size for one in folder.glob("*.mcap"))
