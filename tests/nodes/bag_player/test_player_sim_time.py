"""Nodes with use_sim_time, TF and displays follow the time of a player that seeks and loops."""

from __future__ import annotations

from contextlib import contextmanager
from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from studio.live.displays.clock_watch import ClockWatch
from studio.nodes.bag_player.options import PlayOptions
from studio.nodes.bag_player.player import BagPlayer
from studio.ros.client import Context, Node
from studio.ros.node.clock import CLOCK_QOS, Time
from studio.ros.node.raw_subscription import RawSubscription
from studio.ros.parameters.parameter import Parameter
from studio.ros.qos import QoSProfile
from studio.tf2.buffer import Buffer
from studio.tf2.listener import TransformListener
from tests.support.demos import node_at, spun
from tests.support.told_recording import BEGIN_NS, MS, ToldRecording
from tests.support.wire import open_test_session, wait_until

if TYPE_CHECKING:
    from collections.abc import Generator

    from studio.ros.node.samples import RawSample

pytestmark = pytest.mark.network
TF = "tf2_msgs/msg/TFMessage"
HELD = PlayOptions(clock_topics=(), starts_paused=True)


@contextmanager
def simulated(endpoint: str) -> Generator[Node]:
    """A node with use_sim_time."""
    with open_test_session(endpoint) as wire:
        context = Context.over(wire)
        given = [Parameter("use_sim_time", value=True)]
        node = Node("simulated", context=context, parameter_overrides=given)
        with spun(context, node):
            yield node


@contextmanager
def playing(endpoint: str, options: PlayOptions = HELD) -> Generator[BagPlayer]:
    """A player of ten transforms, 200 ms apart: frame `b` is at x = 0, 1, 2 ..."""
    recording = ToldRecording()
    recording.add_topic("/tf", TF, QoSProfile(depth=100))
    kind = recording.types.message("geometry_msgs/msg/TransformStamped")
    for at in range(10):
        moved = kind(child_frame_id="b")
        moved.header.frame_id = "a"
        stamp = moved.header.stamp
        stamp.sec, stamp.nanosec = divmod(BEGIN_NS + at * 200 * MS, 1_000_000_000)
        moved.transform.translation.x = float(at)
        recording.tell("/tf", at * 200, transforms=[moved])
    with node_at(endpoint, "rosbag2_player") as node:
        player = BagPlayer(node, recording, options)
        yield player
        player.stop()


def now_ms(node: Node) -> int:
    return (node.get_clock().now().nanoseconds - BEGIN_NS) // MS


def test_a_node_with_use_sim_time_goes_forwards_and_back_with_a_player(endpoint: str):
    with simulated(endpoint) as node, playing(endpoint) as player:
        wait_until("it listens", lambda: bool(node.count_publishers("/clock")))
        player.play()
        wait_until("it plays", lambda: player.burst() == 10)
        wait_until("it follows", lambda: now_ms(node) == 1800)
        player.seek(BEGIN_NS + 300 * MS)
        wait_until("it goes back", lambda: now_ms(node) == 300)


def test_tf_of_later_times_is_forgotten_when_a_player_goes_back_as_tf2_does(endpoint: str):
    with simulated(endpoint) as node, playing(endpoint) as player:
        buffer = Buffer(node=node)
        listener = TransformListener(buffer, node)
        player.play()
        wait_until("it plays", lambda: player.burst() == 10)
        end = Time(nanoseconds=BEGIN_NS + 1800 * MS)
        wait_until("it has come", lambda: buffer.can_transform("a", "b", end))
        player.seek(BEGIN_NS + 300 * MS)
        wait_until("it is forgotten", lambda: not buffer.can_transform("a", "b", end))
        player.play_next()
        wait_until(
            "what is played then counts",
            lambda: buffer.lookup_transform("a", "b", Time()).transform.translation.x == 2,
        )
        listener.unregister()


def test_displays_notice_each_round_of_a_loop(endpoint: str):
    jumps: list[tuple[int, int]] = []
    watch = ClockWatch(lambda now, before: jumps.append((now, before)))

    def take(samples: list[RawSample], _count: int, _size: int) -> None:
        for one in samples:
            watch.take(one)

    options = replace(HELD, starts_paused=False, is_looping=True, rate=20.0)
    with node_at(endpoint) as node:
        RawSubscription(
            node,
            "/clock",
            "rosgraph_msgs/msg/Clock",
            None,
            replace(CLOCK_QOS, depth=100),
            take,
        )
        with playing(endpoint, options) as player:
            player.play()
            wait_until("two rounds", lambda: len(jumps) >= 2)
    assert {(now - BEGIN_NS, before - BEGIN_NS) for now, before in jumps} == {(0, 1800 * MS)}
