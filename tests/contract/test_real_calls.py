"""Our services, parameters, actions and managed nodes beside those of a real ROS 2."""

from __future__ import annotations

import re
import signal
from typing import TYPE_CHECKING, Any

import pytest

from studio.ros.action.client import ActionClient
from studio.ros.action.protocol import GoalStatus
from studio.ros.action.server import ActionServer, CancelResponse, GoalResponse
from studio.ros.lifecycle.client import LifecycleClient
from studio.ros.messages import action, message, service
from studio.ros.node.task import Future
from studio.ros.node.work import ReentrantCallbackGroup
from studio.ros.parameter_client import ParameterClient
from studio.ros.parameters.parameter import Parameter
from tests.support.command_line import started, studio
from tests.support.demos import call, heard, node_at
from tests.support.ros2_peer import RealNode, RealNodes, real_node, real_nodes, ros2
from tests.support.wire import wait_until

if TYPE_CHECKING:
    from collections.abc import Generator

    from studio.ros.node.node import Node

pytestmark = pytest.mark.network
ADD = "example_interfaces/srv/AddTwoInts"
FIBONACCI = "example_interfaces/action/Fibonacci"
SERVER = "/peer_server"


@pytest.fixture(scope="module")
def server(endpoint: str) -> Generator[RealNode]:
    with real_node(endpoint, "server", "--step", "0.05") as process:
        try:
            yield process
        finally:
            process.kill()


@pytest.fixture(scope="module")
def real(endpoint: str, server: RealNode) -> Generator[RealNodes]:
    with real_nodes(endpoint) as nodes:
        server.wait_said("ready")
        yield nodes


@pytest.fixture(scope="module")
def node(endpoint: str, real: RealNodes) -> Generator[Node]:
    """Ours, which serves what the real server does, under other names."""
    del real
    with node_at(endpoint, "ours") as found:
        yield found


def test_a_real_service_answers_us(node: Node):
    assert call(node, ADD, "/add_two_ints", a=2**40, b=-1).sum == 2**40 - 1


def test_a_real_client_is_answered_by_us(real: RealNodes, node: Node):
    def add(request: Any, response: Any) -> Any:  # noqa: ANN401
        response.sum = request.a + request.b
        return response

    node.create_service(service(ADD), "/we_add", add)
    assert real.ask("call", service="/we_add", a=-5, b=2**33) == 2**33 - 5


def test_parameters_of_a_real_node_are_read_set_and_described(node: Node):
    with ParameterClient(node, SERVER) as client:
        assert {"speed", "ranged", "fixed", "list"} <= set(client.names())
        results = client.set(
            [
                Parameter("speed", value=2.5),
                Parameter("ranged", value=50),
                Parameter("ratio", value=1.5),
                Parameter("fixed", value="other"),
                Parameter("name", value="bad"),
            ]
        )
        assert [one.successful for one in results] == [True, False, False, False, False]
        assert results[4].reason == "bad is bad"
        told = {one.name: one.value for one in client.get(["speed", "ranged", "fixed"])}
        assert told == {"speed": 2.5, "ranged": 5, "fixed": "read-only"}
        [ranged] = client.describe(["ranged"])
        assert (ranged.description, ranged.integer_range[0].to_value) == ("one to ten", 10)


def test_parameters_of_ours_refuse_what_a_real_node_refuses_in_the_same_words(
    real: RealNodes, node: Node
):
    descriptor = message("rcl_interfaces/msg/ParameterDescriptor")
    integers = message("rcl_interfaces/msg/IntegerRange")
    doubles = message("rcl_interfaces/msg/FloatingPointRange")
    whole = integers(from_value=1, to_value=10, step=1)
    part = doubles(from_value=0.0, to_value=1.0)
    node.declare_parameter("speed", 1.5)
    node.declare_parameter("list", [1, 2, 3])
    node.declare_parameter("ranged", 5, descriptor(integer_range=[whole]))
    node.declare_parameter("ratio", 0.5, descriptor(floating_point_range=[part]))
    values = {"ranged": 50, "ratio": 1.5, "speed": 3.5}
    names = ["speed", "ranged", "list"]
    ours = real.ask("parameters", node="/ours", values=values, names=names)
    theirs = real.ask("parameters", node=SERVER, values=values, names=names)
    assert ours["reasons"] == theirs["reasons"]
    assert ours["reasons"]["ranged"] == "Parameter ranged out of range. Min: 1, Max: 10, value: 50"
    assert ours["values"] == theirs["values"] == [3.5, 5, [1, 2, 3]]


