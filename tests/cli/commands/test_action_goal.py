from __future__ import annotations

import contextlib
import io
import os
import signal
from typing import TYPE_CHECKING, Any

import pytest

from studio.cli import main
from studio.ros.messages import action as action_type
from studio.ros.messages import service
from studio.ros.node.task import Future
from studio.ros.node.work import ReentrantCallbackGroup
from tests.support.command_line import comes_to, started, studio
from tests.support.demos import node_at, running_demo
from tests.support.wire import wait_until

if TYPE_CHECKING:
    from collections.abc import Generator

    from studio.ros.node.node import Node

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
        assert "Canceling goal...\n" in send.printed
        assert send.printed.endswith("Goal canceled.\n")
    theta = studio("topic", "echo", "/turtle1/pose", "--once", "--field", "theta", *at).out
    assert float(theta.split()[0]) > -2.9


def test_beside_an_aborted_goal_stands_what_its_server_logged(endpoint: str):
    at = ("--connect", endpoint)
    with started(endpoint, "action", "send_goal", NAME, KIND, "{theta: -3.0}", "-f", *at) as send:
        send.wait_for("Feedback:")
        studio("action", "send_goal", NAME, KIND, "{theta: 0.0}", *at)
        send.wait_for("Goal finished with status: ABORTED")
        send.wait_for("meanwhile /turtlesim logged: Rotation goal received before a previous goal")


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


class HastyServer:
    """Sends feedback before it answers that it takes a goal, as rclpy's may be heard to do."""

    def __init__(self, node: Node, *, interrupts: bool) -> None:
        self.cancelled: list[bytes] = []
        self._interrupts = interrupts
        self._kind = action_type("example_interfaces/action/Fibonacci")
        cancel = service("action_msgs/srv/CancelGoal")
        for kind, name, answer in (
            (self._kind.SendGoal, "send_goal", self._accept),
            (self._kind.GetResult, "get_result", self._never),
            (cancel, "cancel_goal", self._cancel),
        ):
            node.create_service(
                kind, f"/hasty/_action/{name}", answer, callback_group=ReentrantCallbackGroup()
            )
        self._feedback = node.create_publisher(
            self._kind.FeedbackMessage, "/hasty/_action/feedback", 10
        )

    def _accept(self, request: Any, response: Any) -> Any:  # noqa: ANN401
        if self._interrupts:
            os.kill(os.getpid(), signal.SIGINT)
        said = self._kind.Feedback(sequence=[0, 1])
        self._feedback.publish(self._kind.FeedbackMessage(goal_id=request.goal_id, feedback=said))
        response.accepted = True
        return response

    async def _never(self, _request: Any, response: Any) -> Any:  # noqa: ANN401
        await Future()
        return response

    def _cancel(self, request: Any, response: Any) -> Any:  # noqa: ANN401
        self.cancelled.append(bytes(request.goal_info.goal_id.uuid))
        response.goals_canceling = [request.goal_info]
        return response


class InterruptedAt(io.StringIO):
    """Presses Ctrl-C in the midst of printing a text, once."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self._text = text

    def write(self, said: str) -> int:
        count = super().write(said)
        if self._text and self._text in said:
            self._text = ""
            signal.raise_signal(signal.SIGINT)
        return count


@pytest.mark.parametrize("moment", ["answer", "Goal accepted", "Feedback:"])
def test_ctrl_c_cancels_the_goal_at_any_moment_after_it_was_sent(endpoint: str, moment: str):
    interrupts = moment == "answer"
    printed = InterruptedAt("" if interrupts else moment)
    words = ("action", "send_goal", "/hasty", "example_interfaces/action/Fibonacci", "{order: 5}",
             "-f", "--connect", endpoint)  # fmt: skip
    with node_at(endpoint, "hasty") as node:
        server = HastyServer(node, interrupts=interrupts)
        with contextlib.redirect_stdout(printed):
            assert main(words) == 2
        assert len(server.cancelled) == 1
    assert printed.getvalue().endswith("Canceling goal...\nGoal canceled.\n")
