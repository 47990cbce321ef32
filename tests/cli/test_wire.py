from __future__ import annotations

import pytest

from tests.support.command_line import studio
from tests.support.wire import free_endpoint


@pytest.mark.parametrize(
    "line",
    [
        "topic list",
        "topic info /x",
        "topic echo /x",
        "topic hz /x",
        "node list",
        "service list",
        "service call /x std_srvs/srv/Empty",
        "action list",
        "action send_goal /x turtlesim/action/RotateAbsolute",
        "param list",
        "param set /n x -1.5",
        "lifecycle nodes",
        "doctor --report",
    ],
)
def test_where_no_router_answers_a_verb_that_looks_says_so(line: str):
    endpoint = free_endpoint()
    ran = studio(*line.split(), "--connect", endpoint)
    assert (ran.code, ran.out) == (2, "")
    assert ran.err == (
        f"studio: No Zenoh router answers at {endpoint}: start one there (studio router, or "
        "ros2 run rmw_zenoh_cpp rmw_zenohd), or name another with --connect.\n"
    )


@pytest.mark.parametrize("line", ["topic list", "doctor --report", "node list --router auto"])
def test_a_host_that_no_resolver_takes_is_one_sentence(line: str):
    ran = studio(*line.split(), "--connect", "tcp/a..b:7447")
    assert (ran.code, ran.out) == (2, "")
    assert ran.err == (
        'studio: "a..b" is no host name: each part between its dots has 1 to 63 letters.\n'
    )


def test_a_verb_starts_a_router_when_it_is_told_to():
    ran = studio("node", "list", "--connect", free_endpoint(), "--router", "auto")
    assert (ran.code, ran.out) == (0, "")
    assert "is there, but no node is: start one" in ran.err


@pytest.mark.parametrize(
    "options",
    [
        ("--domain", "233"),
        ("--domain", "-1"),
        ("--domain", "x"),
        ("--distro", "noetic"),
        ("--router", "sometimes"),
        ("--interfaces", "nowhere"),
    ],
)
def test_a_wrong_option_ends_with_2_and_words(options: tuple[str, ...], endpoint: str):
    ran = studio("topic", "echo", "/x", *options, "--connect", endpoint)
    assert (ran.code, ran.out) == (2, "")
    assert "Traceback" not in ran.err


def test_humble_is_spoken_when_asked_for(endpoint: str):
    assert studio("topic", "list", "--distro", "humble", "--connect", endpoint).code == 0


def test_the_domain_of_the_environment_is_taken(endpoint: str, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setenv("ROS_DOMAIN_ID", "42")
    assert "domain          : 42\n" in studio("doctor", "--report", "--connect", endpoint).out
    monkeypatch.setenv("ROS_DOMAIN_ID", "many")
    ran = studio("topic", "list", "--connect", endpoint)
    assert ran.code == 2
    assert "ROS_DOMAIN_ID" in ran.err