@pytest.mark.parametrize(
    ("order", "status"), [(5, GoalStatus.SUCCEEDED), (13, GoalStatus.ABORTED), (99, None)]
)
def test_goals_of_ours_succeed_abort_and_are_rejected_by_a_real_server(
    node: Node, order: int, status: GoalStatus | None
):
    client = ActionClient(node, action(FIBONACCI), "/fibonacci")
    assert client.wait_for_server(60)
    feedback: list[Any] = []
    ended = client.send_goal(action(FIBONACCI).Goal(order=order), feedback_callback=feedback.append)
    if ended is None:
        assert status is None
        return
    assert ended.status == status
    if status is GoalStatus.SUCCEEDED:
        assert list(ended.result.sequence) == [0, 1, 1, 2, 3, 5]
    wait_until("all feedback came", lambda: len(feedback) == order - 1)


def test_a_real_client_has_goals_of_ours_succeed_abort_rejected_and_cancelled(
    real: RealNodes, node: Node
):
    fibonacci_at(node, "/our_fibonacci")

    def goal(order: int, *, cancels: bool = False) -> Any:  # noqa: ANN401
        return real.ask("goal", action="/our_fibonacci", order=order, cancels=cancels)

    succeeded = goal(5)
    assert (succeeded["status"], succeeded["sequence"]) == ("succeeded", [0, 1, 1, 2, 3, 5])
    assert goal(13)["status"] == "aborted"
    assert goal(99) == {"accepted": False}
    cancelled = goal(40, cancels=True)
    assert (cancelled["status"], cancelled["code"]) == ("canceled", 0)


def fibonacci_at(node: Node, name: str) -> None:
    """Serve as the real server does: above 50 is rejected, 13 aborted."""
    kind = action(FIBONACCI)
    tick = 0.05

    async def run(goal: Any) -> Any:  # noqa: ANN401
        sequence = [0, 1]
        while len(sequence) <= goal.request.order:
            sequence.append(sequence[-1] + sequence[-2])
            goal.publish_feedback(kind.Feedback(sequence=sequence))
            await pause(node, tick)
            if goal.is_cancel_requested:
                goal.canceled()
                return kind.Result(sequence=sequence)
        if goal.request.order == 13:
            goal.abort()
        else:
            goal.succeed()
        return kind.Result(sequence=sequence)

    def judge(goal: Any) -> GoalResponse:  # noqa: ANN401
        return GoalResponse.ACCEPT if goal.order <= 50 else GoalResponse.REJECT

    ActionServer(
        node, kind, name, run,
        callback_group=ReentrantCallbackGroup(),
        goal_callback=judge,
        cancel_callback=lambda _: CancelResponse.ACCEPT,
    )  # fmt: skip


async def pause(node: Node, seconds: float) -> None:
    """Let others work for a while."""
    over: Future[None] = Future(executor=node.executor)
    timer = node.create_timer(
        seconds, lambda: over.set_result(None), callback_group=ReentrantCallbackGroup()
    )
    await over
    node.destroy_timer(timer)


@pytest.mark.parametrize("attempt", range(3))
def test_ctrl_c_at_the_first_feedback_cancels_the_goal_of_a_real_server(
    endpoint: str, server: RealNode, node: Node, attempt: int
):
    del node
    order = 40 + attempt
    words = ("action", "send_goal", "/fibonacci", FIBONACCI, f"{{order: {order}}}", "-f")
    with started(endpoint, *words) as send:
        send.wait_for("Feedback:")
        assert send.stop(signal.SIGINT) == 2
        assert send.printed.endswith("Goal canceled.\n")
    server.wait_said("goal_end", order=order, status="canceled")


def test_a_real_managed_node_is_led_through_its_states(real: RealNodes, node: Node):
    real.ask("managed", name="led")
    events = heard(node, "lifecycle_msgs/msg/TransitionEvent", "/led/transition_event")
    with LifecycleClient(node, "/led") as led:
        assert led.state().label == "unconfigured"
        assert {one.transition.label for one in led.available_transitions()} >= {"configure"}
        assert led.change("configure")
        assert led.change("activate")
        assert led.state().label == "active"
        assert not led.change("configure")
        assert led.change("deactivate")
        assert not led.change("cleanup")
        assert led.state().label == "inactive"
        assert led.change("shutdown")
        assert led.state().label == "finalized"
    wait_until("its changes come", lambda: len(events) > 5)
    names = [said["name"] for said in real.all_said("transition")]
    assert names == ["configure", "activate", "cleanup"]


def test_the_command_lines_of_both_say_the_same_of_a_goal(endpoint: str, node: Node):
    fibonacci_at(node, "/for_both")
    words = ("action", "send_goal", "/for_both", FIBONACCI, "{order: 3}")
    theirs = without_id(ros2(endpoint, *words))
    assert "Goal finished with status: SUCCEEDED" in theirs
    assert without_id(studio(*words, "--connect", endpoint).out) == theirs


def without_id(said: str) -> str:
    return re.sub(r"ID: [0-9a-f]{32}", "ID", said)
