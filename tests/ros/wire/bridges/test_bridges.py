"""Bridges to DDS in a session's sight, where sessions of Zenoh stand for them."""

from __future__ import annotations

from contextlib import ExitStack
from typing import TYPE_CHECKING, NamedTuple

import pytest

from studio.ros.cdr import codec_of
from studio.ros.messages import message, service
from studio.ros.node.raw_subscription import RawSubscription
from studio.ros.profiles import NO_HASH
from studio.ros.qos import QoSProfile
from studio.ros.tokens import EndpointKind, gid_of
from studio.ros.wire.bridges import bridges
from studio.ros.wire.bridges.bridges import BRIDGES_MAX
from studio.ros.wire.bridges.dialect import BRIDGES
from studio.ros.wire.zenoh import declare_token, live_tokens
from tests.support.demos import node_at
from tests.support.pretend_bridge import CONFIG, PARTICIPANT, PretendBridge, talking_bridge
from tests.support.wire import running_router, wait_until

if TYPE_CHECKING:
    from collections.abc import Generator

    from studio.ros.node.node import Node
    from studio.ros.node.samples import RawSample
    from studio.ros.types.classes import MessageValue

pytestmark = pytest.mark.network
STRING = "std_msgs/msg/String"
OTHER_ROBOT = "0110ffffffffffffffffffff000001c1"
OTHER_HASH = "RIHS01_" + "0" * 64
CHATTER = "MP/chatter/std_msgs§msg§String/:1::0,10"


class Met(NamedTuple):
    """A router, and a node of ours there."""

    endpoint: str
    node: Node


@pytest.fixture
def met() -> Generator[Met]:
    with ExitStack() as stack:
        endpoint = stack.enter_context(running_router())
        node = stack.enter_context(node_at(endpoint, "studio_node"))
        yield Met(endpoint, node)


def text(data: str) -> bytes:
    return bytes(codec_of(message(STRING)).encode(message(STRING)(data=data)))


def hear(node: Node, topic: str = "/chatter") -> list[str]:
    heard: list[str] = []

    def take(one: MessageValue) -> None:
        heard.append(one.data)

    node.create_subscription(message(STRING), topic, take, 100)
    return heard


def wait_for_route(node: Node, bridge: PretendBridge, heard: list[str]) -> None:
    """Send until it is heard."""

    def is_heard() -> bool:
        bridge.send("chatter", text("?"))
        return "?" in heard

    wait_until("the bridge is heard", is_heard)
    bridge.send("chatter", text("begin"))
    wait_until("all before came", lambda: "begin" in heard)
    heard.clear()
    assert node.graph.publishers("/chatter")


def test_a_graph_that_is_settled_has_what_is_behind_bridges(met: Met):
    with talking_bridge(met.endpoint) as bridge:
        zenoh = met.node.wire.zenoh
        wait_until("the router has it", lambda: bool(list(live_tokens(zenoh, BRIDGES, 5.0))))
        assert met.node.graph.settle(30)
        (publisher,) = met.node.graph.publishers("/chatter")
        assert publisher.node.path == "/talker"
        assert publisher.node.zid == bridge.zid
        assert publisher.node.bridge == f"bridge {bridge.zid[:6]}"
        (seen,) = met.node.graph.bridges
        assert (seen.version, seen.is_used, seen.withheld) == ("1.10.0", True, ())


def test_where_a_bridge_tells_nothing_its_topics_are_its_own(met: Met):
    with PretendBridge(met.endpoint) as bridge:
        bridge.told.clear()
        bridge.announce(CHATTER).show()
        wait_until("it is seen", lambda: bool(met.node.graph.publishers("/chatter")))
        (publisher,) = met.node.graph.publishers("/chatter")
        assert publisher.node.path == "/zenoh_bridge_ros2dds"
        (seen,) = met.node.graph.bridges
        assert seen.settings is None
        assert seen.is_used


