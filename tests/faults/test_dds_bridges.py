"""Bridges to DDS that are broken, or none: what they tell and send has bounds, and others go on."""

from __future__ import annotations

import logging
import threading
from contextlib import ExitStack
from typing import TYPE_CHECKING, Any, NamedTuple

import pytest

from studio.ros.messages import message
from studio.ros.wire.bridges import bridges
from studio.ros.wire.bridges.admin import Told, read_answers
from studio.ros.wire.bridges.bridges import BRIDGES_MAX
from studio.ros.wire.zenoh import declare_token, live_tokens
from tests.support.demos import node_at
from tests.support.pretend_bridge import PretendBridge, talking_bridge
from tests.support.wire import running_router, wait_until

if TYPE_CHECKING:
    from collections.abc import Generator

    from studio.ros.node.node import Node
    from studio.ros.wire.bridges.bridge import Bridge

pytestmark = pytest.mark.network
STRING = "std_msgs/msg/String"
OTHER = "0110eeeeeeeeeeeeeeeeeeee000001c1"
FLAP = "MP/flap/std_msgs§msg§String/:1::0,10"


class Met(NamedTuple):
    """A router, and a node of ours there."""

    endpoint: str
    node: Node

    @property
    def bridges(self) -> tuple[Bridge, ...]:
        """Those that the node sees."""
        return self.node.graph.bridges

    def paths(self) -> set[str]:
        """Paths of all nodes that are seen."""
        return {one.path for one in self.node.graph.nodes()}


@pytest.fixture
def met() -> Generator[Met]:
    with ExitStack() as stack:
        endpoint = stack.enter_context(running_router())
        node = stack.enter_context(node_at(endpoint, "studio_node"))
        yield Met(endpoint, node)


def wait_for_path(met: Met, path: str) -> None:
    wait_until(f"{path} is seen", lambda: path in met.paths())


@pytest.fixture
def broken(met: Met) -> Generator[PretendBridge]:
    """A bridge that has been seen, with a node, and that a test breaks then."""
    with PretendBridge(met.endpoint) as bridge:
        bridge.node("/odd", OTHER).show()
        wait_for_path(met, "/odd")
        yield bridge


ODD: list[dict[str, object]] = [
    {"config": {"domain": 0, "namespace": []}},
    {"config": {"domain": 0, "nodename": {}, "deny": [], "pub_max_frequencies": {}}},
    {"config": b"[" * 100_000},
    {"version": "9" * 100_000, "config": b"\xff\xfe"},
    {f"dds/{OTHER}/writer/1/rt/x": {"qos": {"durability": {"kind": []}}}},
    {f"dds/{OTHER}": {"qos": {"properties": {"__Hostname": "\ud800\n\x1b[2J"}}}},
    {f"node/{OTHER}/9": {}, f"node/{OTHER}/x": {"publishers": [None, {"name": []}]}},
]


@pytest.mark.parametrize("told", ODD, ids=range(len(ODD)))
def test_what_a_broken_bridge_tells_keeps_no_other_from_being_read(
    met: Met, broken: PretendBridge, told: dict[str, object], caplog: pytest.LogCaptureFixture
):
    with caplog.at_level(logging.WARNING), talking_bridge(met.endpoint):
        broken.told.update(told)
        broken.announce(FLAP)
        wait_for_path(met, "/talker")
        wait_until("both are there", lambda: len(met.bridges) == 2)
    assert not caplog.records


def test_a_bridge_on_which_the_reader_fails_is_one_line_and_keeps_no_other_from_being_read(
    met: Met,
    broken: PretendBridge,
    monkeypatch: pytest.MonkeyPatch,
    caplog: pytest.LogCaptureFixture,
):
    tried: list[str] = []

    def failing(answers: list[tuple[str, bytes]], zid: str, ends_max: int) -> Told | None:
        tried.append(zid)
        if zid == broken.zid:
            raise ZeroDivisionError
        return read_answers(answers, zid, ends_max)

    monkeypatch.setattr(bridges, "read_answers", failing)
    broken.announce(FLAP)
    wait_until("it fails", lambda: broken.zid in tried)
    with talking_bridge(met.endpoint):
        wait_for_path(met, "/talker")
        broken.retire(FLAP)
        broken.announce(FLAP)
        wait_until("it fails again", lambda: tried.count(broken.zid) > 1)
    assert "/odd" in met.paths()
    assert len([one for one in caplog.records if one.levelno >= logging.WARNING]) == 1


