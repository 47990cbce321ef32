from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import pytest

import studio.ros.client as rclpy
from studio.errors import ExtrapolationError, FrameError, UnknownFrameError
from studio.ros.client import Context, Duration, Time
from studio.ros.messages import message
from studio.tf.rotations import wxyz_from_rpy
from studio.tf2.broadcasters import StaticTransformBroadcaster, TransformBroadcaster
from studio.tf2.buffer import Buffer
from studio.tf2.buffer_interface import TypeException
from studio.tf2.geometry import do_transform_pose, do_transform_vector3, register
from studio.tf2.listener import TransformListener
from tests.support.wire import open_test_session

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.ros.client import Node

QUARTER = math.pi / 2
NEWEST = Time()


def transform(parent: str, child: str, x: float = 0.0, yaw: float = 0.0, sec: int = 0):
    made: Any = message("geometry_msgs/msg/TransformStamped")()
    made.header.frame_id, made.child_frame_id = parent, child
    made.header.stamp.sec = sec
    made.transform.translation.x = x
    turned = made.transform.rotation
    turned.w, turned.x, turned.y, turned.z = wxyz_from_rpy(0.0, 0.0, yaw)
    return made


@pytest.fixture
def buffer() -> Buffer:
    """map, a quarter turned base in it from 10 s to 12 s, and a laser fixed in front of it."""
    made = Buffer()
    made.set_transform(transform("map", "base", 2.0, QUARTER, 10), "test")
    made.set_transform(transform("map", "base", 4.0, QUARTER, 12), "test")
    made.set_transform_static(transform("base", "laser", 1.0), "test")
    return made


def test_a_chain_is_looked_up_at_a_time_and_at_the_newest(buffer: Buffer):
    found = buffer.lookup_transform("map", "laser", NEWEST)
    assert (found.header.frame_id, found.child_frame_id) == ("map", "laser")
    assert found.header.stamp.sec == 12
    moved = found.transform.translation
    assert (moved.x, moved.y) == pytest.approx((4.0, 1.0))
    between = buffer.lookup_transform("map", "laser", Time(seconds=11)).transform.translation
    assert (between.x, between.y) == pytest.approx((3.0, 1.0))


def test_what_is_not_known_is_told_by_the_exceptions_of_tf2(buffer: Buffer):
    with pytest.raises(UnknownFrameError):
        buffer.lookup_transform("map", "nope", NEWEST)
    with pytest.raises(ExtrapolationError):
        buffer.lookup_transform("map", "base", Time(seconds=99))
    assert buffer.can_transform("map", "laser", NEWEST)
    assert not buffer.can_transform("map", "nope", NEWEST, Duration(seconds=0.05))
    can, why = buffer.can_transform("map", "nope", NEWEST, return_debug_tuple=True)
    assert (can, "nope" in why) == (False, True)


def test_two_times_are_joined_by_a_frame_that_stands_still(buffer: Buffer):
    found = buffer.lookup_transform_full(
        "base", Time(seconds=12), "base", Time(seconds=10), "map"
    ).transform.translation
    assert (found.x, found.y) == pytest.approx((0.0, 2.0))
    assert buffer.can_transform_full("base", Time(seconds=12), "base", Time(seconds=10), "map")


def test_messages_are_transformed_once_they_are_registered(buffer: Buffer):
    register()
    point: Any = message("geometry_msgs/msg/PointStamped")()
    point.header.frame_id, point.point.x = "laser", 1.0
    found = buffer.transform(point, "map")
    assert (found.point.x, found.point.y) == pytest.approx((4.0, 2.0))
    assert (found.header.frame_id, point.point.x) == ("map", 1.0)
    pose: Any = message("geometry_msgs/msg/PoseStamped")()
    pose.header.frame_id = "laser"
    turned = buffer.transform(pose, "map").pose.orientation
    assert (turned.z, turned.w) == pytest.approx((math.sin(QUARTER / 2), math.cos(QUARTER / 2)))
    with pytest.raises(TypeException, match="Twist"):
        buffer.transform(message("geometry_msgs/msg/TwistStamped")(), "map")


def test_covariances_turn_with_their_poses(buffer: Buffer):
    register()
    pose: Any = message("geometry_msgs/msg/PoseWithCovarianceStamped")()
    pose.header.frame_id = "base"
    pose.pose.covariance[0] = 4.0
    found = buffer.transform(pose, "map").pose.covariance
    assert (found[0], found[7]) == pytest.approx((0.0, 4.0))


def test_vectors_are_turned_and_not_moved():
    vector: Any = message("geometry_msgs/msg/Vector3Stamped")()
    vector.vector.x = 1.0
    found = do_transform_vector3(vector, transform("a", "b", 5.0, QUARTER)).vector
    assert (found.x, found.y) == pytest.approx((0.0, 1.0))
    plain: Any = message("geometry_msgs/msg/Pose")()
    assert do_transform_pose(plain, transform("a", "b", 5.0)).position.x == 5.0


def test_a_wait_ends_when_the_transform_comes(buffer: Buffer):
    future = buffer.wait_for_transform_async("laser", "camera", NEWEST)
    assert not future.done()
    buffer.set_transform_static(transform("laser", "camera"), "test")
    assert future.result()
    assert "camera" in buffer.all_frames_as_string()
    assert "parent: base" in buffer.all_frames_as_yaml()


@pytest.fixture
def node(endpoint: str) -> Iterator[Node]:
    context = Context.over(open_test_session(endpoint), owns_wire=True)
    yield rclpy.Node("tf2_test", context=context)
    context.shutdown()


def test_a_listener_hears_broadcasters(node: Node):
    buffer = Buffer(node=node)
    listener = TransformListener(buffer, node)
    StaticTransformBroadcaster(node).sendTransform(transform("base", "laser", 1.0))
    TransformBroadcaster(node).sendTransform([transform("map", "base", 2.0, sec=5)])
    future = buffer.wait_for_transform_async("map", "laser", NEWEST)
    rclpy.spin_until_future_complete(node, future, timeout_sec=20.0)
    assert buffer.lookup_transform("map", "laser", NEWEST).transform.translation.x == 3.0
    listener.unregister()
    with pytest.raises(FrameError):
        buffer.lookup_transform("map", "nope", NEWEST)
