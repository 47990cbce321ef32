"""Several bridges, bridges that end, and robots of other distributions and domains."""

from __future__ import annotations

from contextlib import ExitStack, contextmanager
from typing import TYPE_CHECKING

import pytest

from studio.errors import ActionServerGoneError
from studio.ros.action import ActionClient
from studio.ros.messages import action, message, service
from studio.ros.node.node import Node
from studio.ros.qos import DurabilityPolicy, QoSProfile
from tests.support.dds_bridge import DdsNetwork
from tests.support.demos import spun
from tests.support.node_pair import context_at
from tests.support.wire import running_router, wait_until

if TYPE_CHECKING:
    from collections.abc import Generator

    from studio.ros.types.classes import MessageValue
    from tests.support.ros2_peer import RealNode

pytestmark = pytest.mark.network
STRING = "std_msgs/msg/String"
ADD = "example_interfaces/srv/AddTwoInts"
KEPT = DurabilityPolicy.TRANSIENT_LOCAL


@pytest.fixture(scope="module")
def network() -> Generator[DdsNetwork]:
    with DdsNetwork() as made:
        yield made


@contextmanager
def met(distro: str = "jazzy") -> Generator[tuple[str, Node]]:
    """A router, and a node of ours there that works."""
    with ExitStack() as stack:
        endpoint = stack.enter_context(running_router())
        context = stack.enter_context(context_at(endpoint, distro))
        node = Node("studio_node", context=context)
        stack.enter_context(spun(context, node))
        yield endpoint, node


def test_robots_behind_bridges_with_namespaces_are_told_apart(network: DdsNetwork):
    with met() as (endpoint, node), DdsNetwork() as other:
        robots = [network.robot(), other.robot()]
        bridges = [
            one.bridge(connect=endpoint, namespace=f"/robot{number}")
            for number, one in enumerate((network, other), 1)
        ]
        for number, robot in enumerate(robots, 1):
            robot.ask("serve", service="/add", type_name=ADD, behaviour="add")
            robot.ask("publish", topic="/name", type_name=STRING, values={"data": str(number)},
                      qos={"durability": "transient_local", "depth": 1})  # fmt: skip
        graph = node.graph
        wait_until("both are seen", lambda: {"/robot1/robot", "/robot2/robot"} <= paths(node))
        assert {graph.node(f"/robot{one}/robot").bridge for one in (1, 2)} == {  # type: ignore[union-attr]
            "/robot1", "/robot2",
        }  # fmt: skip
        for number in (1, 2):
            topic, qos = f"/robot{number}/name", QoSProfile(depth=1, durability=KEPT)
            wait_until(f"{topic} is published", lambda topic=topic: bool(graph.publishers(topic)))
            assert heard_once(node, topic, qos) == str(number)
            client = node.create_client(service(ADD), f"/robot{number}/add")
            assert client.wait_for_service(10)
            assert (
                client.call(service(ADD).Request(a=number, b=1), timeout_sec=10).sum == number + 1
            )
        end(*robots, *bridges)


def heard_once(node: Node, topic: str, qos: QoSProfile) -> str:
    """Subscribe until the first message."""
    found: list[str] = []

    def hear(one: MessageValue) -> None:
        found.append(one.data)

    subscription = node.create_subscription(message(STRING), topic, hear, qos)
    wait_until(f"{topic} is heard", lambda: bool(found))
    node.destroy_subscription(subscription)
    return found[0]


def paths(node: Node) -> set[str]:
    return {one.path for one in node.graph.nodes()}


def end(*running: RealNode) -> None:
    for one in running:
        one.kill()


