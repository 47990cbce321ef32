from __future__ import annotations

from contextlib import ExitStack
from typing import TYPE_CHECKING, Any

import pytest

from studio.nodes.bag_player.options import PlayOptions
from studio.nodes.bag_player.player import BagPlayer
from studio.nodes.bag_player.services import NODE_NAME, serve_player
from tests.support.demos import call, node_at
from tests.support.told_recording import BEGIN_NS, MS, ToldRecording
from tests.support.wire import wait_until

if TYPE_CHECKING:
    from collections.abc import Generator

    from studio.ros.client import Node

pytestmark = pytest.mark.network


@pytest.fixture
def asker(endpoint: str) -> Generator[Node]:
    with node_at(endpoint) as node:
        yield node


@pytest.fixture
def player(endpoint: str) -> Generator[BagPlayer]:
    recording = ToldRecording()
    recording.add_topic("/number")
    for at in range(10):
        recording.tell("/number", at * 10, data=str(at))
    with ExitStack() as stack:
        node = stack.enter_context(node_at(endpoint, NODE_NAME))
        made = BagPlayer(node, recording, PlayOptions(starts_paused=True))
        stack.callback(made.close)
        serve_player(node, made)
        yield made


def ask(asker: Node, name: str, kind: str, /, **fields: Any) -> Any:  # noqa: ANN401
    return call(asker, f"rosbag2_interfaces/srv/{kind}", f"/{NODE_NAME}/{name}", **fields)


def test_a_player_is_steered_by_the_services_of_rosbag2(asker: Node, player: BagPlayer):
    assert not ask(asker, "seek", "Seek").success  # it does not play
    assert ask(asker, "play", "Play").success
    assert not ask(asker, "play", "Play").success  # it plays already
    assert ask(asker, "is_paused", "IsPaused").paused
    wait_until("it has read", lambda: ask(asker, "play_next", "PlayNext").success)
    assert ask(asker, "burst", "Burst", num_messages=3).actually_burst == 3
    assert player.sent == 4
    assert ask(asker, "seek", "Seek", time=time_of(asker, BEGIN_NS + 80 * MS)).success
    assert player.now_ns() == BEGIN_NS + 80 * MS
    assert ask(asker, "burst", "Burst").actually_burst == 2
    assert not ask(asker, "set_rate", "SetRate", rate=-1.0).success
    assert ask(asker, "set_rate", "SetRate", rate=2.5).success
    assert ask(asker, "get_rate", "GetRate").rate == 2.5
    ask(asker, "seek", "Seek", time=time_of(asker, BEGIN_NS))
    ask(asker, "resume", "Resume")
    assert not ask(asker, "is_paused", "IsPaused").paused
    ask(asker, "pause", "Pause")
    assert player.is_paused
    ask(asker, "toggle_paused", "TogglePaused")
    assert not player.is_paused
    assert player.wait(60)


def test_stop_ends_a_player_and_play_begins_it_elsewhere(asker: Node, player: BagPlayer):
    ask(asker, "play", "Play")
    ask(asker, "stop", "Stop")
    assert not player.is_playing
    ask(asker, "resume", "Resume")
    offset, until = time_of(asker, 30 * MS), time_of(asker, BEGIN_NS + 50 * MS)
    assert ask(asker, "play", "Play", start_offset=offset, playback_until_timestamp=until).success
    assert player.wait(60)
    assert player.sent == 3


def time_of(asker: Node, at_ns: int) -> Any:  # noqa: ANN401
    sec, nanosec = divmod(at_ns, 1_000_000_000)
    return asker.wire.types.message("builtin_interfaces/msg/Time")(sec=sec, nanosec=nanosec)
