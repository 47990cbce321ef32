from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.errors import DestroyedError, RosNameError
from studio.ros.messages import message, service
from studio.ros.node.node import Node
from studio.ros.node.publisher import Publisher
from studio.ros.node.subscription import Subscription
from studio.ros.parameters.parameter import Parameter
from studio.ros.qos import QoSProfile, qos_profile_rosout_default
from studio.ros.tokens import EndpointKind, tokens_of_domain
from studio.ros.wire.zenoh import live_tokens
from tests.support.node_pair import context_at, node_pair, spin_until
from tests.support.wire import open_test_session, wait_until

if TYPE_CHECKING:
    from collections.abc import Generator

    from studio.ros.node.base import Endpoint
    from studio.ros.node.context import Context
    from studio.ros.types.classes import MessageValue

String = message("std_msgs/msg/String")
Log = message("rcl_interfaces/msg/Log")
Trigger = service("std_srvs/srv/Trigger")


@pytest.fixture
def context(endpoint: str) -> Generator[Context]:
    with context_at(endpoint) as found:
        yield found


def test_a_node_tells_its_names(context: Context):
    node = Node("talker", context=context, namespace="ns")
    assert (node.get_name(), node.get_namespace()) == ("talker", "/ns")
    assert node.get_fully_qualified_name() == "/ns/talker"
    assert node.get_logger().name == "ns.talker"


@pytest.mark.parametrize(
    ("name", "full_name"),
    [("chatter", "/ns/chatter"), ("/chatter", "/chatter"), ("~/chatter", "/ns/talker/chatter")],
)
def test_names_are_completed(context: Context, name: str, full_name: str):
    node = Node("talker", context=context, namespace="/ns")
    assert node.create_publisher(String, name, 10).topic_name == full_name
    assert node.create_subscription(String, name, print, 10).topic_name == full_name
    assert node.create_client(Trigger, name).srv_name == full_name


@pytest.mark.parametrize("name", ["", "two words", "9", "a//b", "a/"])
def test_names_that_ros_refuses_are_refused(context: Context, name: str):
    node = Node("talker", context=context)
    with pytest.raises(RosNameError):
        node.create_publisher(String, name, 10)
    with pytest.raises(RosNameError):
        Node(name or "/", context=context)


def test_names_are_given_by_the_arguments_of_a_node(context: Context):
    node = Node(
        "talker",
        context=context,
        cli_args=["--ros-args", "-r", "__node:=bob", "-r", "__ns:=/there", "-r", "chatter:=/x"],
        parameter_overrides=[Parameter("number", value=4)],
    )
    assert node.get_fully_qualified_name() == "/there/bob"
    assert node.create_publisher(String, "chatter", 10).topic_name == "/x"
    assert node.resolve_topic_name("chatter", only_expand=True) == "/there/chatter"
    assert node.declare_parameter("number", 1).value == 4


def test_a_destroyed_node_leaves_no_token(endpoint: str, context: Context):
    node = Node("leaves", context=context)
    node.create_publisher(String, "a", 10)
    node.create_subscription(String, "b", print, 10)
    node.create_service(Trigger, "c", lambda _asked, given: given)
    node.create_client(Trigger, "d")
    node.create_timer(1.0, print)
    node.create_rate(1.0)
    ended: list[str] = []
    node.on_destroy(lambda: ended.append("first"))
    node.on_destroy(lambda: ended.append("last"))
    node.destroy_node()
    node.destroy_node()
    assert ended == ["last", "first"]
    with open_test_session(endpoint) as wire:
        wait_until(
            "no token is left",
            lambda: (
                not any(
                    "leaves" in token for token in live_tokens(wire.zenoh, tokens_of_domain(0), 3)
                )
            ),
        )
    with pytest.raises(DestroyedError, match="/leaves"):
        node.create_publisher(String, "a", 10)
    with pytest.raises(DestroyedError, match="/leaves"):
        node.create_timer(1.0, print)