def test_two_bridges_in_one_domain_are_told_and_show_their_nodes_once(network: DdsNetwork):
    with met() as (endpoint, node):
        robot = network.robot()
        bridges = [network.bridge(connect=endpoint) for _ in range(2)]
        robot.ask("node", node="/alone")

        def twins() -> list[str]:
            return [one.twin for one in node.graph.bridges if one.twin]

        wait_until("the second is told", lambda: bool(twins()))
        first = next(one for one in node.graph.bridges if not one.twin)
        assert twins() == [first.name]
        assert [one.path for one in node.graph.nodes()].count("/alone") == 1
        by_zid = {one.zid: one for one in bridges}
        by_zid.pop(first.zid).line.cut()
        wait_until("the other one is used", lambda: not twins() and "/alone" in paths(node))
        end(robot, *bridges)


def test_a_bridge_of_another_domain_is_seen_and_not_used(network: DdsNetwork):
    with met() as (endpoint, node):
        robot, bridge = network.robot(domain=3), network.bridge(connect=endpoint, domain=3)
        robot.ask("node", node="/elsewhere")
        wait_until("its nodes are known", lambda: any(one.nodes for one in node.graph.bridges))
        (seen,) = node.graph.bridges
        assert not seen.is_used
        assert seen.settings is not None
        assert seen.settings.domain == 3
        assert "/elsewhere" not in paths(node)
        end(robot, bridge)


def test_a_goal_ends_with_a_sentence_when_its_bridge_dies(network: DdsNetwork):
    fibonacci = action("example_interfaces/action/Fibonacci")
    with met() as (endpoint, node):
        robot, bridge = network.robot(), network.bridge(connect=endpoint)
        robot.ask("serve_fibonacci")
        client = ActionClient(node, fibonacci, "/fibonacci")
        assert client.wait_for_server(10)
        sent = client.send_goal_async(fibonacci.Goal(order=10_000))
        assert sent.wait(10)
        result = sent.result().get_result_async()
        bridge.kill()
        assert result.wait(30)
        with pytest.raises(ActionServerGoneError):
            result.result()
        wait_until("its nodes are gone", lambda: "/robot" not in paths(node))
        end(robot)


def test_a_bridge_that_comes_back_brings_everything_again(network: DdsNetwork):
    heard: list[str] = []

    def hear(one: MessageValue) -> None:
        heard.append(one.data)

    with met() as (endpoint, node):
        robot, bridge = network.robot(), network.bridge(connect=endpoint)
        node.create_subscription(message(STRING), "/words", hear, 10)
        publisher = node.create_publisher(message(STRING), "/orders", 10)
        robot.ask("subscribe", topic="/orders", type_name=STRING)
        robot.ask("publish", topic="/words", type_name=STRING, values={"data": "w"}, rate_hz=20)
        wait_until("it is heard", lambda: bool(heard))
        bridge.kill()
        wait_until("its nodes are gone", lambda: "/robot" not in paths(node))
        heard.clear()
        bridge = network.bridge(connect=endpoint)
        wait_until("it is heard again", lambda: bool(heard))

        def is_ordered() -> bool:
            publisher.publish(message(STRING)(data="again"))
            return bool(robot.all_said("heard", topic="/orders"))

        wait_until("it hears us again", is_ordered)
        end(robot, bridge)


@pytest.mark.parametrize("distro", ["humble", "rolling"])
def test_robots_of_other_distributions_are_met(network: DdsNetwork, distro: str):
    with met("humble" if distro == "humble" else "jazzy") as (endpoint, node):
        robot = network.robot(distro=distro)
        bridge = network.bridge(connect=endpoint, distro=distro)
        robot.ask("subscribe", topic="/orders", type_name=STRING)
        robot.ask("serve", service="/add", type_name=ADD, behaviour="add")
        robot.ask("publish", topic="/words", type_name=STRING, values={"data": "w"}, rate_hz=20)
        wait_until("it is published", lambda: bool(node.graph.publishers("/words")))
        assert heard_once(node, "/words", QoSProfile(depth=10)) == "w"
        (told,) = node.graph.publishers("/words")
        assert bool(told.type_hash) is (distro != "humble")
        client = node.create_client(service(ADD), "/add")
        assert client.wait_for_service(10)
        assert client.call(service(ADD).Request(a=1, b=2), timeout_sec=10).sum == 3
        wait_until("it subscribes", lambda: bool(node.graph.subscriptions("/orders")))
        node.create_publisher(message(STRING), "/orders", 10).publish(message(STRING)(data="o"))
        assert robot.wait_heard("/orders")["data"] == "o"
        end(robot, bridge)


