from __future__ import annotations

import os
import sys
from typing import TYPE_CHECKING, Any

import pytest

from studio.bags.writer import Storing
from studio.ros.qos import DurabilityPolicy
from tests.support.command_line import started, studio
from tests.support.demos import call, heard, node_at, running
from tests.support.told_recording import LATCHED, ToldRecording, written
from tests.support.wire import wait_until

if TYPE_CHECKING:
    from collections.abc import Generator
    from pathlib import Path

    from studio.ros.client import Node

pytestmark = pytest.mark.network
INT = "std_msgs/msg/Int32"


@pytest.fixture(scope="module")
def bag(tmp_path_factory: pytest.TempPathFactory) -> Path:
    recording = ToldRecording()
    recording.add_topic("/number", INT)
    recording.add_topic("/other", INT)
    recording.add_topic("/latched", INT, LATCHED)
    recording.tell("/latched", 0, data=-1)
    for at in range(10):
        recording.tell("/number", at * 10, data=at)
        recording.tell("/other", at * 10, data=-at)
    return written(recording, tmp_path_factory.mktemp("bags") / "bag1")


@pytest.fixture
def listener(endpoint: str) -> Generator[Node]:
    with node_at(endpoint) as node:
        yield node


def numbers(messages: list[Any]) -> list[int]:
    return [one.data for one in messages]


def test_a_bag_is_played_with_the_lines_of_ros2(endpoint: str, listener: Node, bag: Path):
    came = heard(listener, INT, "/number")
    ran = studio("bag", "play", str(bag), "--connect", endpoint)
    assert ran.code == 0, ran.err
    wait_until("all came", lambda: numbers(came) == list(range(10)))
    said = [line.partition("]: ")[2] for line in ran.err.splitlines()]
    assert said == ["Set rate to 1", "Playback until timestamp: -1"]
    assert all("[rosbag2_player]" in line for line in ran.err.splitlines())


def test_names_topics_and_parts_are_chosen_as_with_ros2(
    endpoint: str, listener: Node, bag: Path, tmp_path: Path
):
    there, other = heard(listener, INT, "/elsewhere"), heard(listener, INT, "/other")
    late = heard(listener, INT, "/latched", LATCHED)
    qos = tmp_path / "qos.yaml"
    qos.write_text("/number: {depth: 3, durability: transient_local}\n")
    ran = studio("bag", "play", str(bag), "--topics", "/number", "latched", "--remap",
                 "/number:=/elsewhere", "--start-offset", "0.045", "--playback-duration", "0.02",
                 "-r", "2", "--qos-profile-overrides-path", str(qos),
                 "--connect", endpoint)  # fmt: skip
    assert ran.code == 0, ran.err
    # As latched as the file makes it, what was told before the part comes first.
    wait_until("the part came", lambda: numbers(there) == [2, 3, 4, 5, 6])
    wait_until("the latched came", lambda: numbers(late) == [-1])
    assert not other
    assert "Overriding QoS profile for topic /number" in ran.err


def test_several_bags_are_played_together(endpoint: str, listener: Node, bag: Path, tmp_path: Path):
    recording = ToldRecording()
    recording.add_topic("/more", INT)
    recording.add_topic("/number", INT)
    for at in range(3):
        recording.tell("/more", 15 + at * 10, data=at)
    recording.tell("/number", 65, data=100)
    other = written(recording, tmp_path / "bag2", Storing("sqlite3"))
    number, more = heard(listener, INT, "/number"), heard(listener, INT, "/more")
    words = ("-i", str(bag), "mcap", "-i", str(other))
    ran = studio("bag", "play", *words, "--connect", endpoint)
    assert ran.code == 0, ran.err
    wait_until("all came", lambda: len(number) == 11 and len(more) == 3)
    assert numbers(number) == [0, 1, 2, 3, 4, 5, 6, 100, 7, 8, 9]
    assert numbers(more) == [0, 1, 2]


