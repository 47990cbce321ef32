"""Every demo starts, is seen in the graph, and ends when it is told to."""

from __future__ import annotations

import os
import signal
import sys
from typing import TYPE_CHECKING

import pytest

from studio.course.demos import DEMOS
from tests.support.demos import ENDS_WITHIN_S, heard, node_at, running, running_demo
from tests.support.wire import free_endpoint, wait_until

if TYPE_CHECKING:
    from collections.abc import Generator

    from studio.ros.client import Node

pytestmark = pytest.mark.network
WORDS = {"adder_client": ("1", "2")}
AT_A_TERMINAL = "turtle_teleop_key"


@pytest.fixture(scope="module")
def node(endpoint: str) -> Generator[Node]:
    with node_at(endpoint) as made:
        yield made


@pytest.mark.parametrize("name", [demo.name for demo in DEMOS if demo.name != AT_A_TERMINAL])
def test_a_demo_is_seen_and_ends_by_ctrl_c_within_two_seconds(endpoint: str, node: Node, name: str):
    with running_demo(endpoint, name, *WORDS.get(name, ())) as demo:
        wait_until("its node", lambda: len(node.graph.nodes()) > 1)
        # While it is still being made, Zenoh may hold up its end, and the signal ends it.
        by_signal = {-signal.SIGINT, 128 + signal.SIGINT}
        assert demo.stop(signal.SIGINT) in {0} | by_signal
        assert "Traceback" not in demo.printed, demo.printed
    wait_until("it has left", lambda: len(node.graph.nodes()) == 1)


def test_without_a_router_a_demo_brings_one_and_where_it_may_not_it_says_why():
    held = free_endpoint()
    with running([sys.executable, "-m", "studio.course.basic_node"], held) as demo:
        demo.wait_for("Basic Node initialized")
        assert demo.stop() == 0
    udp = held.replace("tcp/", "udp/")
    with running([sys.executable, "-m", "studio.course.basic_node"], udp) as demo:
        assert demo.wait() == 1
    assert "Traceback" not in demo.printed
    assert demo.printed.count("\n") == 1


def test_what_is_missing_is_said_in_one_sentence(endpoint: str):
    with running_demo(endpoint, "adder_client") as demo:
        assert demo.wait() == 1
    assert demo.printed == "Two integers are needed: studio run learning_interface client 41 1\n"
    with running_demo(endpoint, AT_A_TERMINAL) as teleop:
        assert teleop.wait() == 1
    assert "Keys come from a terminal" in teleop.printed


def test_keys_of_a_terminal_drive_the_turtle_until_q(endpoint: str, node: Node):
    ours, theirs = os.openpty()
    twists = heard(node, "geometry_msgs/msg/Twist", "/turtle1/cmd_vel")
    words = [sys.executable, "-m", f"studio.course.{AT_A_TERMINAL}"]
    try:
        with running(words, endpoint, theirs) as teleop:
            teleop.wait_for("Arrow keys move the turtle.")
            wait_until("its publisher", lambda: bool(node.graph.publishers("/turtle1/cmd_vel")))
            for key, speeds in ((b"\x1b[A", (2.0, 0.0)), (b"\x1b[D", (0.0, 2.0))):
                os.write(ours, key)
                wait_until(
                    "the twist",
                    lambda wanted=speeds: (
                        bool(twists) and (twists[-1].linear.x, twists[-1].angular.z) == wanted
                    ),
                )
            os.write(ours, b"x")
            os.write(ours, b"q")
            assert teleop.wait(ENDS_WITHIN_S) == 0
    finally:
        os.close(ours)
        os.close(theirs)
