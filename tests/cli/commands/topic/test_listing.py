from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.support.command_line import comes_to, started, studio
from tests.support.wire import open_test_session, show_endpoints, wait_until

if TYPE_CHECKING:
    from collections.abc import Generator

STRING_HASH = "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"


@pytest.fixture(scope="module", autouse=True)
def talker(endpoint: str) -> Generator[None]:
    words = ("topic", "pub", "/chatter", "std_msgs/msg/String", "data: 'Hello'", "-n", "talker")
    with started(endpoint, *words) as process:
        process.wait_for("publishing #1")
        yield


def test_t1_topics_are_listed_with_their_types(endpoint: str):
    at = ("--connect", endpoint)
    comes_to(lambda ran: ran.out == "/chatter\n/parameter_events\n/rosout\n", "topic", "list", *at)
    typed = studio("topic", "list", "-t", *at).out.splitlines()
    assert typed[0] == "/chatter [std_msgs/msg/String]"
    assert studio("topic", "list", "-c", *at).out == "3\n"
    verbose = studio("topic", "list", "-v", *at).out
    assert verbose.startswith("Published topics:\n * /chatter [std_msgs/msg/String] 1 publisher\n")
    assert verbose.endswith("\n\nSubscribed topics:\n\n")


def test_t1_info_and_type_of_a_topic(endpoint: str):
    at = ("--connect", endpoint)
    told = "Type: std_msgs/msg/String\nPublisher count: 1\nSubscription count: 0\n"
    comes_to(lambda ran: ran.out == told, "topic", "info", "/chatter", *at)
    assert studio("topic", "type", "/chatter", *at).out == "std_msgs/msg/String\n"
    assert studio("topic", "type", "chatter", *at).out == "std_msgs/msg/String\n"


def test_t4_info_tells_each_end_with_its_qos(endpoint: str):
    out = studio("topic", "info", "-v", "/chatter", "--connect", endpoint).out
    for line in (
        "Node name: talker",
        "Node namespace: /",
        f"Topic type hash: {STRING_HASH}",
        "Endpoint type: PUBLISHER",
        "  Reliability: RELIABLE",
        "  History (Depth): KEEP_LAST (10)",
        "  Durability: VOLATILE",
        "  Liveliness lease duration: Infinite",
    ):
        assert line in out.splitlines()


def test_t3_topics_are_found_by_type(endpoint: str):
    at = ("--connect", endpoint)
    assert studio("topic", "find", "std_msgs/msg/String", *at).out == "/chatter\n"
    assert studio("topic", "find", "std_msgs/msg/Int64", *at).out == ""
    assert studio("topic", "find", "std_msgs/msg/String", "-c", *at).out == "1\n"


def test_a_topic_that_nobody_has_is_told_as_ros2_tells_it(endpoint: str):
    at = ("--connect", endpoint)
    ran = studio("topic", "info", "/nope", *at)
    assert (ran.code, ran.err) == (1, "Unknown topic '/nope'\n")
    assert studio("topic", "type", "/nope", *at).code == 1


def test_n7_the_list_is_whole_right_after_joining_a_thousand_endpoints(endpoint: str):
    """No daemon has learned of them before: each line asks anew."""
    with open_test_session(endpoint, domain=11) as many:
        kept = show_endpoints(many, 1_000)
        for _ in range(3):
            ran = studio("topic", "list", "-c", "--domain", "11", "--connect", endpoint)
            assert ran.out == "1000\n"
        assert len(kept) == 1_001


def test_q1_another_domain_is_empty_and_says_where_nodes_are(endpoint: str):
    ran = studio("topic", "list", "--domain", "7", "--connect", endpoint)
    assert (ran.code, ran.out) == (0, "")
    assert ran.err == (
        "studio: No node is in domain 7, but 1 node is in domain 0: choose --domain 0.\n"
    )


def test_n7_a_node_that_is_killed_is_listed_no_more(endpoint: str):
    words = ("topic", "pub", "/gone", "std_msgs/msg/String", "-n", "short_lived")
    at = ("--connect", endpoint)
    with started(endpoint, *words) as process:
        process.wait_for("publishing #1")
        comes_to(lambda ran: "/short_lived" in ran.out.split(), "node", "list", *at)
    wait_until("gone", lambda: "/gone" not in studio("topic", "list", *at).out.split())
    wait_until("the node, too", lambda: studio("node", "list", *at).out == "/talker\n")