def test_a_bridge_that_answers_and_never_ends_holds_up_nobody_and_keeps_its_nodes(
    met: Met, broken: PretendBridge, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(bridges, "ANSWER_TIMEOUT_S", 1.2)
    held: list[Any] = []
    broken.serve(f"@/{broken.zid}/ros2/version", held.append)
    broken.told = {"version": "v1.10.0"}
    broken.announce(FLAP)
    wait_until("it is asked", lambda: bool(held))
    with talking_bridge(met.endpoint):
        wait_for_path(met, "/talker")
    assert "/odd" in met.paths()
    for query in held:
        query.drop()


def test_a_bridge_that_tells_less_in_a_whole_answer_is_believed(met: Met, broken: PretendBridge):
    broken.told = {"config": broken.told["config"]}
    broken.announce(FLAP)
    wait_until("its node is gone", lambda: "/odd" not in met.paths())
    assert len(met.bridges) == 1


def test_answers_without_end_are_cut(met: Met, broken: PretendBridge):
    rubbish = b"[" + b"1," * (2 << 20) + b"1]"
    ended = threading.Event()

    def flood(query: Any) -> None:  # noqa: ANN401
        for one in range(20):
            query.reply(f"@/{broken.zid}/ros2/x{one}", rubbish)
        ended.set()

    broken.serve(f"@/{broken.zid}/ros2/version", flood)
    broken.announce(FLAP)
    assert ended.wait(30)
    with talking_bridge(met.endpoint):
        wait_for_path(met, "/talker")
    assert "/odd" in met.paths()


def test_a_bridge_beyond_the_most_is_met_when_another_goes(met: Met):
    with PretendBridge(met.endpoint) as liar:
        invented = [
            declare_token(liar.session, f"@/{one:032x}/@ros2_lv")
            for one in range(1, BRIDGES_MAX + 9)
        ]
        wait_until("the most are met", lambda: len(met.bridges) == BRIDGES_MAX)
        with talking_bridge(met.endpoint) as bridge:
            key = f"@/{bridge.zid}/@ros2_lv"
            zenoh = met.node.wire.zenoh
            wait_until("the router has it", lambda: bool(list(live_tokens(zenoh, key, 5.0))))
            assert met.node.graph.settle(30)
            assert len(met.bridges) == BRIDGES_MAX
            assert "/talker" not in met.paths()
            for one in invented:
                one.undeclare()
            wait_for_path(met, "/talker")
            wait_until("the others are gone", lambda: len(met.bridges) == 1)


def test_of_bridges_that_came_and_went_nothing_stays(met: Met):
    with PretendBridge(met.endpoint) as liar, talking_bridge(met.endpoint):
        for one in range(1, 300):
            declare_token(liar.session, f"@/{one:032x}/@ros2_lv").undeclare()
        liar.show()
        wait_until(
            "all others are gone",
            lambda: liar.zid in {one.zid for one in met.bridges} and len(met.bridges) == 2,
        )
        sessions = met.node.wire.bridges._routes.keys()  # pyright: ignore[reportPrivateUsage]
        assert len(sessions) <= 3


def test_a_bridge_that_goes_takes_no_thread_for_each_subscription(met: Met):
    before = threading.active_count()
    for one in range(100):
        met.node.create_subscription(message(STRING), f"/s{one}", lambda _: None, 10)
    seen = met.node.wire.bridges
    with talking_bridge(met.endpoint):
        wait_until("it is used", lambda: seen.is_used)
    wait_until("it is gone", lambda: not seen.is_used)
    assert threading.active_count() < before + 20


def test_a_robot_that_flaps_is_seen_as_it_is_once_it_rests(met: Met):
    with talking_bridge(met.endpoint) as bridge:
        wait_for_path(met, "/talker")
        for _ in range(500):
            bridge.announce(FLAP)
            bridge.retire(FLAP)
            bridge.retire("")
            bridge.announce("")
        wait_until("the rest is there", lambda: bool(met.node.graph.publishers("/chatter")))
        bridge.announce(FLAP)
        wait_until("it is seen", lambda: bool(met.node.graph.publishers("/flap")))
        bridge.retire(FLAP)
        wait_until("it is gone", lambda: not met.node.graph.publishers("/flap"))


def test_where_a_bridge_is_dead_and_still_shown_another_to_the_same_robot_counts(
    met: Met, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(bridges, "ANSWER_TIMEOUT_S", 1.2)
    heard: list[str] = []
    met.node.create_subscription(message(STRING), "/chatter", lambda one: heard.append(one.data), 9)
    held: list[Any] = []
    with talking_bridge(met.endpoint) as first:
        wait_for_path(met, "/talker")
        with talking_bridge(met.endpoint) as second:
            wait_until(
                "they are twins", lambda: [bool(one.twin) for one in met.bridges] == [False, True]
            )
            first.told.clear()
            first.serve(f"@/{first.zid}/ros2/version", held.append)
            first.announce(FLAP)

            def is_heard() -> bool:
                second.send("chatter", b"\0\1\0\0\3\0\0\0ok\0")
                return bool(heard)

            wait_until("the other is heard", is_heard)
            assert [one.zid for one in met.bridges] == [second.zid, first.zid]
            assert "/talker" in met.paths()
    for query in held:
        query.drop()
