"""Our topics, graph and log beside nodes of a real ROS 2 (rclpy on rmw_zenoh_cpp)."""

from __future__ import annotations

import threading
import time
from contextlib import ExitStack, contextmanager
from itertools import product
from typing import TYPE_CHECKING, Any

import pytest

from studio.ros.cdr import codec_of
from studio.ros.client import Context, Node
from studio.ros.interactive_markers import (
    ClientState,
    InteractiveMarkerClient,
    InteractiveMarkerServer,
)
from studio.ros.interactive_markers.names import FEEDBACK, UPDATE, FeedbackEvent
from studio.ros.messages import message
from studio.ros.node.samples import BLINK_NS
from studio.ros.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from studio.ros.tokens import gid_of
from tests.support.demos import heard, node_at, spun
from tests.support.interactive_markers import feedback_of, moving_marker
from tests.support.ros2_peer import RealNode, RealNodes, real_node, real_nodes
from tests.support.wire import open_test_session, wait_until

if TYPE_CHECKING:
    from collections.abc import Generator

    from studio.ros.node.samples import MessageInfo
    from studio.ros.node.subscription import Subscription

pytestmark = pytest.mark.network
STRING = "std_msgs/msg/String"
KEPT = 3
QOS = [
    " ".join(pair) for pair in product(("reliable", "best_effort"), ("volatile", "transient_local"))
]
PAIRS = list(product(QOS, QOS))
LARGE = "std_msgs/msg/UInt8MultiArray"
LARGE_BYTES = 5_000_000


@pytest.fixture(scope="module")
def leaving(endpoint: str) -> Generator[tuple[RealNode, RealNode]]:
    """Two nodes that are there to end; they start while others do."""
    with ExitStack() as stack:
        first, second = (
            stack.enter_context(real_node(endpoint, "sub", "--name", name, "--topic", f"/{name}"))
            for name in ("leaves", "is_killed")
        )
        yield first, second


@pytest.fixture(scope="module")
def real(endpoint: str, leaving: object) -> Generator[RealNodes]:
    with real_nodes(endpoint) as nodes:
        yield nodes


@pytest.fixture(scope="module")
def node(endpoint: str) -> Generator[Node]:
    with node_at(endpoint, "ours") as found:
        yield found


@pytest.fixture(scope="module")
def witness(endpoint: str) -> Generator[Node]:
    """A third node: what it has heard is in no queue any more, nor on its way to the router."""
    with node_at(endpoint, "witness") as found:
        yield found


def profile(text: str) -> QoSProfile:
    reliability, durability = text.upper().split()
    return QoSProfile(
        depth=KEPT,
        reliability=ReliabilityPolicy[reliability],
        durability=DurabilityPolicy[durability],
    )


def topic_of(prefix: str, qos: str) -> str:
    return f"/{prefix}_{qos.replace(' ', '_')}"


def expected(offered: str, asked: str, early: bool) -> list[str]:
    """What comes: late subscriptions get what is kept, where both sides keep."""
    keeps = "transient" in offered and "transient" in asked
    return ["2", "3", "4", "new"] if early or keeps else ["new"]


@pytest.mark.parametrize("early", [True, False], ids=["early", "late"])
def test_real_publishers_are_heard_in_every_pair_of_qos(
    real: RealNodes, node: Node, witness: Node, early: bool
):
    def listen() -> dict[tuple[str, str], list[str]]:
        return {pair: texts(node, topic_of(prefix, pair[0]), pair[1]) for pair in PAIRS}

    def publish(data: list[str], readers: int) -> None:
        for qos, text in product(QOS, data):
            topic = topic_of(prefix, qos)
            real.ask("publish", topic=topic, qos=qos, data=[text], readers=readers)
            wait_for_last(went_out[qos], text)

    prefix = "real_early" if early else "real_late"
    went_out = {qos: texts(witness, topic_of(prefix, qos), QOS[0]) for qos in QOS}
    came = listen() if early else {}
    if not early:  # of these nothing is kept
        publish(["0", "1"], 1)
    publish(["2", "3", "4"], 5 if early else 1)
    came = came or listen()
    wait_for_all(came, early=early, newest=False)
    publish(["new"], 5)
    wait_for_all(came, early=early, newest=True)


