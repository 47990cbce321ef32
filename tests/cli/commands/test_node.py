from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.support.command_line import studio
from tests.support.demos import running_demo
from tests.support.wire import wait_until

if TYPE_CHECKING:
    from collections.abc import Generator


@pytest.fixture(scope="module", autouse=True)
def nodes(endpoint: str) -> Generator[None]:
    with running_demo(endpoint, "turtlesim_node") as turtles, running_demo(endpoint, "talker"):
        turtles.wait_for("Spawning turtle")
        wait_until(
            "the talker",
            lambda: "helloworld" in studio("node", "list", "--connect", endpoint).out,
        )
        yield


def groups(text: str) -> dict[str, list[str]]:
    """The lines below each title of `node info`."""
    found: dict[str, list[str]] = {}
    title = ""
    for line in text.splitlines()[1:]:
        if line.endswith(":") and line.startswith("  ") and line[2] != " ":
            title = line.strip(" :")
            found[title] = []
        elif line.strip():
            found[title].append(line.strip())
    return found


def test_n2_nodes_are_listed(endpoint: str):
    at = ("--connect", endpoint)
    assert studio("node", "list", *at).out == "/topic_helloworld_pub\n/turtlesim\n"
    assert studio("node", "list", "-c", *at).out == "2\n"


def test_n2_what_a_node_has_is_grouped_as_ros2_does(endpoint: str):
    out = studio("node", "info", "/turtlesim", "--connect", endpoint).out
    assert out.startswith("/turtlesim\n  Subscribers:\n")
    found = groups(out)
    assert list(found) == [
        "Subscribers",
        "Publishers",
        "Service Servers",
        "Service Clients",
        "Action Servers",
        "Action Clients",
    ]
    assert "/turtle1/cmd_vel: geometry_msgs/msg/Twist" in found["Subscribers"]
    assert "/turtle1/pose: turtlesim/msg/Pose" in found["Publishers"]
    assert "/spawn: turtlesim/srv/Spawn" in found["Service Servers"]
    assert found["Action Servers"] == ["/turtle1/rotate_absolute: turtlesim/action/RotateAbsolute"]
    assert not found["Service Clients"]
    assert not found["Action Clients"]


def test_a_node_that_is_not_there_is_told_as_ros2_tells_it(endpoint: str):
    ran = studio("node", "info", "/nope", "--connect", endpoint)
    assert (ran.code, ran.err) == (1, "Unable to find node '/nope'\n")


def test_n1_two_nodes_of_one_name_are_warned_of(endpoint: str):
    at = ("--connect", endpoint)
    with running_demo(endpoint, "talker"):
        wait_until(
            "both",
            lambda: studio("node", "list", *at).out.count("/topic_helloworld_pub\n") == 2,
        )
        assert "share an exact name" in studio("node", "list", *at).err
        assert "There are 2 nodes" in studio("node", "info", "/topic_helloworld_pub", *at).out
        doctor = studio("doctor", *at)
        assert doctor.code == 1
        assert "2 nodes are called /topic_helloworld_pub" in doctor.out
