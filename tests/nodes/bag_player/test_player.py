from __future__ import annotations

import time
from contextlib import contextmanager
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import pytest

from studio.errors import RecordingError
from studio.nodes.bag_player.offers import Choice
from studio.nodes.bag_player.options import PlayOptions
from studio.nodes.bag_player.player import ROUND_S, BagPlayer
from studio.ros.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from tests.support.demos import heard, node_at
from tests.support.told_recording import BEGIN_NS, LATCHED, MS, ToldRecording
from tests.support.wire import wait_until

if TYPE_CHECKING:
    from collections.abc import Generator

    from studio.ros.client import Node

pytestmark = pytest.mark.network

STRING = "std_msgs/msg/String"
CLOCK = "rosgraph_msgs/msg/Clock"
FAST = PlayOptions(rate=100.0)
HELD = PlayOptions(starts_paused=True)


@pytest.fixture(scope="module")
def speaker(endpoint: str) -> Generator[Node]:
    with node_at(endpoint, "rosbag2_player") as node:
        yield node


@pytest.fixture(scope="module")
def listener(endpoint: str) -> Generator[Node]:
    with node_at(endpoint) as node:
        yield node


@contextmanager
def player_of(
    node: Node, recording: ToldRecording, options: PlayOptions = FAST
) -> Generator[BagPlayer]:
    player = BagPlayer(node, recording, options)
    try:
        yield player
    finally:
        player.stop()
        player.close()


def told(messages: list[Any]) -> list[str]:
    return [one.data for one in messages]


def numbers(name: str, count: int = 5, apart_ms: float = 10) -> ToldRecording:
    """A topic with the messages 0, 1, 2 and so on."""
    recording = ToldRecording()
    recording.add_topic(name)
    for at in range(count):
        recording.tell(name, at * apart_ms, data=str(at))
    return recording


def hearing(listener: Node, speaker: Node, *names: str) -> dict[str, list[Any]]:
    """What is heard on topics, once the player's node sees who listens."""
    found = {name: heard(listener, STRING, name) for name in names}
    wait_until(
        "the player sees who listens",
        lambda: all(speaker.count_subscribers(name) for name in names),
    )
    return found


def test_messages_come_in_their_order_with_their_bytes(speaker: Node, listener: Node):
    recording = ToldRecording()
    raw: list[bytes] = []
    for name in ("/both/a", "/both/b"):
        recording.add_topic(name)
    for at in range(20):
        recording.tell(f"/both/{'ab'[at % 2]}", at, data=f"message {at}")
    listener.create_subscription(speaker.wire.types.message(STRING), "/both/a", raw.append, 100,
                                 raw=True)  # fmt: skip
    came = hearing(listener, speaker, "/both/a", "/both/b")
    with player_of(speaker, recording) as player:
        assert player.topics == ["/both/a", "/both/b"]
        assert player.play()
        assert player.wait(60)
        wait_until("all came", lambda: len(came["/both/b"]) == 10 and len(raw) == 10)
        assert player.sent == 20
    assert told(came["/both/a"]) == [f"message {at}" for at in range(0, 20, 2)]
    assert raw == [one.payload for one in recording.last("/both/a", recording.end_ns, 100)]


def test_messages_keep_their_distances_whatever_the_rate(speaker: Node):
    """A message is never early; the last is as late as the first, for nothing adds up."""
    recording = numbers("/paced", 50, apart_ms=20)
    with player_of(speaker, recording, PlayOptions(rate=4.0)) as player:
        begun_s = time.monotonic()
        assert player.play()
        assert player.wait(60)
        took_s = time.monotonic() - begun_s
        assert player.sent == 50
    assert took_s >= 49 * 0.020 / 4


def test_a_rate_that_changes_counts_at_once(speaker: Node):
    recording = numbers("/hour", 2, apart_ms=3_600_000)
    with player_of(speaker, recording, PlayOptions()) as player:
        player.play()
        wait_until("the first was sent", lambda: player.sent == 1)
        assert not player.set_rate(0)
        assert not player.set_rate(float("nan"))
        assert player.rate == 1
        assert player.set_rate(1e6)
        assert player.wait(60)
        assert player.sent == 2


