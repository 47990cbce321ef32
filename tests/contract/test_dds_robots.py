"""Our nodes beside robots on DDS, through the real zenoh-bridge-ros2dds."""

from __future__ import annotations

from contextlib import ExitStack
from typing import TYPE_CHECKING, NamedTuple

import pytest

from studio.ros.action import ActionClient, ActionServer, GoalStatus
from studio.ros.lifecycle.client import LifecycleClient
from studio.ros.messages import action, message, service
from studio.ros.node.node import Node
from studio.ros.node.topic_statistics import TopicStatistics
from studio.ros.parameter_client import ParameterClient
from studio.ros.parameters.parameter import Parameter
from studio.ros.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from studio.ros.tokens import EndpointKind
from studio.ros.wire.zenoh import admin_answers
from tests.support.dds_bridge import Bridge, DdsNetwork, DdsRobot
from tests.support.demos import node_at, spun
from tests.support.node_pair import context_at
from tests.support.pretend_bridge import PretendBridge
from tests.support.wire import running_router, wait_until

if TYPE_CHECKING:
    from collections.abc import Generator

    from studio.ros.action import ServerGoalHandle
    from studio.ros.node.publisher import Publisher
    from studio.ros.node.samples import MessageInfo
    from studio.ros.types.classes import MessageValue

pytestmark = pytest.mark.network
STRING = "std_msgs/msg/String"
ADD = "example_interfaces/srv/AddTwoInts"
LATCHED = {"durability": "transient_local", "depth": 1}


class World(NamedTuple):
    """A robot on DDS behind a bridge at a router, and a node of ours there."""

    network: DdsNetwork
    bridge: Bridge
    robot: DdsRobot
    endpoint: str
    node: Node


@pytest.fixture(scope="module")
def world() -> Generator[World]:
    with ExitStack() as stack:
        endpoint = stack.enter_context(running_router())
        network = stack.enter_context(DdsNetwork())
        bridge = network.bridge(connect=endpoint)
        robot = network.robot()
        node = stack.enter_context(node_at(endpoint, "studio_node"))
        yield World(network, bridge, robot, endpoint, node)


def wait_for_publisher(node: Node, topic: str) -> None:
    wait_until(f"{topic} is published", lambda: bool(node.graph.publishers(topic)))


def wait_for_subscription(node: Node, topic: str) -> None:
    wait_until(f"{topic} is subscribed", lambda: bool(node.graph.subscriptions(topic)))


def test_nodes_on_dds_are_in_the_graph_with_their_names_types_and_qos(world: World):
    best = {"reliability": "best_effort", "durability": "volatile", "depth": 5}
    world.robot.ask("advertise", topic="/arm/angle", type_name="std_msgs/Float64", node="/arm/drv")
    world.robot.ask("subscribe", topic="/arm/goal", type_name=STRING, qos=best, node="/arm/drv")
    world.robot.ask("serve", service="/arm/home", type_name="std_srvs/Trigger", behaviour="agree",
                    node="/arm/drv")  # fmt: skip
    graph = world.node.graph
    wait_until("its ends are there", lambda: bool(
        graph.publishers("/arm/angle") and graph.subscriptions("/arm/goal")
        and graph.servers("/arm/home")))  # fmt: skip
    (publisher,) = graph.publishers("/arm/angle")
    assert publisher.node.path == "/arm/drv"
    assert publisher.node.namespace == "/arm"
    assert publisher.node.bridge
    assert publisher.type_name == "std_msgs/msg/Float64"
    assert publisher.type_hash == world.node.wire.types.hash_of("std_msgs/msg/Float64")
    (subscription,) = graph.subscriptions("/arm/goal")
    assert subscription.qos.reliability is ReliabilityPolicy.BEST_EFFORT
    assert subscription.qos.depth == 5
    (server,) = graph.servers("/arm/home")
    assert server.type_name == "std_srvs/srv/Trigger"
    assert graph.node("/arm/drv") is not None
    assert {one.kind for one in graph.endpoints_of(publisher.node)} == {
        EndpointKind.PUBLISHER, EndpointKind.SUBSCRIPTION, EndpointKind.SERVICE,
    }  # fmt: skip


