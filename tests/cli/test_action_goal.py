from __future__ import annotations

import signal
from typing import TYPE_CHECKING

import pytest

from tests.support.command_line import comes_to, started, studio
from tests.support.demos import running_demo
from tests.support.wire import wait_until

if TYPE_CHECKING:
    from collections.abc import Generator

KIND = "turtlesim/action/RotateAbsolute"
NAME = "/turtle1/rotate_absolute"


@pytest.fixture(scope="module", autouse=True)
def turtles(endpoint: str) -> Generator[None]:
    with running_demo(endpoint, "turtlesim_node") as process:
        process.wait_for("Spawning turtle")
        wait_until(
            "the action", lambda: NAME in studio("action", "list", "--connect", endpoint).out
        )
        yield


def test_a1_a_goal_is_sent_with_feedback_and_its_result(endpoint: str):
    words = ("action", "send_goal", NAME, KIND, "{theta: 0.5}", "--feedback")
    ran = studio(*words, "--connect", endpoint)
    assert ran.code == 0
    assert ran.out.startswith(
        "Waiting for an action server to become available...\nSending goal:\n     theta: 0.5\n\n"
        "Goal accepted with ID: "
    )
    assert "Feedback:\n    remaining: " in ran.out
    assert "Result:\n    delta: " in ran.out
    assert ran.out.endswith("Goal finished with status: SUCCEEDED\n")


def test_a2_ctrl_c_cancels_the_goal(endpoint: str):
    at = ("--connect", endpoint)
    words = ("action", "send_goal", NAME, KIND, "{theta: -3.0}", "-f", *at)
    with started(endpoint, *words) as send:
        send.wait_for("Feedback:")
        assert send.stop(signal.SIGINT) == 2
        assert send.printed.endswith("Canceling goal...\nGoal canceled.\n")
    theta = studio("topic", "echo", "/turtle1/pose", "--once", "--field", "theta", *at).out
    assert float(theta.split()[0]) > -2.9


def test_another_type_than_the_action_has_is_said(endpoint: str):
    words = ("action", "send_goal", NAME, "radio_station_interfaces/action/ChooseSong", "--timeout",
             "0.2", "--connect", endpoint)  # fmt: skip
    ran = studio(*words)
    assert ran.code == 1
    assert ran.err.startswith(f"WARNING: {NAME} has the type {KIND}, not radio_station_interfaces")


def test_q1_an_action_of_another_distribution_is_said_to_be_one(endpoint: str):
    ran = studio("action", "send_goal", NAME, KIND, "--timeout", "0.2", "--distro", "humble",
                 "--connect", endpoint)  # fmt: skip
    assert ran.code != 0
    assert ran.err.startswith(f"WARNING: Others have {KIND}_SendGoal as of jazzy")


def test_actions_are_listed_and_told(endpoint: str):
    at = ("--connect", endpoint)
    assert studio("action", "list", *at).out == f"{NAME}\n"
    assert studio("action", "list", "-t", *at).out == f"{NAME} [{KIND}]\n"
    assert studio("action", "type", NAME, *at).out == f"{KIND}\n"
    told = f"Action: {NAME}\nAction clients: 0\nAction servers: 1\n    /turtlesim\n"
    comes_to(lambda ran: ran.out == told, "action", "info", NAME, *at)
    assert studio("action", "info", NAME, "-t", *at).out.endswith(f"    /turtlesim [{KIND}]\n")


def test_an_action_that_nobody_serves(endpoint: str):
    ran = studio("action", "send_goal", "/nope", KIND, "--timeout", "0.2", "--connect", endpoint)
    assert ran.code == 1
    assert "Nobody serves /nope" in ran.err
    assert studio("action", "type", "/nope", "--connect", endpoint).code == 1


@pytest.mark.parametrize("goal", ["{theta: x}", "{beta: 1}", "["])
def test_a_wrong_goal_is_one_sentence(endpoint: str, goal: str):
    ran = studio("action", "send_goal", NAME, KIND, goal, "--connect", endpoint)
    assert ran.code == 2
    assert ran.err.startswith("studio: ")