def test_a_paused_player_sends_nothing_but_what_is_asked_for(speaker: Node, listener: Node):
    came = hearing(listener, speaker, "/held")["/held"]
    with player_of(speaker, numbers("/held", 6), HELD) as player:
        assert not player.play_next()  # it does not play yet
        player.play()
        wait_until("it has read", player.play_next)
        assert player.now_ns() == BEGIN_NS
        assert player.play_next()
        assert player.now_ns() == BEGIN_NS + 10 * MS
        assert player.burst(2) == 2
        wait_until("four came", lambda: len(came) == 4)
        assert player.burst() == 2
        assert player.burst() == 0
        assert not player.play_next()
        assert player.is_playing  # a paused one stays at its end, as rosbag2's does
        player.toggle_paused()
        assert not player.is_paused
        assert player.wait(60)
        assert player.burst() == 0
        assert not player.play_next()
    wait_until("all came", lambda: len(came) == 6)
    assert told(came) == list("012345")


def test_seeking_goes_on_elsewhere_forwards_and_backwards(speaker: Node, listener: Node):
    came = hearing(listener, speaker, "/sought")["/sought"]
    with player_of(speaker, numbers("/sought", 10), HELD) as player:
        assert not player.seek(BEGIN_NS)
        player.play()
        wait_until("it plays", lambda: player.seek(BEGIN_NS + 75 * MS))
        assert player.now_ns() == BEGIN_NS + 75 * MS
        assert player.burst() == 2  # 8 and 9, and stands at its end
        assert player.seek(0)  # before the beginning is the beginning
        assert player.burst(2) == 2
        assert player.seek(BEGIN_NS + 90 * MS)
        player.resume()
        assert player.wait(60)
    wait_until("all came", lambda: len(came) == 5)
    assert told(came) == ["8", "9", "0", "1", "9"]


def test_a_loop_begins_again_until_it_is_stopped(speaker: Node, listener: Node):
    came = hearing(listener, speaker, "/looped")["/looped"]
    with player_of(speaker, numbers("/looped", 3), replace(FAST, is_looping=True)) as player:
        player.play()
        wait_until("the third round", lambda: len(came) >= 7)
        assert not player.play()
        player.stop()
        assert not player.is_playing
    assert told(came)[:7] == list("0120120")


def test_a_loop_of_one_moment_rests_between_its_rounds(speaker: Node):
    with player_of(speaker, numbers("/moment", 1), replace(FAST, is_looping=True)) as player:
        begun_s = time.monotonic()
        player.play()
        wait_until("four rounds", lambda: player.sent >= 4)
        assert time.monotonic() - begun_s >= 3 * ROUND_S


def test_a_loop_of_nothing_ends(speaker: Node):
    recording = ToldRecording()
    recording.add_topic("/silent")
    with player_of(speaker, recording, replace(FAST, is_looping=True)) as player:
        player.play()
        assert player.wait(60)


@pytest.mark.parametrize(
    ("options", "expected"),
    [
        (replace(FAST, start_offset_ns=25 * MS), "345678"),
        (replace(FAST, duration_ns=30 * MS), "0123"),
        (replace(FAST, duration_ns=0), ""),
        (replace(FAST, until_ns=BEGIN_NS + 20 * MS), "012"),
        (replace(FAST, start_offset_ns=20 * MS, duration_ns=20 * MS), "234"),
        (replace(FAST, duration_ns=10 * MS, until_ns=BEGIN_NS + 20 * MS), "012"),
        (replace(FAST, start_offset_ns=1_000 * MS), ""),
    ],
)
def test_only_a_part_is_played(speaker: Node, options: PlayOptions, expected: str, endpoint: str):
    with node_at(endpoint) as listener:
        came = hearing(listener, speaker, "/part")["/part"]
        with player_of(speaker, numbers("/part", 9), options) as player:
            player.play()
            assert player.wait(60)
            assert player.sent == len(expected)
            wait_until("all came", lambda: len(came) == len(expected))
        assert told(came) == list(expected)


def test_a_delay_comes_before_each_round(speaker: Node):
    options = replace(FAST, delay_ns=50 * MS, is_looping=True)
    with player_of(speaker, numbers("/late", 1), options) as player:
        begun_s = time.monotonic()
        player.play()
        wait_until("two rounds", lambda: player.sent >= 2)
        assert time.monotonic() - begun_s >= 0.1


