"""The course's rows on topics: T7-T11, each node in a process of its own."""

from __future__ import annotations

import pytest

from studio.ros.client import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from tests.support.demos import heard, node_at, running_demo
from tests.support.wire import wait_until

pytestmark = pytest.mark.network


def test_t7_quotes_have_three_fields_and_are_logged_by_the_subscriber(endpoint: str):
    with (
        node_at(endpoint) as node,
        running_demo(endpoint, "quote_subscriber") as subscriber,
        running_demo(endpoint, "quote_publisher"),
    ):
        quotes = heard(node, "pkg_with_interfaces/msg/AmazingQuote", "/amazing_quote")
        wait_until("two quotes", lambda: len(quotes) >= 2)
        first, second = quotes[:2]
        assert second.id == first.id + 1
        assert (first.quote, first.philosopher_name) == ("Use the force, Pikachu!", "Uncle Ben")
        subscriber.wait_for("It was thought by the genius -- Uncle Ben. This latest quote had the")


def test_t8_what_the_talker_says_is_heard_by_the_listener(endpoint: str):
    with running_demo(endpoint, "listener") as listener, running_demo(endpoint, "talker") as talker:
        talker.wait_for('[topic_helloworld_pub]: Publishing: "Hello World"')
        listener.wait_for('[topic_helloworld_sub]: I heard: "Hello World"')


def test_t8_counted_greetings_arrive_in_their_order(endpoint: str):
    with (
        running_demo(endpoint, "subscriber_node") as subscriber,
        running_demo(endpoint, "publisher_node"),
    ):
        subscriber.wait_for('I heard: "Hello World: 3"')
        numbers = [line.split()[-1] for line in subscriber.lines if "Hello World" in line]
        first = int(numbers[0].strip('"'))
        assert numbers == [f'{number}"' for number in range(first, first + len(numbers))]


def test_t9_the_counter_grows_by_two_with_each_number(endpoint: str):
    with (
        running_demo(endpoint, "number_counter") as counter,
        running_demo(endpoint, "number_publisher"),
    ):
        for total in (2, 4, 6):
            counter.wait_for(f"Counter: {total}\n")


@pytest.mark.parametrize(
    ("demo", "name", "text"),
    [
        ("timer_node", "timer_node", 'Publishing: "Timer message: 1"'),
        ("print_forever", "print_forever", "Printed 1 times."),
        ("my_tiny_node", "my_tiny_node", "Hello 1"),
        ("basic_node", "basic_node", "Basic Node initialized"),
        ("hello_world", "node_helloworld_class", "Hello World"),
    ],
)
def test_t10_logs_appear_live_on_rosout(endpoint: str, demo: str, name: str, text: str):
    latched = QoSProfile(depth=1000, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    with node_at(endpoint) as node, running_demo(endpoint, demo):
        logs = heard(node, "rcl_interfaces/msg/Log", "/rosout", latched)
        wait_until(
            f"{text} logged", lambda: any((log.name, log.msg) == (name, text) for log in logs)
        )


def test_t10_the_timer_node_publishes_every_half_second(endpoint: str):
    with node_at(endpoint) as node, running_demo(endpoint, "timer_node"):
        messages = heard(node, "std_msgs/msg/String", "/timer_topic")
        wait_until("three messages", lambda: len(messages) >= 3)
        numbers = [int(one.data.removeprefix("Timer message: ")) for one in messages[:3]]
        assert numbers == list(range(numbers[0], numbers[0] + 3))


def test_t11_a_type_of_ones_own_is_published_without_a_build(endpoint: str):
    with node_at(endpoint) as node, running_demo(endpoint, "telemetry_publisher"):
        told = heard(node, "my_robot_interfaces/msg/CustomTelemetry", "/telemetry")
        wait_until("telemetry", lambda: len(told) >= 2)
        assert told[0].battery_voltage > told[1].battery_voltage > 10.0
        assert (told[0].header.frame_id, told[0].status) == ("base_link", "ok")


def test_t12_the_temperature_pair_speaks_of_degrees(endpoint: str):
    with (
        running_demo(endpoint, "temperature_subscriber") as subscriber,
        running_demo(endpoint, "temperature_publisher"),
    ):
        subscriber.wait_for(" of 2")
        assert "C, mean 2" in subscriber.printed


def test_t4_the_topic_of_the_course_is_reliable_and_volatile(endpoint: str):
    with running_demo(endpoint, "qos_topic_node"), node_at(endpoint) as node:
        wait_until("its publisher", lambda: bool(node.graph.publishers("/reliable_topic")))
        (publisher,) = node.graph.publishers("/reliable_topic")
        assert publisher.qos.reliability is ReliabilityPolicy.RELIABLE
        assert publisher.qos.durability is DurabilityPolicy.VOLATILE
        assert publisher.qos.depth == 10


def test_t4_one_who_comes_late_gets_the_kept_message_where_the_user_has_it_kept(endpoint: str):
    latched = QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    kept_by_user = "qos_overrides./reliable_topic.publisher.durability:=transient_local"
    words = ("qos_topic_node", "--ros-args", "-p", kept_by_user)
    with running_demo(endpoint, *words), node_at(endpoint) as early:
        heard_early = heard(early, "std_msgs/msg/String", "/reliable_topic", latched)
        wait_until("the first one", lambda: bool(heard_early))
        with node_at(endpoint, "late") as late:
            kept = heard(late, "std_msgs/msg/String", "/reliable_topic", latched)
            wait_until("what was kept", lambda: bool(kept))
            assert kept[0].data == "reliably: 0"
