"""What the course's listings call, with the keywords that they use: part 2a of its inventory."""

from __future__ import annotations

import inspect
from typing import TYPE_CHECKING, Any

import pytest

import studio.ros.action as rclpy_action
import studio.ros.client as rclpy
from studio.ros.messages import action, message, service
from studio.ros.node.service_client import Client
from studio.tf2.broadcasters import StaticTransformBroadcaster, TransformBroadcaster

if TYPE_CHECKING:
    from collections.abc import Callable

NODE, X = rclpy.Node, object()
CALLS: dict[str, tuple[Callable[..., Any], tuple[object, ...], tuple[str, ...]]] = {
    "rclpy.init(args=None)": (rclpy.init, (), ("args",)),
    "rclpy.spin(node)": (rclpy.spin, (X,), ()),
    "rclpy.spin(node, executor=e)": (rclpy.spin, (X,), ("executor",)),
    "rclpy.spin_once(node, timeout_sec=1)": (rclpy.spin_once, (X,), ("timeout_sec",)),
    "rclpy.spin_until_future_complete(node, future)": (
        rclpy.spin_until_future_complete, (X, X), (),
    ),
    "rclpy.create_node('n', namespace='/')": (rclpy.create_node, (X,), ("namespace",)),
    "rclpy.ok()": (rclpy.ok, (), ()),
    "rclpy.shutdown()": (rclpy.shutdown, (), ()),
    "Node('n')": (NODE, (X,), ()),
    "create_publisher(msg_type=, topic=, qos_profile=)": (
        NODE.create_publisher, (X,), ("msg_type", "topic", "qos_profile"),
    ),
    "create_publisher(String, 'chatter', 10)": (NODE.create_publisher, (X, X, X, X), ()),
    "create_subscription(msg_type=, topic=, callback=, qos_profile=)": (
        NODE.create_subscription, (X,), ("msg_type", "topic", "callback", "qos_profile"),
    ),
    "create_service(srv_type=, srv_name=, callback=)": (
        NODE.create_service, (X,), ("srv_type", "srv_name", "callback"),
    ),
    "create_client(srv_type=, srv_name=)": (NODE.create_client, (X,), ("srv_type", "srv_name")),
    "create_timer(0.5, callback)": (NODE.create_timer, (X, X, X), ()),
    "create_rate(30)": (NODE.create_rate, (X, X), ()),
    "get_logger()": (NODE.get_logger, (X,), ()),
    "get_clock()": (NODE.get_clock, (X,), ()),
    "get_name()": (NODE.get_name, (X,), ()),
    "declare_parameter('name', 1.0)": (NODE.declare_parameter, (X, X, X), ()),
    "get_parameter('name')": (NODE.get_parameter, (X, X), ()),
    "add_on_set_parameters_callback(f)": (NODE.add_on_set_parameters_callback, (X, X), ()),
    "destroy_node()": (NODE.destroy_node, (X,), ()),
    "wait_for_service(timeout_sec=1.0)": (Client.wait_for_service, (X,), ("timeout_sec",)),
    "call_async(request)": (Client.call_async, (X, X), ()),
    "QoSProfile(depth=, reliability=, durability=)": (
        rclpy.QoSProfile, (), ("depth", "reliability", "durability"),
    ),
    "ActionServer(node, type, name, execute)": (rclpy_action.ActionServer, (X, X, X, X), ()),
    "ActionServer(..., goal_callback=, cancel_callback=)": (
        rclpy_action.ActionServer, (X, X, X, X), ("goal_callback", "cancel_callback"),
    ),
    "ActionClient(node, type, name)": (rclpy_action.ActionClient, (X, X, X), ()),
    "wait_for_server(timeout_sec=)": (
        rclpy_action.ActionClient.wait_for_server, (X,), ("timeout_sec",),
    ),
    "send_goal_async(goal, feedback_callback=)": (
        rclpy_action.ActionClient.send_goal_async, (X, X), ("feedback_callback",),
    ),
    "publish_feedback(feedback)": (rclpy_action.ServerGoalHandle.publish_feedback, (X, X), ()),
    "succeed()": (rclpy_action.ServerGoalHandle.succeed, (X,), ()),
    "get_result_async()": (rclpy_action.ClientGoalHandle.get_result_async, (X,), ()),
    "cancel_goal_async()": (rclpy_action.ClientGoalHandle.cancel_goal_async, (X,), ()),
    "TransformBroadcaster(self, qos=)": (TransformBroadcaster, (X,), ("qos",)),
    "sendTransform(transform)": (
        TransformBroadcaster.sendTransform, (X, X), (),  # pyright: ignore[reportUnknownMemberType]
    ),
    "StaticTransformBroadcaster(self)": (StaticTransformBroadcaster, (X,), ()),
}  # fmt: skip


@pytest.mark.parametrize("line", CALLS)
def test_2a_what_a_listing_calls_is_there_under_its_names(line: str):
    called, given, keywords = CALLS[line]
    inspect.signature(called).bind(*given, **dict.fromkeys(keywords, X))


@pytest.mark.parametrize(
    "name",
    [
        *("Future", "QoSProfile", "ReliabilityPolicy", "DurabilityPolicy", "HistoryPolicy"),
        *("SingleThreadedExecutor", "MultiThreadedExecutor", "ExternalShutdownException"),
        *("MutuallyExclusiveCallbackGroup", "ReentrantCallbackGroup", "Parameter"),
    ],
)
def test_2a_what_a_listing_imports_is_there(name: str):
    assert hasattr(rclpy, name)


def test_2a_a_future_and_a_logger_answer_to_their_names():
    for name in ("done", "result", "exception", "cancel", "add_done_callback"):
        assert callable(getattr(rclpy.Future, name))
    for name in ("debug", "info", "warn", "warning", "error", "fatal"):
        assert callable(getattr(rclpy.get_logger("student"), name))
    for name in ("GoalResponse", "CancelResponse", "GoalStatus"):
        assert hasattr(rclpy_action, name)


@pytest.mark.parametrize(
    ("name", "fields"),
    [
        ("std_msgs/msg/String", {"data": "Hello"}),
        ("example_interfaces/msg/Int64", {"data": -2}),
        ("geometry_msgs/msg/Quaternion", {"x": 0.0, "y": 0.0, "z": 0.5, "w": 0.5}),
        ("geometry_msgs/msg/Point", {"x": 1.0, "y": -2.0}),
        ("sensor_msgs/msg/JointState", {"name": ["swivel"]}),
        ("rcl_interfaces/msg/SetParametersResult", {"successful": True, "reason": "why"}),
    ],
)
def test_2a_messages_of_the_listings_have_keyword_constructors(
    name: str, fields: dict[str, object]
):
    made = message(name)(**fields)
    assert {field: getattr(made, field) for field in fields} == fields


@pytest.mark.parametrize(
    "name",
    ["example_interfaces/srv/AddTwoInts", "learning_interface/srv/AddTwoInts",
     "radio_station_interfaces/srv/GetNowPlaying", "pkg_with_interfaces/srv/AddPoints"],
)  # fmt: skip
def test_2a_services_of_the_listings_have_their_two_halves(name: str):
    kind = service(name)
    assert kind.Request() is not None
    assert kind.Response() is not None


def test_2a_the_action_of_the_listings_has_its_three_parts():
    kind = action("radio_station_interfaces/action/ChooseSong")
    assert kind.Goal(song_name="Clocks").song_name == "Clocks"
    assert kind.Result(success=True).success
    assert kind.Feedback(progress_pct=5).progress_pct == 5