def test_what_is_made_while_its_node_is_destroyed_leaves_no_token(endpoint: str, context: Context):
    node = Node("races", context=context)

    class LatePublisher(Publisher):
        def __init__(self, endpoint: Endpoint, msg_type: type[MessageValue]) -> None:
            node.destroy_node()
            super().__init__(endpoint, msg_type)

    place = node.endpoint(EndpointKind.SUBSCRIPTION, "std_msgs/msg/String", "late", 10)
    with pytest.raises(DestroyedError, match="/races"):
        node.create_publisher(String, "late", 10, publisher_class=LatePublisher)
    subscription = Subscription(place, String, print, node.default_callback_group)
    with pytest.raises(DestroyedError, match="/races"):
        node.add_work(subscription)
    with open_test_session(endpoint) as wire:
        wait_until(
            "no token is left",
            lambda: (
                not any(
                    "races" in token for token in live_tokens(wire.zenoh, tokens_of_domain(0), 3)
                )
            ),
        )


def test_what_is_forgotten_is_not_called_at_the_end(context: Context):
    node = Node("ends", context=context)
    ended: list[str] = []

    def end() -> None:
        ended.append("end")

    node.on_destroy(end)
    node.forget_destroy(end)
    node.forget_destroy(end)
    node.destroy_node()
    assert ended == []


def test_a_node_sees_the_others(context: Context, endpoint: str):
    node = Node("looks", context=context)
    with context_at(endpoint) as other:
        seen = Node("seen", context=other, namespace="/far")
        seen.create_publisher(String, "shown", 10)
        seen.create_service(Trigger, "served", lambda _asked, given: given)
        wait_until("it is seen", lambda: "/far/seen" in node.get_fully_qualified_node_names())
        wait_until("it serves", lambda: node.count_services("/far/served") == 1)
        assert ("seen", "/far") in node.get_node_names_and_namespaces()
        shown = ("/far/shown", ["std_msgs/msg/String"])
        wait_until("it publishes", lambda: shown in node.get_topic_names_and_types())
        assert ("/far/served", ["std_srvs/srv/Trigger"]) in node.get_service_names_and_types()
        (info,) = node.get_publishers_info_by_topic("/far/shown")
        assert (info.kind, info.node_name) == (EndpointKind.PUBLISHER, "seen")
        assert node.count_publishers("/far/shown") == 1
        assert node.count_subscribers("/far/shown") == 0
        assert node.count_clients("/far/served") == 0
    wait_until("it is gone", lambda: "seen" not in node.get_node_names())


def test_what_a_node_says_is_heard_on_rosout():
    with node_pair() as (talker, listener):
        heard: list[MessageValue] = []
        talker.get_logger().warning("before anyone listens \udcff")
        listener.create_subscription(Log, "/rosout", heard.append, qos_profile_rosout_default)
        spin_until(lambda: bool(heard), listener)
        (said,) = heard
        assert (said.name, said.level, said.msg) == ("talker", 30, "before anyone listens ?")
        assert said.file == __file__
        talker.destroy_node()
        talker.get_logger().info("after it was destroyed")


def test_a_node_without_rosout_publishes_none(context: Context):
    Node("quiet", context=context, enable_rosout=False)
    tokens = live_tokens(context.wire.zenoh, tokens_of_domain(0), 3)
    assert not any("quiet" in token and "%rosout" in token for token in tokens)


def test_attributes_of_students_may_have_any_name(context: Context):
    class Course(Node):
        def __init__(self) -> None:
            super().__init__("course", context=context)
            self.wire = "copper"  # pyright: ignore[reportAttributeAccessIssue]
            self.publisher = self.create_publisher(String, "x", 10)
            self.timer = self.create_timer(0.0, self.beat)
            self.beats = 0

        def beat(self) -> None:
            self.beats += 1
            self.publisher.publish(String(data="x"))

    node = Course()
    spin_until(lambda: node.beats > 1, node)
    node.destroy_node()


def test_a_whole_profile_is_copied(context: Context):
    node = Node("copies", context=context)
    qos = QoSProfile(depth=3)
    publisher = node.create_publisher(String, "copied", qos)
    qos.depth = 9
    assert publisher.qos_profile.depth == 3