@pytest.mark.parametrize("early", [True, False], ids=["early", "late"])
def test_real_subscriptions_hear_us_in_every_pair_of_qos(
    real: RealNodes, node: Node, witness: Node, early: bool
):
    def listen() -> None:
        for offered, asked in PAIRS:
            real.ask("subscribe", topic=topic_of(prefix, offered), qos=asked)

    def publish(data: list[str], readers: int) -> None:
        wait_until(
            "all are known",
            lambda: all(one.get_subscription_count() >= readers for one in publishers.values()),
        )
        for (qos, publisher), text in product(publishers.items(), data):
            publisher.publish(message(STRING)(data=text))
            wait_for_last(went_out[qos], text)

    def come() -> dict[tuple[str, str], list[str]]:
        return {
            pair: [
                said["data"]
                for said in real.all_said("message", topic=topic_of(prefix, pair[0]), qos=pair[1])
            ]
            for pair in PAIRS
        }

    prefix = "our_early" if early else "our_late"
    went_out = {qos: texts(witness, topic_of(prefix, qos), QOS[0]) for qos in QOS}
    if early:
        listen()
    publishers = {
        qos: node.create_publisher(message(STRING), topic_of(prefix, qos), profile(qos))
        for qos in QOS
    }
    if not early:  # of these nothing is kept
        publish(["0", "1"], 1)
    publish(["2", "3", "4"], 5 if early else 1)
    if not early:
        listen()
    wait_until("the first come", lambda: come() == all_expected(early=early, newest=False))
    publish(["new"], 5)
    wait_until("the new ones come", lambda: come() == all_expected(early=early, newest=True))


def all_expected(*, early: bool, newest: bool) -> dict[tuple[str, str], list[str]]:
    return {pair: expected(*pair, early)[: None if newest else -1] for pair in PAIRS}


def wait_for_last(came: list[str], text: str) -> None:
    wait_until(f"{text} comes last", lambda: came[-1:] == [text])


def wait_for_all(came: dict[tuple[str, str], list[str]], *, early: bool, newest: bool) -> None:
    wait_until("all come", lambda: came == all_expected(early=early, newest=newest))


def test_large_messages_come_whole_from_there(real: RealNodes, node: Node):
    came = heard(node, LARGE, "/large_from_there", 3)
    real.ask("publish_large", topic="/large_from_there", size=LARGE_BYTES)
    wait_until("it comes", lambda: bool(came))
    real.ask("end_large")
    assert (len(came[0].data), came[0].data[0], came[0].data[-1]) == (LARGE_BYTES, 7, 9)


def test_large_messages_come_whole_there(real: RealNodes, node: Node):
    kind = message(LARGE)
    real.ask("subscribe_large", topic="/large_from_us")
    publisher = node.create_publisher(kind, "/large_from_us", 3)
    wait_until("it is known", lambda: publisher.get_subscription_count() == 1)
    publisher.publish(kind(data=bytes([3]) + bytes(LARGE_BYTES - 2) + bytes([5])))
    said = real.wait_said("large", topic="/large_from_us")
    assert (said["size"], said["ends"]) == (LARGE_BYTES, [3, 5])


def test_a_publisher_that_keeps_all_loses_nothing_on_the_way_there(real: RealNodes, node: Node):
    all_kept = QoSProfile(history=HistoryPolicy.KEEP_ALL)
    real.ask("subscribe", topic="/all_kept", qos=QOS[0])
    real.ask("subscribe_large", topic="/all_kept_large")
    burst = node.create_publisher(message(STRING), "/all_kept", all_kept)
    large = node.create_publisher(message(LARGE), "/all_kept_large", all_kept)
    publishers = burst, large
    wait_until("both are known", lambda: all(p.get_subscription_count() == 1 for p in publishers))
    large.publish(message(LARGE)(data=bytes([3]) + bytes(LARGE_BYTES - 2) + bytes([5])))
    for text in ("1", "2", "3"):
        burst.publish(message(STRING)(data=text))
    said = real.wait_said("large", topic="/all_kept_large")
    assert (said["size"], said["ends"]) == (LARGE_BYTES, [3, 5])
    real.wait_said("message", topic="/all_kept", data="3")
    assert [one["data"] for one in real.all_said("message", topic="/all_kept")] == ["1", "2", "3"]


def missed(subscription: Subscription) -> int:
    """How many messages a subscription counts as missed so far."""
    return subscription.losses.lost + subscription.losses.overwritten


