"""The course's rows on turtlesim: N10's node half, T2, SV4, P1 and its action."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import pytest

from studio.ros.action import ActionClient, GoalStatus
from studio.ros.client import Node, action, message
from studio.ros.types.convert import from_yaml
from tests.support.demos import call, heard, node_at, running_demo
from tests.support.wire import PATIENCE_S, wait_until

if TYPE_CHECKING:
    from collections.abc import Generator

pytestmark = pytest.mark.network
POSE, COLOR = "turtlesim/msg/Pose", "turtlesim/msg/Color"
MIDDLE = pytest.approx(5.544445, abs=1e-5)


@pytest.fixture
def node(endpoint: str) -> Generator[Node]:
    with node_at(endpoint) as made, running_demo(endpoint, "turtlesim_node"):
        yield made


def newest(messages: list[Any]) -> Any:  # noqa: ANN401
    """What comes next on a topic."""
    count = len(messages)
    wait_until("one more message", lambda: len(messages) > count)
    return messages[-1]


def publish(node: Node, type_name: str, topic: str, yaml_text: str) -> None:
    """Say it once somebody listens."""
    kind = message(type_name)
    publisher = node.create_publisher(kind, topic, 10)
    wait_until("a subscription", lambda: bool(node.graph.subscriptions(topic)))
    publisher.publish(from_yaml(kind, yaml_text))


def test_n10_one_turtle_stands_in_the_middle_and_tells_where(node: Node):
    poses, colors = heard(node, POSE, "/turtle1/pose"), heard(node, COLOR, "/turtle1/color_sensor")
    pose, color = newest(poses), newest(colors)
    assert (pose.x, pose.y, pose.theta) == (MIDDLE, MIDDLE, 0.0)
    assert (color.r, color.g, color.b) == (69, 86, 255)


def test_t2_the_courses_yaml_moves_the_turtle(node: Node):
    poses = heard(node, POSE, "/turtle1/pose")
    text = "{linear: {x: 2.0, y: 0.0, z: 0.0}, angular: {x: 0.0, y: 0.0, z: 1.8}}"
    publish(node, "geometry_msgs/msg/Twist", "/turtle1/cmd_vel", text)
    wait_until("it stands again", lambda: newest(poses).theta > 1.5)
    wait_until("it stands again", lambda: newest(poses).linear_velocity == 0.0)
    pose = newest(poses)
    radius, turned = 2.0 / 1.8, pose.theta
    assert turned == pytest.approx(1.8, abs=0.1)
    assert pose.x == pytest.approx(5.544445 + radius * math.sin(turned), abs=0.1)
    assert pose.y == pytest.approx(5.544445 + radius * (1 - math.cos(turned)), abs=0.1)


def test_sv4_a_second_turtle_appears_and_can_be_taken_away(node: Node):
    spawned = call(node, "turtlesim/srv/Spawn", "/spawn", x=2.0, y=2.0, theta=0.2, name="")
    assert spawned.name == "turtle2"
    poses = heard(node, POSE, "/turtle2/pose")
    assert (newest(poses).x, newest(poses).y) == (2.0, 2.0)
    taken = call(node, "turtlesim/srv/Spawn", "/spawn", x=1.0, y=1.0, theta=0.0, name="turtle2")
    assert taken.name == ""
    call(node, "turtlesim/srv/Kill", "/kill", name="turtle2")
    wait_until("it has left", lambda: not node.graph.publishers("/turtle2/pose"))


def test_services_of_a_turtle_teleport_it_and_change_its_pen(node: Node):
    poses, colors = heard(node, POSE, "/turtle1/pose"), heard(node, COLOR, "/turtle1/color_sensor")
    call(node, "turtlesim/srv/SetPen", "/turtle1/set_pen", r=255, g=0, b=0, width=5, off=0)
    call(node, "turtlesim/srv/TeleportAbsolute", "/turtle1/teleport_absolute", x=1.0, y=2.0)
    wait_until("it is there", lambda: (newest(poses).x, newest(poses).y) == (1.0, 2.0))
    wait_until("it stands on its line", lambda: newest(colors).r == 255)
    call(node, "turtlesim/srv/TeleportRelative", "/turtle1/teleport_relative", linear=2.0)
    wait_until("it is ahead", lambda: newest(poses).x == 3.0)
    call(node, "std_srvs/srv/Empty", "/clear")
    wait_until("the line is wiped", lambda: newest(colors).r == 69)
    call(node, "std_srvs/srv/Empty", "/reset")
    wait_until("it is in the middle", lambda: newest(poses).x == MIDDLE)


def test_p1_the_colour_of_the_ground_changes_live_and_stays_a_colour(node: Node):
    colors = heard(node, COLOR, "/turtle1/color_sensor")
    newest(colors)
    assert set_parameter(node, "background_r", 150) == (True, "")
    wait_until("the new colour", lambda: newest(colors).r == 150)
    done, reason = set_parameter(node, "background_r", 300)
    assert not done
    assert "255" in reason


def set_parameter(node: Node, name: str, value: int) -> tuple[bool, str]:
    """Set a whole number of turtlesim, as `ros2 param set` does."""
    kind = message("rcl_interfaces/msg/Parameter")
    parameter = kind(name=name)
    parameter.value.type, parameter.value.integer_value = 2, value
    service = "rcl_interfaces/srv/SetParameters"
    answer = call(node, service, "/turtlesim/set_parameters", parameters=[parameter])
    return answer.results[0].successful, answer.results[0].reason


def test_the_rotation_tells_what_remains_and_ends_at_the_heading(node: Node):
    poses = heard(node, POSE, "/turtle1/pose")
    told: list[Any] = []
    client = rotation(node)
    goal = action("turtlesim/action/RotateAbsolute").Goal(theta=0.5)
    sent = client.send_goal_async(goal, feedback_callback=lambda one: told.append(one.feedback))
    wait_until("the goal is taken", sent.done)
    ended = sent.result().get_result_async()
    wait_until("it has turned", ended.done)
    assert ended.result().status == GoalStatus.SUCCEEDED
    assert ended.result().result.delta == pytest.approx(-0.5, abs=1e-5)
    remaining = [one.remaining for one in told]
    assert remaining == sorted(remaining, reverse=True)
    assert newest(poses).theta == pytest.approx(0.5)


def test_a_rotation_ends_when_it_is_cancelled_or_a_twist_comes(node: Node):
    client = rotation(node)
    goal = action("turtlesim/action/RotateAbsolute").Goal(theta=3.0)
    first = client.send_goal_async(goal)
    wait_until("the goal is taken", first.done)
    first.result().cancel_goal_async()
    ended = first.result().get_result_async()
    wait_until("it has ended", ended.done)
    assert ended.result().status == GoalStatus.CANCELED
    second = client.send_goal_async(goal)
    wait_until("the goal is taken", second.done)
    publish(node, "geometry_msgs/msg/Twist", "/turtle1/cmd_vel", "{linear: {x: 1.0}}")
    aborted = second.result().get_result_async()
    wait_until("it has ended", aborted.done)
    assert aborted.result().status == GoalStatus.ABORTED


def test_why_a_rotation_is_aborted_is_said_in_the_log(node: Node):
    log = heard(node, "rcl_interfaces/msg/Log", "/rosout")
    client = rotation(node)
    goal = action("turtlesim/action/RotateAbsolute").Goal(theta=3.0)
    first = client.send_goal_async(goal)
    wait_until("the goal is taken", first.done)
    second = client.send_goal_async(goal)
    wait_until("the other goal is taken", second.done)
    ended = first.result().get_result_async()
    wait_until("the first has ended", ended.done)
    assert ended.result().status == GoalStatus.ABORTED
    publish(node, "geometry_msgs/msg/Twist", "/turtle1/cmd_vel", "{linear: {x: 1.0}}")
    aborted = second.result().get_result_async()
    wait_until("the second has ended", aborted.done)
    for said in (
        "Rotation goal received before a previous goal finished. Aborting previous goal",
        "Velocity command received during rotation goal. Aborting goal",
    ):
        wait_until(said, lambda said=said: said in [one.msg for one in log])


def rotation(node: Node) -> ActionClient:
    client = ActionClient(
        node, action("turtlesim/action/RotateAbsolute"), "turtle1/rotate_absolute"
    )
    assert client.wait_for_server(PATIENCE_S)
    return client