def test_a_message_from_dds_comes_once_with_its_publisher(world: World):
    heard: list[tuple[str, MessageInfo]] = []
    world.robot.ask("advertise", topic="/words", type_name=STRING)
    wait_for_publisher(world.node, "/words")

    def listen(one: MessageValue, info: MessageInfo) -> None:
        heard.append((one.data, info))

    subscription = world.node.create_subscription(message(STRING), "/words", listen, 10)
    world.robot.ask("publish", topic="/words", type_name=STRING, values={"data": "x"}, rate_hz=50)
    wait_until("it is heard", lambda: len(heard) > 5)
    world.robot.ask("stop", topic="/words")
    (publisher,) = world.node.graph.publishers("/words")
    assert heard[0][0] == "x"
    assert heard[0][1]["publisher_gid"] == publisher.gid
    assert abs(heard[0][1]["received_timestamp"] - heard[0][1]["source_timestamp"]) < 5e9
    count = len(heard)
    world.robot.ask("publish", topic="/words", type_name=STRING, values={"data": "last"})
    wait_until("the last is heard", lambda: heard[-1][0] == "last")
    assert sum(data == "last" for data, _ in heard[count:]) == 1
    assert subscription.losses.lost == subscription.losses.refused == 0
    world.node.destroy_subscription(subscription)


@pytest.mark.parametrize(
    ("kind", "shape"),
    [
        ("Image", {"height": 1080, "width": 1920, "step": 5760, "encoding": "rgb8"}),
        ("PointCloud2", {"height": 1, "width": 60_000, "point_step": 16, "row_step": 960_000}),
    ],
)
def test_images_and_clouds_of_dds_come_whole(world: World, kind: str, shape: dict[str, object]):
    type_name, topic = f"sensor_msgs/msg/{kind}", f"/whole_{kind.lower()}"
    size = 1080 * 5760 if kind == "Image" else 960_000
    heard: list[MessageValue] = []
    subscription = world.node.create_subscription(message(type_name), topic, heard.append, 10)
    world.robot.ask("publish", topic=topic, type_name=type_name, values=shape,
                    filled={"data": size}, rate_hz=5)  # fmt: skip
    wait_until("one came", lambda: bool(heard))
    world.robot.ask("stop", topic=topic)
    assert (heard[0].width, len(heard[0].data)) == (shape["width"], size)
    world.node.destroy_subscription(subscription)


def test_a_message_that_was_kept_on_dds_comes_to_who_is_late(world: World):
    values = {"data": "kept"}
    world.robot.ask("publish", topic="/note", type_name=STRING, values=values, qos=LATCHED)
    wait_for_publisher(world.node, "/note")
    heard: list[str] = []
    qos = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)

    def hear(one: MessageValue) -> None:
        heard.append(one.data)

    for _ in range(2):
        subscription = world.node.create_subscription(message(STRING), "/note", hear, qos)
        wait_until("the kept one is heard", lambda: bool(heard))
        assert heard == ["kept"]
        heard.clear()
        world.node.destroy_subscription(subscription)


