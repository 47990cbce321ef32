from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.ros.qos import DurabilityPolicy, QoSProfile
from tests.support.command_line import comes_to, started, studio
from tests.support.demos import heard, node_at
from tests.support.wire import free_endpoint, wait_until

if TYPE_CHECKING:
    from collections.abc import Generator
    from pathlib import Path

    from studio.ros.client import Node

TWIST = "{linear: {x: 2.0, y: 0.0, z: 0.0}, angular: {x: 0.0, y: 0.0, z: 1.8}}"


@pytest.fixture
def listener(endpoint: str) -> Generator[Node]:
    with node_at(endpoint, "listener") as node:
        yield node


def test_t2_the_yaml_of_the_course_arrives_as_a_twist(endpoint: str, listener: Node):
    twists = heard(listener, "geometry_msgs/msg/Twist", "/turtle1/cmd_vel")
    words = ("topic", "pub", "--rate", "1", "/turtle1/cmd_vel", "geometry_msgs/msg/Twist", TWIST)
    with started(endpoint, *words, "--connect", endpoint) as pub:
        wait_until("a twist", lambda: bool(twists))
        assert (twists[0].linear.x, twists[0].angular.z) == (2.0, 1.8)
        pub.wait_for("publisher: beginning loop\npublishing #1: geometry_msgs.msg.Twist(")


def test_t2_once_waits_for_a_listener_and_ends(endpoint: str, listener: Node):
    texts = heard(listener, "std_msgs/msg/String", "/said")
    ran = studio("topic", "pub", "-1", "/said", "std_msgs/msg/String", "data: Hello", "--connect",
                 endpoint)  # fmt: skip
    assert ran.code == 0
    assert ran.out.endswith(
        "publisher: beginning loop\npublishing #1: std_msgs.msg.String(data='Hello')\n\n"
    )
    wait_until("the text", lambda: [text.data for text in texts] == ["Hello"])


def test_as_many_as_asked_for_are_sent_and_each_nth_is_said(endpoint: str, listener: Node):
    numbers = heard(listener, "std_msgs/msg/Int64", "/numbers")
    ran = studio("topic", "pub", "/numbers", "std_msgs/msg/Int64", "data: -7", "-r", "200", "-t",
                 "6", "-p", "3", "--connect", endpoint)  # fmt: skip
    wait_until("six", lambda: len(numbers) == 6)
    assert {number.data for number in numbers} == {-7}
    assert [line.split(":")[0] for line in ran.out.splitlines() if line.startswith("publishing")] \
        == ["publishing #3", "publishing #6"]  # fmt: skip


def test_the_message_may_stand_behind_options(endpoint: str, listener: Node):
    numbers = heard(listener, "std_msgs/msg/Int64", "/late")
    for last in (("data: 1",), ("--connect", endpoint, "data: 2"), ("--", "data: 3")):
        ran = studio("topic", "pub", "-1", "/late", "std_msgs/msg/Int64", "--connect", endpoint,
                     "-w", "1", *last)  # fmt: skip
        assert ran.code == 0, ran.err
    wait_until("all", lambda: [number.data for number in numbers] == [1, 2, 3])
    twice = ("data: 4", "-r", "1", "data: 5")
    assert studio("topic", "pub", "/late", "std_msgs/msg/Int64", *twice).code == 2


def test_t2_what_echo_printed_is_published_again(endpoint: str, listener: Node, tmp_path: Path):
    numbers = heard(listener, "std_msgs/msg/Int64", "/again")
    file = tmp_path / "said.yaml"
    file.write_text("data: 7\n---\ndata: -8\n---\n")
    words = ("topic", "pub", "/again", "std_msgs/msg/Int64", "-r", "200", "-w", "1", "--connect",
             endpoint)  # fmt: skip
    assert studio(*words, "--yaml-file", str(file)).code == 0
    assert studio(*words, "--yaml-file", str(file), "-t", "1").code == 0
    wait_until("all", lambda: [number.data for number in numbers] == [7, -8, 7])
    assert studio(*words, "--yaml-file", str(file), "--stdin").code == 2


def test_nobody_listens_within_the_time(endpoint: str):
    ran = studio("topic", "pub", "-1", "/unheard", "std_msgs/msg/String", "--max-wait-time-secs",
                 "0.1", "--connect", endpoint)  # fmt: skip
    assert ran.code == 1
    assert "Waiting for at least 1 matching subscription(s)..." in ran.out
    assert "publishing" not in ran.out


def test_t4_quality_of_service_is_as_told(endpoint: str, listener: Node):
    words = ("topic", "pub", "/latched", "std_msgs/msg/String", "data: x", "-r", "0.01",
             "--qos-durability", "transient_local", "--connect", endpoint)  # fmt: skip
    with started(endpoint, *words) as pub:
        pub.wait_for("publishing #1")
        late = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        texts = heard(listener, "std_msgs/msg/String", "/latched", late)
        wait_until("what was said before", lambda: len(texts) == 1)


def test_a_stamp_is_the_time_of_each_message(endpoint: str, listener: Node):
    points = heard(listener, "geometry_msgs/msg/PointStamped", "/stamped")
    studio("topic", "pub", "-t", "2", "-r", "100", "/stamped", "geometry_msgs/msg/PointStamped",
           "{header: auto, point: {x: -1.5}}", "--connect", endpoint)  # fmt: skip
    wait_until("two", lambda: len(points) == 2)
    first, second = (point.header.stamp for point in points)
    assert first.sec > 1_700_000_000
    assert (first.sec, first.nanosec) < (second.sec, second.nanosec)
    assert points[0].point.x == -1.5


def test_without_a_router_one_is_started_for_as_long_as_it_runs():
    endpoint = free_endpoint()
    at = ("--connect", endpoint)
    assert "No Zenoh router answers" in studio("topic", "list", *at).err
    words = ("topic", "pub", "/chatter", "std_msgs/msg/String", *at)
    with started(endpoint, *words) as pub:
        pub.wait_for("publishing #1")
        comes_to(lambda ran: "/chatter" in ran.out.split(), "topic", "list", *at)
    ran = studio("topic", "pub", "/chatter", "std_msgs/msg/String", "--router", "off", *at)
    assert ran.code == 2
    assert "No Zenoh router answers" in ran.err


@pytest.mark.parametrize(
    ("kind", "values"),
    [
        ("std_msgs/msg/String", "data: ["),
        ("std_msgs/msg/String", "dat: x"),
        ("std_msgs/msg/Int64", "data: x"),
        ("std_msgs/msg/Int8", "data: 1000"),
        ("std_msgs/msg/String", "just words"),
        ("std_msgs/msg/String", "&a [*a]"),
        ("std_msgs/msg/Nope", "{}"),
        ("nonsense", "{}"),
    ],
)
def test_a_mistake_is_one_sentence(endpoint: str, kind: str, values: str):
    ran = studio("topic", "pub", "/x", kind, values, "--connect", endpoint)
    assert ran.code == 2
    assert ran.err.startswith("studio: ")
    assert ran.err.count("\n") == 1