def test_who_announces_ends_and_shows_no_bridge_is_none(met: Met):
    with PretendBridge(met.endpoint) as other:
        other.announce(CHATTER)
        with talking_bridge(met.endpoint):
            wait_until("the bridge is seen", lambda: bool(met.node.graph.bridges))
            assert len(met.node.graph.bridges) == 1
            assert len(met.node.graph.publishers("/chatter")) == 1
            assert met.node.graph.announcing == {other.zid, met.node.wire.zid}
        other.retire(CHATTER)
        own = frozenset({met.node.wire.zid})
        wait_until("it announces no more", lambda: met.node.graph.announcing == own)


def test_without_a_bridge_nothing_is_declared_for_one(met: Met):
    met.node.create_publisher(message(STRING), "/ours", 10)
    with PretendBridge(met.endpoint) as watcher:
        assert not list(live_tokens(watcher.session, "@/*/@ros2_lv/**", 5.0))
        watcher.show()

        def announced() -> set[str]:
            tokens = live_tokens(watcher.session, f"@/{met.node.wire.zid}/@ros2_lv/**", 5.0)
            return {token.split("/")[4] for token in tokens}

        wait_until("ours is announced", lambda: "ours" in announced())
        assert met.node.wire.zid not in {
            token.split("/")[1] for token in live_tokens(watcher.session, "@/*/@ros2_lv", 5.0)
        }
        watcher.retire("")
        wait_until("nothing is announced", lambda: not announced())


def test_an_end_that_is_made_and_ended_beside_a_bridge_is_announced_so_long(met: Met):
    with talking_bridge(met.endpoint) as bridge:
        wait_until("it is used", lambda: met.node.wire.bridges.is_used)
        publisher = met.node.create_publisher(message(STRING), "/ours", 10)
        key = f"@/{met.node.wire.zid}/@ros2_lv/MP/ours/**"
        wait_until("it is announced", lambda: bool(list(live_tokens(bridge.session, key, 5.0))))
        met.node.destroy_publisher(publisher)
        wait_until("it is withdrawn", lambda: not list(live_tokens(bridge.session, key, 5.0)))


def test_a_sample_that_two_bridges_of_one_domain_bring_counts_once(met: Met):
    with talking_bridge(met.endpoint) as first, talking_bridge(met.endpoint) as second:
        heard = hear(met.node)
        wait_until("the second is told", lambda: any(one.twin for one in met.node.graph.bridges))
        assert len(met.node.graph.publishers("/chatter")) == 1
        taken = next(one for one in met.node.graph.bridges if not one.twin)
        bridge, other = (first, second) if taken.zid == first.zid else (second, first)
        wait_for_route(met.node, bridge, heard)
        for number in range(20):
            other.send("chatter", text(str(number)))
            bridge.send("chatter", text(str(number)))
        wait_until("all came", lambda: "19" in heard)
        assert heard == [str(number) for number in range(20)]
        bridge.close()

        def is_heard() -> bool:
            other.send("chatter", text("left"))
            return "left" in heard

        wait_until("the one that is left is heard", is_heard)


def test_two_robots_with_one_topic_are_both_heard(met: Met):
    with talking_bridge(met.endpoint) as first, PretendBridge(met.endpoint) as second:
        second.node("/other", OTHER_ROBOT, publishers=[("/chatter", STRING)])
        second.announce(CHATTER).show()
        heard = hear(met.node)
        wait_until("both publish", lambda: len(met.node.graph.publishers("/chatter")) == 2)
        wait_for_route(met.node, first, heard)
        first.send("chatter", text("one"))
        second.send("chatter", text("two"))
        wait_until("both came", lambda: sorted(heard) == ["one", "two"])
        assert not any(one.twin for one in met.node.graph.bridges)


def test_tokens_that_are_none_are_counted_and_the_rest_goes_on(met: Met):
    with talking_bridge(met.endpoint) as bridge:
        bridge.announce("MP/§§wrong/std_msgs§msg§String/:::")
        bridge.announce("MP/fine/std_msgs§msg§String/:::")
        wait_until("the good one is seen", lambda: bool(met.node.graph.publishers("/fine")))
        wait_until("the other is counted", lambda: met.node.graph.malformed[0] > 0)
        assert "wrong" in str(met.node.graph.malformed[1])