def test_what_a_slow_callback_misses_of_a_real_publisher_is_counted(
    real: RealNodes, node: Node, endpoint: str
):
    """Its numbers say how many there were: what is heard and what is missed are all of them."""
    count = 500
    waits, begun = threading.Event(), threading.Event()
    numbers: list[int] = []
    all_of_them = heard(node, STRING, "/many", count + 2)

    def hear(_: object, info: MessageInfo) -> None:
        numbers.append(info["publication_sequence_number"])
        begun.set()
        waits.wait()

    with node_at(endpoint, "slow") as slow:
        subscription = slow.create_subscription(message(STRING), "/many", hear, profile(QOS[0]))
        try:
            real.ask("publish", topic="/many", qos=QOS[0], data=["first"], readers=2)
            assert begun.wait(60)
            real.ask("publish", topic="/many", qos=QOS[0], data=["more"] * count)
            wait_until("another hears them all", lambda: len(all_of_them) == count + 1)
            waiting = subscription._inbox.samples  # pyright: ignore[reportPrivateUsage]
            wait_until("all came", lambda: missed(subscription) + len(waiting) == count)
            # The newest 20 ms are kept beyond the depth: what comes after them pushes them out.
            newest_ns = waiting[-1].received_ns
            wait_until("they are old", lambda: time.time_ns() > newest_ns + BLINK_NS)
            real.ask("publish", topic="/many", qos=QOS[0], data=["last"])
            wait_until("the last came", lambda: missed(subscription) == count + 1 - KEPT)
        finally:
            waits.set()
        wait_until("the last is heard", lambda: numbers[-1] == count + 2)
        assert numbers == [1, *range(count + 3 - KEPT, count + 3)]
        assert missed(subscription) == count + 1 - KEPT


def test_the_log_goes_both_ways(real: RealNodes, node: Node):
    logs = heard(node, "rcl_interfaces/msg/Log", "/rosout", 1000)
    real.ask("hear_log")
    wait_until("it is known", lambda: bool(node.graph.publishers("/rosout")))
    node.get_logger().error("said by us")
    said = real.wait_said("log", text="said by us")
    assert (said["name"], said["level"]) == ("ours", 40)

    def is_there() -> bool:
        real.ask("log", text="said by a real node")
        return any(one.msg == "said by a real node" for one in logs)

    wait_until("its log comes", is_there)
    [log, *_] = [one for one in logs if one.msg == "said by a real node"]
    assert (log.name, log.level) == ("real", 30)
    assert log.file.endswith("ros2_script.py")


def test_each_sees_the_ends_of_the_other_with_qos_hash_and_gid(real: RealNodes, node: Node):
    graph = node.graph
    qos = "best_effort transient_local"
    publisher = node.create_publisher(message(STRING), "/seen_there", profile(qos))
    token = publisher.endpoint.token
    expected_end = {
        "node": "ours",
        "type": STRING,
        "hash": token.type_hash,
        "reliability": "BEST_EFFORT",
        "durability": "TRANSIENT_LOCAL",
        "depth": KEPT,
        "gid": gid_of(str(token)).hex(),
    }
    wait_until("it is seen", lambda: real.ask("ends", topic="/seen_there") == [expected_end])
    real.ask("publish", topic="/seen_here", qos=qos, data=[])
    assert graph.wait_for(lambda: bool(graph.publishers("/seen_here")), 60)
    [theirs] = graph.publishers("/seen_here")
    assert (theirs.node.path, theirs.type_name) == ("/real", STRING)
    assert (theirs.type_hash, theirs.qos) == (token.type_hash, profile(qos))
    [end] = real.ask("ends", topic="/seen_here")
    found = graph.endpoint_of_gid(bytes.fromhex(end["gid"]))
    assert found is not None
    assert found.name == "/seen_here"


def test_real_ros_receives_what_is_done_to_interactive_markers(real: RealNodes, node: Node):
    """Its rclpy has no visualization_msgs here: it receives the bytes, which are decoded here."""
    types = node.wire.types
    for topic, kind in (("/arm/update", UPDATE), ("/arm/feedback", FEEDBACK)):
        real.ask("hear_raw", topic=topic, type_name=kind, type_hash=types.hash_of(kind))
    told: list[Any] = []
    with InteractiveMarkerServer(node, "/arm") as server:
        wait_until("it is seen", lambda: len(real.ask("ends", topic="/arm/update")) == 1)
        for name in ("elbow", "wrist"):
            server.insert(moving_marker(types, name), feedback_callback=told.append)
        server.apply_changes()
        client = InteractiveMarkerClient(node)
        client.connect("/arm")

        def is_running() -> bool:
            client.update()
            return client.state is ClientState.RUNNING

        wait_until("the client has the marker", is_running)
        client.publish_feedback(feedback_of(types, "elbow", FeedbackEvent.POSE_UPDATE, (1, 2, 3)))
        update, feedback = (
            codec_of(types.message(kind)).decode(
                bytes.fromhex(real.wait_said("raw", topic=topic)["payload"])
            )
            for topic, kind in (("/arm/update", UPDATE), ("/arm/feedback", FEEDBACK))
        )
        client.disconnect()
        wait_until("the server has it, too", lambda: len(told) == 1)
        theirs = feedback_of(types, "wrist", FeedbackEvent.BUTTON_CLICK)
        real.ask(
            "publish_raw",
            topic="/arm/feedback",
            type_name=FEEDBACK,
            type_hash=types.hash_of(FEEDBACK),
            payload=codec_of(types.message(FEEDBACK)).encode(theirs).hex(),
        )
        wait_until("the server has theirs", lambda: len(told) == 2)
    assert told[1].event_type == FeedbackEvent.BUTTON_CLICK
    assert [one.name for one in update.markers] == ["elbow", "wrist"]
    assert (feedback.marker_name, feedback.event_type) == ("elbow", 1)
    assert feedback.pose.position.z == 3