def test_a_subscription_that_waits_takes_the_qos_of_the_publisher_that_comes(world: World):
    heard: list[str] = []

    def hear(one: MessageValue) -> None:
        heard.append(one.data)

    qos = QoSProfile(depth=5, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    subscription = world.node.create_subscription(message(STRING), "/later", hear, qos)
    world.robot.ask("publish", topic="/later", type_name=STRING, values={"data": "best effort"},
                    qos={"reliability": "best_effort", "depth": 5}, rate_hz=50)  # fmt: skip
    wait_until("it is heard", lambda: bool(heard))
    world.robot.ask("stop", topic="/later")
    world.node.destroy_subscription(subscription)


def test_a_subscription_goes_on_when_another_bridge_needs_the_topic_no_more(world: World):
    heard: list[str] = []

    def hear(one: MessageValue) -> None:
        heard.append(one.data)

    world.robot.ask("publish", topic="/left", type_name=STRING, values={"data": "l"}, rate_hz=50)
    subscription = world.node.create_subscription(message(STRING), "/left", hear, 10)
    wait_until("it is heard", lambda: bool(heard))
    with PretendBridge(world.endpoint) as other:
        rest = "MS/left/std_msgs§msg§String/:1:0:0,10"
        other.announce(rest)
        path = f"@/{world.bridge.zid}/ros2/route/topic/pub/left"

        def serves_other() -> bool:
            answers = admin_answers(world.node.wire.zenoh, path, 5.0)
            return any(other.zid.encode() in data for _, data in answers)

        wait_until("the bridge knows of the other", serves_other)
        other.retire(rest)
        wait_until("it knows of its end", lambda: not serves_other())
    count = len(heard)
    wait_until("ours goes on", lambda: len(heard) > count + 10)
    world.robot.ask("stop", topic="/left")
    world.node.destroy_subscription(subscription)


def test_a_message_of_ours_is_heard_on_dds(world: World):
    world.robot.ask("subscribe", topic="/orders", type_name=STRING)
    wait_for_subscription(world.node, "/orders")
    publisher = world.node.create_publisher(message(STRING), "/orders", 10)
    wait_until("DDS counts", lambda: publisher.get_subscription_count() == 1)
    publisher.publish(message(STRING)(data="go"))
    assert world.robot.wait_heard("/orders")["data"] == "go"
    world.node.destroy_publisher(publisher)


def test_what_we_keep_comes_to_who_is_late_on_dds(world: World):
    qos = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    publisher = world.node.create_publisher(message(STRING), "/our_note", qos)
    publisher.publish(message(STRING)(data="ours"))
    world.robot.ask("subscribe", topic="/our_note", type_name=STRING, qos=LATCHED)
    assert world.robot.wait_heard("/our_note")["data"] == "ours"
    world.node.destroy_publisher(publisher)


def test_a_subscription_that_ends_takes_nothing_from_another_of_its_session(world: World):
    world.robot.ask("publish", topic="/pulse", type_name=STRING, values={"data": "p"}, rate_hz=50)
    wait_for_publisher(world.node, "/pulse")
    heard: list[str] = []

    def hear(one: MessageValue) -> None:
        heard.append(one.data)

    short = world.node.create_subscription(message(STRING), "/pulse", hear, 5)
    wait_until("it is heard", lambda: bool(heard))
    long = world.node.create_subscription(message(STRING), "/pulse", hear, 4096)
    world.node.destroy_subscription(short)
    routed(world, "/pulse")
    heard.clear()
    wait_until("it is still heard", lambda: len(heard) > 5, 10)
    world.node.destroy_subscription(long)
    world.robot.ask("stop", topic="/pulse")


def test_a_publisher_that_ends_takes_nothing_from_another_of_its_session(world: World):
    world.robot.ask("subscribe", topic="/wishes", type_name=STRING)
    wait_for_subscription(world.node, "/wishes")
    short = world.node.create_publisher(message(STRING), "/wishes", 5)
    wait_until("DDS counts", lambda: short.get_subscription_count() == 1)
    long = world.node.create_publisher(message(STRING), "/wishes", 50)
    world.node.destroy_publisher(short)
    routed(world, "/wishes")
    long.publish(message(STRING)(data="still"))
    assert world.robot.wait_heard("/wishes")["data"] == "still"
    world.node.destroy_publisher(long)


def routed(world: World, topic: str) -> None:
    """Wait until the bridge has taken in what was announced before: it takes it in by turns."""
    marker = world.node.create_publisher(message(STRING), f"{topic}_marker", 10)
    world.robot.ask("subscribe", topic=f"{topic}_marker", type_name=STRING)

    def reaches() -> bool:
        marker.publish(message(STRING)(data="here"))
        return bool(world.robot.all_said("heard", topic=f"{topic}_marker"))

    wait_until("the bridge has gone on", reaches)
    world.node.destroy_publisher(marker)


def test_both_dialects_meet_on_one_topic_and_nothing_comes_twice(world: World):
    heard: list[str] = []

    def hear(one: MessageValue) -> None:
        heard.append(one.data)

    with context_at(world.endpoint) as context:
        other = Node("zenoh_talker", context=context)
        world.robot.ask("advertise", topic="/both", type_name=STRING)
        ours = other.create_publisher(message(STRING), "/both", 10)
        world.node.graph.wait_for(lambda: len(world.node.graph.publishers("/both")) == 2, 10)
        subscription = world.node.create_subscription(message(STRING), "/both", hear, 50)
        wait_until("the route is there", lambda: _reaches(world, heard))
        wait_until("ours is heard", lambda: _said(ours, heard))
        heard.clear()
        for number in range(10):
            ours.publish(message(STRING)(data=f"zenoh {number}"))
            world.robot.ask("publish", topic="/both", type_name=STRING,
                            values={"data": f"dds {number}"})  # fmt: skip
        wait_until("all are heard", lambda: {"zenoh 9", "dds 9"} <= set(heard))
        expected = [f"{kind} {number}" for kind in ("zenoh", "dds") for number in range(10)]
        assert sorted(one for one in heard if one[-1].isdigit()) == sorted(expected)
        world.node.destroy_subscription(subscription)


def _reaches(world: World, heard: list[str]) -> bool:
    world.robot.ask("publish", topic="/both", type_name=STRING, values={"data": "dds?"})
    return "dds?" in heard


def _said(publisher: Publisher, heard: list[str]) -> bool:
    publisher.publish(message(STRING)(data="zenoh?"))
    return "zenoh?" in heard


def test_statistics_count_what_comes_from_dds(world: World):
    world.robot.ask("publish", topic="/beat", type_name=STRING, values={"data": "b"}, rate_hz=50)
    wait_for_publisher(world.node, "/beat")
    statistics = TopicStatistics(world.node.context, "/beat", 30.0)
    wait_until("a rate is known", lambda: 40 < statistics.flow().rate_hz < 60)
    statistics.close()
    world.robot.ask("stop", topic="/beat")


def test_who_subscribes_again_beside_a_rate_that_is_counted_hears_again(world: World):
    world.robot.ask("publish", topic="/tick", type_name=STRING, values={"data": "t"}, rate_hz=50)
    wait_for_publisher(world.node, "/tick")
    heard: list[MessageValue] = []
    statistics = TopicStatistics(world.node.context, "/tick", 30.0)
    for _ in range(2):
        heard.clear()
        subscription = world.node.create_subscription(message(STRING), "/tick", heard.append, 5)
        wait_until("it is heard", lambda: len(heard) > 5, 10)
        world.node.destroy_subscription(subscription)
        routed(world, "/tick")
    statistics.close()
    world.robot.ask("stop", topic="/tick")


def test_a_rate_is_counted_on_when_the_subscription_of_another_session_ends(world: World):
    world.robot.ask("publish", topic="/tock", type_name=STRING, values={"data": "t"}, rate_hz=50)
    wait_for_publisher(world.node, "/tock")
    heard: list[MessageValue] = []
    statistics = TopicStatistics(world.node.context, "/tock", 30.0)
    wait_until("it is counted", lambda: statistics.flow().rate_hz > 20)
    with context_at(world.endpoint) as context:
        other = Node("other_studio", context=context)
        subscription = other.create_subscription(message(STRING), "/tock", heard.append, 5)
        with spun(context, other):
            wait_until("it is heard", lambda: len(heard) > 5, 10)
            other.destroy_subscription(subscription)
    wait_until("the other is gone", lambda: world.node.graph.node("/other_studio") is None)
    routed(world, "/tock")
    heard.clear()
    subscription = world.node.create_subscription(message(STRING), "/tock", heard.append, 5)
    wait_until("it is heard again", lambda: len(heard) > 5, 10)
    world.node.destroy_subscription(subscription)
    statistics.close()
    world.robot.ask("stop", topic="/tock")


def test_services_are_called_both_ways(world: World):
    world.robot.ask("serve", service="/add", type_name=ADD, behaviour="add")
    client = world.node.create_client(service(ADD), "/add")
    assert client.wait_for_service(10)
    assert client.call(service(ADD).Request(a=40, b=2), timeout_sec=10).sum == 42

    def add(request: MessageValue, response: MessageValue) -> MessageValue:
        response.sum = request.a + request.b
        return response

    server = world.node.create_service(service(ADD), "/our_add", add)
    assert world.robot.call("/our_add", ADD, a=3, b=4)["sum"] == 7
    world.node.destroy_service(server)
    world.node.destroy_client(client)


def test_a_request_without_fields_is_answered_both_ways(world: World):
    empty = "std_srvs/srv/Empty"
    world.robot.ask("serve", service="/nothing", type_name=empty, behaviour="default")
    client = world.node.create_client(service(empty), "/nothing")
    assert client.wait_for_service(10)
    client.call(service(empty).Request(), timeout_sec=10)
    server = world.node.create_service(service(empty), "/our_nothing", _same)
    world.robot.call("/our_nothing", empty)
    world.node.destroy_service(server)
    world.node.destroy_client(client)


def _same(_request: MessageValue, response: MessageValue) -> MessageValue:
    return response


def test_parameters_of_a_node_on_dds_are_read_and_set(world: World):
    world.robot.ask("parameters", values={"speed": 1.5, "name": "dds"}, node="/driver")
    wait_until("they are served", lambda: world.node.graph.has_server("/driver/set_parameters"))
    with ParameterClient(world.node, "/driver") as client:
        assert set(client.names()) >= {"speed", "name"}
        (speed,) = client.get(["speed"])
        assert speed.value == 1.5
        client.set([Parameter("speed", value=2.5)])
    assert world.robot.ask("parameter", name="speed", node="/driver") == 2.5


def test_a_managed_node_on_dds_is_led_through_its_states(world: World):
    world.robot.ask("manage", node="/arm")
    wait_until("it is managed", lambda: world.node.graph.has_server("/arm/change_state"))
    with LifecycleClient(world.node, "/arm") as client:
        assert client.state().label == "unconfigured"
        assert client.change("configure")
        assert client.state().label == "inactive"


def test_a_goal_goes_to_dds_with_feedback_result_and_cancel(world: World):
    fibonacci = action("example_interfaces/action/Fibonacci")
    world.robot.ask("serve_fibonacci")
    client = ActionClient(world.node, fibonacci, "/fibonacci")
    assert client.wait_for_server(10)
    told: list[int] = []

    def hear(one: MessageValue) -> None:
        told.append(len(one.feedback.sequence))

    handle = client.send_goal_async(fibonacci.Goal(order=5), feedback_callback=hear)
    assert handle.wait(10)
    goal = handle.result()
    assert goal.accepted
    result = goal.get_result()
    assert GoalStatus(result.status) is GoalStatus.SUCCEEDED
    assert list(result.result.sequence)[:4] == [0, 1, 1, 2]
    wait_until("feedback came", lambda: bool(told))
    handle = client.send_goal_async(fibonacci.Goal(order=1000))
    assert handle.wait(10)
    assert handle.result().cancel_goal().return_code == 0
    assert GoalStatus(handle.result().get_result().status) is GoalStatus.CANCELED
    client.destroy()


def test_a_goal_comes_from_dds(world: World):
    fibonacci = action("example_interfaces/action/Fibonacci")

    def execute(goal: ServerGoalHandle) -> MessageValue:
        feedback = fibonacci.Feedback(sequence=[0, 1])
        goal.publish_feedback(feedback)
        goal.succeed()
        return fibonacci.Result(sequence=[0, 1, 1])

    server = ActionServer(world.node, fibonacci, "/our_fibonacci", execute)
    world.robot.ask("send_goal", action="/our_fibonacci", goal={"order": 3})
    result = world.robot.wait_said("result", action="/our_fibonacci")
    assert list(result["result"]["sequence"]) == [0, 1, 1]
    server.destroy()


def test_a_robot_that_leaves_is_gone_from_the_graph(world: World):
    robot = world.network.robot()
    robot.ask("advertise", topic="/short", type_name=STRING, node="/short_lived")
    wait_until("it is there", lambda: world.node.graph.node("/short_lived") is not None)
    robot.end()
    wait_until("it is gone", lambda: world.node.graph.node("/short_lived") is None)
    assert not world.node.graph.publishers("/short")
