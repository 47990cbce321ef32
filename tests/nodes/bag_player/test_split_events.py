from __future__ import annotations

import contextlib
from typing import TYPE_CHECKING, Any
from uuid import uuid4

import pytest

from studio.bags.opening import open_bag, open_together
from studio.bags.writer import Storing
from studio.nodes.bag_player.offers import Choice
from studio.nodes.bag_player.options import PlayOptions
from studio.nodes.bag_player.player import BagPlayer
from tests.support.demos import heard, node_at
from tests.support.told_recording import BEGIN_NS, MS, ToldRecording, written
from tests.support.wire import wait_until

if TYPE_CHECKING:
    from collections.abc import Generator
    from pathlib import Path

    from studio.bags.bag import Bag
    from studio.ros.client import Node

pytestmark = pytest.mark.network
EVENT = "rosbag2_interfaces/msg/ReadSplitEvent"
TOPIC = "/events/read_split"


@pytest.fixture(scope="module")
def speaker(endpoint: str) -> Generator[Node]:
    with node_at(endpoint, "rosbag2_player") as node:
        yield node


@pytest.fixture
def events(endpoint: str, speaker: Node) -> Generator[list[Any]]:
    """What a node hears of whom the player's node knows; none of another test has its name."""
    name = f"listener_{uuid4().hex}"
    with node_at(endpoint, name) as node:
        came = heard(node, EVENT, TOPIC)
        wait_until(
            "the player's node sees who listens",
            lambda: any(
                one.node_name == name for one in speaker.get_subscriptions_info_by_topic(TOPIC)
            ),
        )
        yield came


def split_bag(folder: Path, files: int = 3) -> Path:
    """A number every 100 ms, two of them in each file; the first file alone has another topic."""
    recording = ToldRecording()
    recording.add_topic("/split/number")
    recording.add_topic("/split/early")
    recording.tell("/split/early", 0, data="early")
    for at in range(2 * files):
        recording.tell("/split/number", at * 100, data=str(at))
    made = written(recording, folder, Storing(max_s=0.15))
    assert len(list(made.glob("*.mcap"))) == files
    return made


def play(bag: Bag, speaker: Node, options: PlayOptions) -> None:
    """Play to the end."""
    player = BagPlayer(speaker, bag, options, splits=bag.splits)
    try:
        assert player.play()
        assert player.wait(60)
    finally:
        player.close()


@pytest.mark.parametrize(
    "options",
    [
        pytest.param(PlayOptions(rate=20), id="all"),
        pytest.param(PlayOptions(rate=20, choice=Choice(topics=("/split/early",))), id="early"),
        pytest.param(PlayOptions(rate=20, start_offset_ns=450 * MS), id="from the last file on"),
    ],
)
def test_nodes_hear_of_each_file_that_playing_goes_on_to(
    speaker: Node, events: list[Any], tmp_path: Path, options: PlayOptions
):
    """Also of those in which nothing is played, as with rosbag2, which reads them all."""
    folder = split_bag(tmp_path / "bag")
    with contextlib.closing(open_bag(folder)) as bag:
        play(bag, speaker, options)
    wait_until("all came", lambda: len(events) == 2)
    files = [str(folder / f"bag_{number}.mcap") for number in range(3)]
    told = [(one.closed_file, one.opened_file) for one in events]
    assert told == [(files[0], files[1]), (files[1], files[2])]
    assert {one.node_name for one in events} == {"/rosbag2_player"}


def test_a_file_that_is_not_reached_is_not_told_of(
    speaker: Node, events: list[Any], tmp_path: Path
):
    folder = split_bag(tmp_path / "bag")
    options = PlayOptions(rate=20, duration_ns=250 * MS)
    with contextlib.closing(open_bag(folder)) as bag:
        play(bag, speaker, options)
    wait_until("one came", lambda: len(events) > 0)
    assert [one.opened_file for one in events] == [str(folder / "bag_1.mcap")]


def test_an_event_comes_with_the_first_message_of_a_file_and_again_after_a_seek(
    speaker: Node, events: list[Any], tmp_path: Path
):
    with contextlib.closing(open_bag(split_bag(tmp_path / "bag"))) as bag:
        player = BagPlayer(speaker, bag, PlayOptions(starts_paused=True), splits=bag.splits)
        try:
            assert player.play()
            wait_until("it has read", lambda: player.burst(3) == 3)
            assert player.sent == 3  # what the first file has
            assert not events
            assert player.play_next()
            wait_until("the second file is told", lambda: len(events) == 1)
            assert player.seek(BEGIN_NS)
            assert player.burst(4) == 4
            wait_until("and again", lambda: len(events) == 2)
        finally:
            player.close()
    assert events[0] == events[1]


def test_of_bags_played_together_each_tells_of_its_own_files(tmp_path: Path):
    one, other = split_bag(tmp_path / "one", 2), split_bag(tmp_path / "other", 3)
    with contextlib.closing(open_together([one, other])) as bag:
        told = [(split.closed.name, split.opened.name) for split in bag.splits]
    assert told == [
        ("one_0.mcap", "one_1.mcap"),
        ("other_0.mcap", "other_1.mcap"),
        ("other_1.mcap", "other_2.mcap"),
    ]