def test_latched_messages_from_before_come_first_and_late_ones_hear_them(
    speaker: Node, endpoint: str
):
    """Of `/tf_static` each of three publishers said one; all three come before anything else."""
    recording = numbers("/moving", 10)
    recording.add_topic("/fixed", STRING, LATCHED, LATCHED, LATCHED)
    for at, name in enumerate(("laser", "camera", "imu")):
        recording.tell("/fixed", at, data=name)
    options = replace(HELD, start_offset_ns=50 * MS)
    with node_at(endpoint) as listener:
        order: list[str] = []
        for name, qos in (
            ("/moving", QoSProfile(depth=100)),
            ("/fixed", replace(LATCHED, depth=9)),
        ):
            kind = listener.wire.types.message(STRING)
            listener.create_subscription(kind, name, lambda one: order.append(one.data), qos)
        wait_until("they are seen", lambda: speaker.count_subscribers("/moving") == 1)
        with player_of(speaker, recording, options) as player:
            player.play()
            wait_until("the latched came", lambda: len(order) == 3)
            wait_until("one is played", player.play_next)
            wait_until("it came", lambda: len(order) == 4)
            assert order == ["laser", "camera", "imu", "5"]
            late = heard(listener, STRING, "/fixed", replace(LATCHED, depth=9))
            wait_until("a late one hears all", lambda: len(late) == 3)


def test_what_is_latched_by_its_name_is_offered_so_where_a_bag_tells_no_quality(
    speaker: Node, endpoint: str
):
    recording = numbers("/robot_description", 2)
    with player_of(speaker, recording) as player, node_at(endpoint) as listener:
        player.play()
        assert player.wait(60)
        late = heard(listener, STRING, "/robot_description", LATCHED)
        wait_until("a late one hears the last", lambda: told(late) == ["1"])


def test_a_latched_message_that_a_seek_passes_over_is_told(speaker: Node, listener: Node):
    recording = numbers("/beside", 10)
    recording.add_topic("/map", STRING, LATCHED)
    recording.tell("/map", 1, data="old")
    recording.tell("/map", 55, data="new")
    came = heard(listener, STRING, "/map", replace(LATCHED, depth=9))
    with player_of(speaker, recording, HELD) as player:
        player.play()
        wait_until("it plays", lambda: player.seek(BEGIN_NS + 60 * MS))
        wait_until("the newer one came", lambda: told(came) == ["new"])
        player.seek(BEGIN_NS + 70 * MS)  # it is the same there
        player.seek(BEGIN_NS + 30 * MS)
        wait_until("the older one came", lambda: told(came) == ["new", "old"])


def test_a_topic_is_offered_as_it_was_or_as_a_file_says(speaker: Node):
    recording = ToldRecording()
    quick = QoSProfile(depth=3, reliability=ReliabilityPolicy.BEST_EFFORT)
    recording.add_topic("/qos/quick", STRING, quick, quick)
    recording.add_topic("/qos/mixed", STRING, quick, LATCHED)
    recording.add_topic("/qos/other", STRING, quick)
    overrides = {"/qos/other": QoSProfile(depth=7, durability=DurabilityPolicy.TRANSIENT_LOCAL)}
    with player_of(speaker, recording, PlayOptions(overrides=overrides)):
        offered = {
            name: speaker.graph.publishers(f"/qos/{name}")[0].qos
            for name in ("quick", "mixed", "other")
        }
    assert offered["quick"] == QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT)
    assert offered["mixed"] == QoSProfile(depth=10)
    assert offered["other"] == overrides["/qos/other"]


def test_the_time_is_told_so_often_and_stands_while_paused(speaker: Node, listener: Node):
    clock = heard(listener, CLOCK, "/clock")
    recording = numbers("/timed", 3, apart_ms=200)
    recording.add_topic("/clock", CLOCK)
    recording.tell("/clock", 1)
    options = PlayOptions(clock_hz=200, starts_paused=True)
    with player_of(speaker, recording, options) as player:
        assert player.topics == ["/timed"]  # two clocks would contradict each other
        player.play()
        wait_until("it stands", lambda: len(clock) > 5)
        assert {ns(one) for one in clock} == {BEGIN_NS}
        player.resume()
        assert player.wait(60)
        wait_until("it does not pass the end", lambda: ns(clock[-1]) == recording.end_ns)
    times = [ns(one) for one in clock]
    assert times == sorted(times)
    assert len(set(times)) > 5