def test_a_node_that_joins_a_topic_that_others_have_is_found(
    met: Met, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(bridges, "_ASK_EVERY_S", 0.2)  # no token tells of it
    with talking_bridge(met.endpoint) as bridge:
        wait_until("the first is seen", lambda: bool(met.node.graph.publishers("/chatter")))
        bridge.node("/late", publishers=[("/chatter", STRING)])
        wait_until("both are seen", lambda: len(met.node.graph.publishers("/chatter")) == 2)


def test_samples_of_a_type_told_in_another_form_are_not_misread(met: Met):
    with PretendBridge(met.endpoint) as bridge:
        bridge.node("/talker", publishers=[("/chatter", STRING)])
        bridge.announce(f"{CHATTER}:typehash={OTHER_HASH};").show()
        heard = hear(met.node)
        raw: list[RawSample] = []
        RawSubscription(
            met.node, "/chatter", STRING, OTHER_HASH, QoSProfile(depth=10),
            lambda samples, _count, _size: raw.extend(samples),
        )  # fmt: skip

        def is_taken() -> bool:
            bridge.send("chatter", text("other"))
            return bool(raw)

        wait_until("who asks for that form has it", is_taken)
        assert heard == []


def test_a_topic_of_a_type_that_nobody_tells_is_received_as_bytes(met: Met):
    with PretendBridge(met.endpoint) as bridge:
        bridge.node("/maker", publishers=[("/odd", "unheard_of/msg/Thing")])
        bridge.announce("MP/odd/unheard_of§msg§Thing/:1::0,10").show()
        wait_until("it is seen", lambda: bool(met.node.graph.publishers("/odd")))
        (publisher,) = met.node.graph.publishers("/odd")
        assert publisher.type_hash == ""
        raw: list[RawSample] = []
        RawSubscription(
            met.node, "/odd", publisher.type_name, publisher.type_hash, QoSProfile(depth=10),
            lambda samples, _count, _size: raw.extend(samples),
        )  # fmt: skip

        def is_taken() -> bool:
            bridge.send("odd", b"\0\1\0\0odd")
            return bool(raw)

        wait_until("its bytes came", is_taken)
        assert raw[0].payload == b"\0\1\0\0odd"
        assert raw[0].attachment.gid == gid_of(publisher.token)
        (own,) = met.node.graph.subscriptions("/odd")
        assert own.type_hash == NO_HASH


def test_of_a_service_that_answers_twice_the_first_answer_counts(met: Met):
    add = service("example_interfaces/srv/AddTwoInts")
    answers = [bytes(codec_of(add.Response).encode(add.Response(sum=one))) for one in (3, 4)]
    with PretendBridge(met.endpoint) as bridge:
        bridge.node("/adder", service_servers=[("/add", add.name)])

        def answer_twice(query: object) -> None:
            for one in answers:
                query.reply("add", one)  # type: ignore[attr-defined]

        bridge.serve("add", answer_twice)
        bridge.announce("SS/add/example_interfaces§srv§AddTwoInts").show()
        client = met.node.create_client(add, "/add")
        assert client.wait_for_service(30)
        for _ in range(3):
            assert client.call(add.Request(a=1, b=2), timeout_sec=30).sum == 3


def test_a_session_that_invents_bridges_without_end_is_bounded(met: Met):
    with PretendBridge(met.endpoint) as bridge, talking_bridge(met.endpoint):
        wait_until("the real one is seen", lambda: bool(met.node.graph.publishers("/chatter")))
        kept = [declare_token(bridge.session, f"@/{one:032x}/@ros2_lv") for one in range(1, 200)]
        wait_until("as many as can be are met", lambda: len(met.node.graph.bridges) == BRIDGES_MAX)
        assert met.node.graph.publishers("/chatter")
        for one in kept:
            one.undeclare()


def test_what_a_bridge_passes_on_has_a_node_and_a_gid(met: Met):
    with talking_bridge(met.endpoint):
        wait_until("it is seen", lambda: bool(met.node.graph.publishers("/chatter")))
        graph = met.node.graph
        (publisher,) = graph.publishers("/chatter")
        assert graph.endpoint_of_gid(publisher.gid) == publisher
        assert graph.endpoints_of(publisher.node) == [publisher]
        assert graph.count(EndpointKind.PUBLISHER, "/chatter") == 1
        assert publisher.node in graph.nodes()
        assert PARTICIPANT in publisher.token


def test_nodes_on_fast_dds_are_told_by_their_participant(met: Met):
    with talking_bridge(met.endpoint) as bridge:
        bridge.node("/fast", "010f" + PARTICIPANT[4:], publishers=[("/chatter", STRING)])
        wait_until(
            "it is told",
            lambda: [one.fast_dds_nodes for one in met.node.graph.bridges] == [("/fast",)],
        )


def test_samples_of_a_bridge_of_another_domain_are_not_taken(met: Met):
    with talking_bridge(met.endpoint) as own, talking_bridge(met.endpoint, domain=5) as other:
        heard = hear(met.node)
        wait_until("both are met", lambda: len(met.node.graph.bridges) == 2)
        wait_for_route(met.node, own, heard)
        other.send("chatter", text("from domain 5"))
        own.send("chatter", text("from ours"))
        wait_until("ours is heard", lambda: "from ours" in heard)
        assert heard == ["from ours"]


def test_a_node_named_like_a_bridge_of_another_domain_is_a_node(met: Met):
    with talking_bridge(met.endpoint), PretendBridge(met.endpoint) as other:
        other.told["config"] = {**CONFIG, "domain": 7, "nodename": "talker"}
        other.show()
        wait_until("both are met", lambda: len(met.node.graph.bridges) == 2)
        wait_until("it is a node", lambda: met.node.graph.node("/talker") is not None)


def test_a_token_that_is_none_keeps_nobody_waiting(met: Met):
    key, zenoh = "@/Strange/@ros2_lv", met.node.wire.zenoh
    with PretendBridge(met.endpoint) as strange:
        kept = declare_token(strange.session, key)
        wait_until("the router has it", lambda: bool(list(live_tokens(zenoh, key, 5.0))))
        assert met.node.graph.settle(30)
        kept.undeclare()


def test_a_service_is_called_where_its_type_is_served(met: Met):
    empty, trigger = service("std_srvs/srv/Empty"), service("std_srvs/srv/Trigger")
    answer = bytes(codec_of(empty.Response).encode(empty.Response()))

    def same(_request: MessageValue, response: MessageValue) -> MessageValue:
        return response

    with PretendBridge(met.endpoint) as bridge:
        bridge.node("/driver", service_servers=[("/reset", empty.name)])
        bridge.serve("reset", lambda query: query.reply("reset", answer))
        bridge.announce("SS/reset/std_srvs§srv§Empty").show()
        server = met.node.create_service(trigger, "/reset", same)
        client = met.node.create_client(empty, "/reset")
        assert client.wait_for_service(30)
        client.call(empty.Request(), timeout_sec=30)
        met.node.destroy_service(server)


def test_of_samples_that_come_another_way_as_well_none_counts(met: Met):
    taken: list[tuple[str, int]] = []
    decode = codec_of(message(STRING)).decode

    def take(samples: list[RawSample], count: int, _size: int) -> None:
        taken.append((decode(samples[-1].payload).data, count))

    with talking_bridge(met.endpoint) as bridge:
        subscription = RawSubscription(
            met.node, "/chatter", STRING, None, QoSProfile(depth=5), take
        )
        subscription.read(newest_only=True)

        def is_heard() -> bool:
            bridge.send("chatter", text("?"))
            return bool(taken)

        wait_until("the bridge is heard", is_heard)
        bridge.send("chatter", text("begin"))
        wait_until("all before came", lambda: taken[-1][0] == "begin")
        taken.clear()
        for number in range(20):
            bridge.send("chatter", text(str(number)))
            bridge.copy("chatter", text("copy"))
        wait_until("the last is heard", lambda: bool(taken) and taken[-1][0] == "19")
        assert sum(count for _, count in taken) == 20
        assert "copy" not in {data for data, _ in taken}
