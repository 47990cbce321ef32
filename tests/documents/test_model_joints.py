import struct

import numpy as np
import pytest

from studio.documents.model import JOINTS_FRAME_KIND, JointPositions
from studio.robot.kinematics import Kinematics
from studio.robot.values import Joint, JointType, Limit, Link, Mimic, Robot


def robot(*joints: Joint) -> Robot:
    names = ["base", *(joint.child for joint in joints)]
    return Robot("r", {name: Link(name) for name in names}, {joint.name: joint for joint in joints})


def hinge(name: str, parent: str, child: str, lower: float = -1.0, upper: float = 1.0) -> Joint:
    return Joint(name, JointType.REVOLUTE, parent, child, limit=Limit(lower, upper))


SHOULDER = hinge("shoulder", "base", "upper")
ELBOW = hinge("elbow", "upper", "lower", 0.5, 2.0)
FOLLOWER = Joint(
    "follower", JointType.CONTINUOUS, "base", "gear", mimic=Mimic("shoulder", 2.0, 0.1)
)


def test_joints_begin_at_zero_or_at_the_nearest_limit():
    joints = JointPositions(Kinematics(robot(SHOULDER, ELBOW)))
    assert joints.by_name() == {"shoulder": 0.0, "elbow": 0.5}


def test_a_position_is_clamped_and_followers_follow():
    joints = JointPositions(Kinematics(robot(SHOULDER, FOLLOWER)))
    joints.set({"shoulder": 7.0, "follower": 3.0, "unknown": 1.0})
    assert joints.by_name() == {"shoulder": 1.0, "follower": pytest.approx(2.1)}


def test_a_position_that_is_no_number_moves_nothing():
    joints = JointPositions(Kinematics(robot(SHOULDER)))
    joints.set({"shoulder": float("nan")})
    assert joints.by_name() == {"shoulder": 0.0}


def test_a_robot_that_runs_is_shown_where_it_is_beyond_its_limits_too():
    joints = JointPositions(Kinematics(robot(SHOULDER, FOLLOWER)))
    joints.follow({"shoulder": 1.25, "unknown": 1.0})
    assert joints.by_name() == {"shoulder": 1.25, "follower": pytest.approx(2.6)}


@pytest.mark.parametrize("position", [float("nan"), float("inf"), -1e300])
def test_a_robot_that_says_it_is_nowhere_moves_nothing(position: float):
    joints = JointPositions(Kinematics(robot(SHOULDER)))
    joints.follow({"shoulder": position})
    assert joints.by_name() == {"shoulder": 0.0}


def test_positions_survive_a_new_model_by_name_within_its_limits():
    joints = JointPositions(Kinematics(robot(SHOULDER, ELBOW)))
    joints.set({"shoulder": 0.9, "elbow": 1.5})
    joints.adopt(Kinematics(robot(hinge("shoulder", "base", "upper", -0.5, 0.5))))
    assert joints.by_name() == {"shoulder": 0.5}
    joints.adopt(Kinematics(robot(SHOULDER, ELBOW)))
    assert joints.by_name()["elbow"] == 1.5


def test_a_frame_carries_its_kind_the_revision_and_every_position():
    joints = JointPositions(Kinematics(robot(SHOULDER, ELBOW)))
    joints.set({"shoulder": 0.25})
    frame = joints.frame(7)
    assert struct.unpack_from("<BxxxI", frame) == (JOINTS_FRAME_KIND, 7)
    assert np.frombuffer(frame, "<f8", offset=8).tolist() == [0.25, 0.5]


def test_a_swing_begins_where_the_joints_are():
    joints = JointPositions(Kinematics(robot(SHOULDER)))
    joints.set({"shoulder": 0.4})
    start = joints.values
    joints.swing(0.0, start)
    assert joints.by_name()["shoulder"] == pytest.approx(0.4)
    joints.swing(0.5, start)
    assert joints.by_name()["shoulder"] != pytest.approx(0.4)