def test_the_time_is_told_before_each_message_and_goes_back_with_a_seek(
    speaker: Node, endpoint: str
):
    with node_at(endpoint) as listener:
        clock = heard(listener, CLOCK, "/clock")
        wait_until("it listens", lambda: bool(speaker.count_subscribers("/clock")))
        recording = numbers("/a")
        recording.add_topic("/b")
        recording.tell("/b", 15, data="b")
        options = replace(HELD, clock_topics=("a",))
        with player_of(speaker, recording, options) as player:
            player.play()
            wait_until("it plays", lambda: player.burst() == 6)
            player.seek(BEGIN_NS + 5 * MS)
            wait_until("all came", lambda: len(clock) == 7)
        assert [(ns(one) - BEGIN_NS) // MS for one in clock] == [0, 0, 10, 20, 30, 40, 5]


def ns(clock: Any) -> int:  # noqa: ANN401
    return clock.clock.sec * 1_000_000_000 + clock.clock.nanosec


def test_two_players_on_one_topic_are_both_heard_and_the_second_is_told(
    speaker: Node, endpoint: str, capsys: pytest.CaptureFixture[str]
):
    with node_at(endpoint, "other_player") as other, node_at(endpoint) as listener:
        with player_of(other, numbers("/shared", 3), HELD) as first:
            wait_until("it publishes", lambda: bool(speaker.count_publishers("/shared")))
            came = hearing(listener, speaker, "/shared")["/shared"]
            with player_of(speaker, numbers("/shared", 2), HELD) as second:
                for player, count in ((first, 3), (second, 2)):
                    player.play()
                    wait_until("it plays", lambda: player.burst() == count)  # noqa: B023
                wait_until("both came", lambda: len(came) == 5)
        assert sorted(told(came)) == list("00112")
    said = capsys.readouterr().err
    assert "/shared is published by /other_player already: who listens hears both." in said


def test_what_cannot_be_published_is_said_and_left_out(
    speaker: Node, capsys: pytest.CaptureFixture[str]
):
    recording = numbers("/fine")
    recording.add_topic("/foreign", "their_msgs/msg/Thing", type_hash="")
    recording.add_topic("/protobuf", trouble="It is written as protobuf.")
    with player_of(speaker, recording) as player:
        assert player.topics == ["/fine"]
    said = capsys.readouterr().err
    assert "Ignoring a topic '/foreign', reason: " in said
    assert "Ignoring a topic '/protobuf', reason: " in said
    assert "It is written as protobuf." in said


def test_a_recording_that_cannot_be_read_further_is_played_up_to_there(speaker: Node):
    recording = numbers("/torn")
    recording.fails_at_ns, recording.failure = BEGIN_NS + 25 * MS, RecordingError("It is torn.")
    with player_of(speaker, recording) as player:
        player.play()
        assert player.wait(60)
        assert player.sent == 3
        assert player.failure is recording.failure


def test_a_topic_of_a_foreign_type_is_played_by_the_hash_that_was_recorded(speaker: Node):
    recording = ToldRecording()
    strange = f"RIHS01_{'ab' * 32}"
    recording.add_topic("/strange", "their_msgs/msg/Thing", type_hash=strange)
    recording.tell_bytes("/strange", 0, b"\0\1\0\0abcd")
    with player_of(speaker, recording):
        found = speaker.graph.publishers("/strange")[0]
        assert (found.type_name, found.type_hash) == ("their_msgs/msg/Thing", strange)


def test_playing_may_begin_again_elsewhere(speaker: Node):
    with player_of(speaker, numbers("/again", 9)) as player:
        player.play()
        assert player.wait(60)
        assert player.play(start_offset_ns=60 * MS)
        assert player.wait(60)
        assert player.sent == 9 + 3


def test_only_the_chosen_topics_are_played(speaker: Node):
    recording = ToldRecording()
    for name in ("/cam/left", "/cam/right", "/scan"):
        recording.add_topic(name)
    choice = Choice(regex="/cam/.*", exclude_topics=("/cam/right",))
    with player_of(speaker, recording, PlayOptions(choice)) as player:
        assert player.topics == ["/cam/left"]