def test_a_looping_player_is_steered_by_services_and_ended_by_ctrl_c(
    endpoint: str, listener: Node, bag: Path
):
    clock = heard(listener, "rosgraph_msgs/msg/Clock", "/clock")
    words = ("bag", "play", str(bag), "--loop", "--clock", "100", "--start-paused")
    with started(endpoint, *words) as player:
        player.wait_for("Playback until timestamp")
        kind, name = "rosbag2_interfaces/srv/", "/rosbag2_player/"
        assert call(listener, f"{kind}IsPaused", f"{name}is_paused").paused
        assert call(listener, f"{kind}Burst", f"{name}burst", num_messages=3).actually_burst == 3
        call(listener, f"{kind}Resume", f"{name}resume")
        wait_until("the time has gone back", lambda: went_back(clock))
        ends = listener.graph.publishers("/latched")
        assert [one.qos.durability for one in ends] == [DurabilityPolicy.TRANSIENT_LOCAL]
        player.stop()
        assert "Traceback" not in player.printed


def went_back(clock: list[Any]) -> bool:
    times = [(one.clock.sec, one.clock.nanosec) for one in clock]
    return times != sorted(times)


def test_stop_ends_the_line(endpoint: str, listener: Node, bag: Path):
    with started(endpoint, "bag", "play", str(bag), "--loop") as player:
        player.wait_for("Playback until timestamp")
        call(listener, "rosbag2_interfaces/srv/Stop", "/rosbag2_player/stop")
        assert player.wait() == 0
        assert "Stopping playback." in player.printed


def test_keys_steer_a_player_at_a_terminal(endpoint: str, bag: Path):
    ours, theirs = os.openpty()
    words = ["-m", "studio", "bag", "play", str(bag), "--loop", "--start-paused"]
    with running([sys.executable, *words], endpoint, theirs) as player:
        player.wait_for("Press CURSOR_DOWN for Decrease Rate 10%")
        player.wait_for("Playback until timestamp")
        for key, said in (
            (b" ", "Resuming play."),
            (b" ", "Pausing play."),
            (b"\x1b[A", "Set rate to 1.1"),
            (b"\x1b[B\x1b[B", "Set rate to 0.9"),
        ):
            os.write(ours, key)
            player.wait_for(said)
        player.stop()
        assert "Traceback" not in player.printed
        assert "Fatal" not in player.printed
    os.close(ours)
    os.close(theirs)


def test_how_far_it_is_is_shown(endpoint: str, bag: Path):
    ran = studio("bag", "play", str(bag), "--progress-bar-update-rate", "50", "--connect", endpoint)
    lines = ran.out.replace("\n", "\r").split("\r")
    assert "Duration 0.09/0.09 [S]" in ran.out
    assert all("] Duration 0.0" in line for line in lines if line)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["none"], "Bag path 'none' does not exist!"),
        (["-i", "none"], "Bag path 'none' does not exist!"),
        ([], "Say what to play"),
        (["BAG", "-i", "BAG"], "one BAG alone, or each bag with -i"),
        (["BAG", "--message-order", "sent"], "the order in which they were received"),
        (["BAG", "--rate", "0"], "not in the valid range (> 0.0)"),
        (["BAG", "--delay", "-1"], "less than zero"),
        (["BAG", "--clock", "--clock-topics-all"], "not allowed with"),
        (["BAG", "--regex", "["], "--regex [: "),
        (["BAG", "--qos-profile-overrides-path", "none.yaml"], "none.yaml cannot be read"),
        (["BAG", "--publish-service-requests"], "sends no requests of services"),
        (["BAG", "--remap", "nothing"], "nothing"),
    ],
)
def test_what_cannot_be_done_is_said(endpoint: str, bag: Path, words: list[str], said: str):
    given = [str(bag) if word == "BAG" else word for word in words]
    ran = studio("bag", "play", *given, "--connect", endpoint)
    assert ran.code == 2
    assert said in ran.err
    assert "Traceback" not in ran.err