def test_what_a_bridge_does_not_let_through_is_named(network: DdsNetwork):
    with met() as (endpoint, node):
        robot = network.robot()
        allow = {"publishers": ["/words"], "subscribers": [], "service_servers": []}
        bridge = network.bridge(connect=endpoint, config={"allow": allow})
        for topic in ("/words", "/secret"):
            robot.ask("advertise", topic=topic, type_name=STRING)
        wait_until("it is published", lambda: bool(node.graph.publishers("/words")))

        def withheld() -> set[str]:
            return {name for one in node.graph.bridges for _, name in one.withheld}

        wait_until("the other is named", lambda: withheld() == {"/secret"})
        (seen,) = node.graph.bridges
        assert seen.rules is not None
        assert seen.rules.allows
        assert any("/words" in line for line in seen.rules.texts())
        assert not node.graph.publishers("/secret")
        end(robot, bridge)


def test_what_was_kept_before_a_bridge_came_reaches_dds(network: DdsNetwork):
    with met() as (endpoint, node):
        qos = QoSProfile(depth=2, durability=KEPT)
        publisher = node.create_publisher(message(STRING), "/map_name", qos)
        for data in ("lost", "older", "newest"):
            publisher.publish(message(STRING)(data=data))
        robot, bridge = network.robot(), network.bridge(connect=endpoint)
        latched = {"durability": "transient_local", "depth": 5}
        robot.ask("subscribe", topic="/map_name", type_name=STRING, qos=latched)
        robot.wait_heard("/map_name", data="newest")
        heard = [one["message"]["data"] for one in robot.all_said("heard", topic="/map_name")]
        assert heard == ["older", "newest"]
        end(robot, bridge)


@pytest.mark.parametrize("latched_first", [True, False])
def test_a_latched_publisher_reaches_dds_beside_one_that_keeps_nothing(
    network: DdsNetwork, *, latched_first: bool
):
    with met() as (endpoint, node):
        robot, bridge = network.robot(), network.bridge(connect=endpoint)
        wait_until("it is used", lambda: node.wire.bridges.is_used)
        profiles = [QoSProfile(depth=1, durability=KEPT), QoSProfile(depth=10)]
        made = [
            node.create_publisher(message(STRING), "/mix", one)
            for one in (profiles if latched_first else reversed(profiles))
        ]
        made[0 if latched_first else 1].publish(message(STRING)(data="kept"))
        latched = {"durability": "transient_local", "depth": 5}
        robot.ask("subscribe", topic="/mix", type_name=STRING, qos=latched)
        robot.wait_heard("/mix", data="kept")
        end(robot, bridge)


def test_two_bridges_with_lists_share_a_robot(network: DdsNetwork):
    with met() as (endpoint, node):
        robot = network.robot()
        bridges = [
            network.bridge(connect=endpoint, config={"allow": {"publishers": [topic]}})
            for topic in ("/chatter", "/camera")
        ]
        for topic in ("/chatter", "/camera", "/secret"):
            robot.ask("publish", topic=topic, type_name=STRING, values={"data": topic}, rate_hz=20)
        for topic in ("/chatter", "/camera"):
            wait_until(f"{topic} is seen", lambda topic=topic: bool(node.graph.publishers(topic)))
            assert heard_once(node, topic, QoSProfile(depth=10)) == topic
        assert [one.path for one in node.graph.nodes()].count("/robot") == 1
        assert not any(one.twin for one in node.graph.bridges)

        def withheld() -> set[str]:
            return {name for one in node.graph.bridges for _, name in one.withheld}

        wait_until("what neither brings is named", lambda: withheld() == {"/secret"})
        end(robot, *bridges)