def test_real_ros_sees_a_server_of_interactive_markers_as_its_own_are(real: RealNodes, node: Node):
    with InteractiveMarkerServer(node, "/handles"):
        wait_until("it is seen", lambda: len(real.ask("ends", topic="/handles/update")) == 1)
        graph = real.ask("graph")
        topics, served = graph["topics"], graph["services"]["/handles/get_interactive_markers"]
        assert served == ["visualization_msgs/srv/GetInteractiveMarkers"]
        assert topics["/handles/update"] == ["visualization_msgs/msg/InteractiveMarkerUpdate"]
        assert topics["/handles/feedback"] == ["visualization_msgs/msg/InteractiveMarkerFeedback"]
        [end] = real.ask("ends", topic="/handles/update")
        assert (end["depth"], end["reliability"]) == (100, "RELIABLE")
    wait_until("it is gone", lambda: not real.ask("ends", topic="/handles/update"))


def test_nodes_in_namespaces_and_enclaves_are_seen(real: RealNodes, node: Node, endpoint: str):
    real.ask("node_in", name="inner", namespace="/lab/arm")
    real.ask("node_in", name="guarded", enclave="/lab/locked")
    wait_until("both are seen", lambda: {"/lab/arm/inner", "/guarded"} <= paths(node))
    guarded = node.graph.node("/guarded")
    assert guarded is not None
    assert guarded.enclave == "/lab/locked"
    with open_test_session(endpoint) as wire:
        context = Context.over(wire)
        ours = Node("deep", namespace="/lab/leg", context=context)
        with spun(context, ours):
            wait_until(
                "ours is seen there",
                lambda: ["/lab/leg/deep", "/"] in real.ask("graph")["nodes"],
            )


def test_domains_are_apart(real: RealNodes, node: Node, endpoint: str):
    with node_in_domain(endpoint, 7) as seventh:
        real.ask("node_in", name="in_seventh", domain=7)
        wait_until("it is seen in its domain", lambda: "/in_seventh" in paths(seventh))
        real.ask("node_in", name="after_seventh")
        wait_until("the next is seen in ours", lambda: "/after_seventh" in paths(node))
        assert "/in_seventh" not in paths(node)
        assert "/real" not in paths(seventh)


def test_a_real_node_that_ends_or_is_killed_leaves_the_graph(
    node: Node, leaving: tuple[RealNode, RealNode]
):
    first, second = leaving
    for process in leaving:
        process.wait_said("ready")
    wait_until("both are there", lambda: {"/leaves", "/is_killed"} <= paths(node))
    second.kill()
    wait_until("the killed one is gone", lambda: "/is_killed" not in paths(node))
    assert not node.graph.subscriptions("/is_killed")
    assert "/leaves" in paths(node)
    first.process.terminate()
    wait_until("the other is gone", lambda: "/leaves" not in paths(node))
    assert not node.graph.subscriptions("/leaves")
    first.kill()


def test_a_node_of_ours_that_ends_leaves_the_graph_there(real: RealNodes, endpoint: str):
    def is_seen() -> bool:
        return ["/passing", "/"] in real.ask("graph")["nodes"]

    with node_at(endpoint, "passing"):
        wait_until("it is seen", is_seen)
    wait_until("it is gone", lambda: not is_seen())


def paths(node: Node) -> set[str]:
    return {one.path for one in node.graph.nodes()}


@contextmanager
def node_in_domain(endpoint: str, domain: int) -> Generator[Node]:
    with open_test_session(endpoint, domain) as wire:
        context = Context.over(wire)
        node = Node("in_domain", context=context)
        with spun(context, node):
            yield node


def texts(node: Node, topic: str, qos: str) -> list[str]:
    came: list[str] = []

    def hear(said: Any) -> None:  # noqa: ANN401
        came.append(said.data)

    node.create_subscription(message(STRING), topic, hear, profile(qos))
    return came
