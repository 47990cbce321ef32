import math
from collections.abc import Sequence

import numpy as np
import pytest
from numpy.testing import assert_allclose

from studio.displays.trajectory_states import Motion, States, chain_of, motion_of, thinned
from studio.errors import DisplayMessageError
from studio.ros.cdr import codec_of
from tests.support.display_messages import TYPES, encoded
from tests.support.posed import Posed, seen_arm

JOINTS = "trajectory_msgs/msg/JointTrajectory"
PLAN = "moveit_msgs/msg/DisplayTrajectory"


def decoded(type_name: str, **fields: object) -> object:
    return codec_of(TYPES.message(type_name)).decode(encoded(type_name, fields))


def points(*rows: tuple[float, Sequence[float]]) -> list[dict[str, object]]:
    return [
        {"positions": list(row), "time_from_start": {"sec": 0, "nanosec": round(at_s * 1e9)}}
        for at_s, row in rows
    ]


def test_a_trajectory_is_read_with_its_times():
    message = decoded(JOINTS, joint_names=["a", "b"], points=points((0.1, (1, 2)), (0.5, (3, 4))))
    motion = motion_of(message, "JointTrajectory")
    assert motion.names == ("a", "b")
    assert_allclose(motion.times_s, [0.1, 0.5])
    assert_allclose(motion.positions, [[1, 2], [3, 4]])


def test_a_time_that_goes_back_is_held():
    message = decoded(JOINTS, joint_names=["a"], points=points((0.5, (0,)), (0.2, (1,))))
    assert_allclose(motion_of(message, "JointTrajectory").times_s, [0.5, 0.5])


@pytest.mark.parametrize(
    ("row", "reason"), [((1.0,), "1 positions for 2"), ((math.nan, 0.0), "NaN or infinite")]
)
def test_a_trajectory_that_makes_no_sense_is_refused(row: Sequence[float], reason: str):
    message = decoded(JOINTS, joint_names=["a", "b"], points=points((0.0, row)))
    with pytest.raises(DisplayMessageError, match=reason):
        motion_of(message, "JointTrajectory")


def test_trajectories_of_a_plan_follow_each_other_and_joints_keep_what_they_had():
    message = decoded(
        PLAN,
        trajectory=[
            {"joint_trajectory": {"joint_names": ["shoulder"], "points": points((0.5, (0.2,)))}},
            {"joint_trajectory": {"joint_names": ["slide"], "points": points((0.5, (0.3,)))}},
        ],
        trajectory_start={"joint_state": {"name": ["slide"], "position": [-0.4]}},
    )
    motion = chain_of(message, "DisplayTrajectory")
    assert (motion.names, dict(motion.start)) == (("shoulder", "slide"), {"slide": -0.4})
    assert_allclose(motion.times_s, [0.5, 1.0])
    assert_allclose(motion.positions, [[0.2, math.nan], [math.nan, 0.3]])
    robot = Posed(seen_arm())
    states = States(motion, robot)
    expected = [robot.kinematics.wxyz_xyz(np.array(one)) for one in ([0.2, -0.4], [0.2, 0.3])]
    assert_allclose(states.poses_of([0, 1]), expected)


def test_a_part_without_points_does_not_set_the_time_back():
    one = {"joint_trajectory": {"joint_names": ["a"], "points": points((0.5, (1,)))}}
    message = decoded(PLAN, trajectory=[one, {}, one])
    assert_allclose(chain_of(message, "DisplayTrajectory").times_s, [0.5, 1.0])


def test_a_plan_of_too_many_states_and_joints_is_refused():
    many = {"joint_names": [f"j{at}" for at in range(5000)]}
    rests = {"points": points(*[(0.0, ())] * 3000)}
    message = decoded(PLAN, trajectory=[{"joint_trajectory": one} for one in (many, rests)])
    with pytest.raises(DisplayMessageError, match="3,000 states of 5,000 joints"):
        chain_of(message, "DisplayTrajectory")


def test_a_joint_of_six_degrees_moves_the_whole_robot():
    def transform(x: float) -> dict[str, object]:
        return {"translation": {"x": x, "y": 0.0, "z": 0.0}, "rotation": {"w": 2.0}}

    base = {
        "header": {"frame_id": "world"},
        "joint_names": ["virtual"],
        "points": [
            {"transforms": [transform(at)], "time_from_start": {"sec": at}} for at in (1, 3)
        ],
    }
    message = decoded(PLAN, trajectory=[{"multi_dof_joint_trajectory": base}])
    motion = chain_of(message, "DisplayTrajectory")
    assert motion.frame == "world"
    assert_allclose(motion.times_s, [1, 3])
    assert motion.roots is not None
    assert_allclose(motion.roots, [[1, 0, 0, 0, 1, 0, 0], [1, 0, 0, 0, 3, 0, 0]])


@pytest.mark.parametrize("size", [1e-300, 1e300])
def test_a_turn_of_the_whole_robot_may_be_of_numbers_of_any_size(size: float):
    turn = {"transforms": [{"rotation": {"w": size, "x": size}}]}
    base = {"joint_names": ["virtual"], "points": [turn]}
    message = decoded(PLAN, trajectory=[{"multi_dof_joint_trajectory": base}])
    roots = chain_of(message, "DisplayTrajectory").roots
    assert roots is not None
    assert_allclose(roots[0, :4], [0.5**0.5, 0.5**0.5, 0, 0])


def test_a_robot_that_only_moves_as_a_whole_keeps_its_joints_and_skips_points_without_a_pose():
    turn = {"transforms": [{"rotation": {"w": 1.0}}], "time_from_start": {"sec": 1}}
    base = {"joint_names": ["virtual"], "points": [turn, {"time_from_start": {"sec": 2}}, turn]}
    parts = [{"joint_trajectory": {"joint_names": ["shoulder"]},
              "multi_dof_joint_trajectory": base}] * 2  # fmt: skip
    motion = chain_of(decoded(PLAN, trajectory=parts), "DisplayTrajectory")
    assert motion.roots is not None
    assert len(motion.roots) == motion.size == 4
    assert_allclose(motion.times_s, [1, 1, 2, 2])
    robot = Posed(seen_arm())
    robot.joints.set({"shoulder": 0.2})
    expected = robot.kinematics.wxyz_xyz(np.array([0.2, 0.0]))
    assert_allclose(States(motion, robot).poses_at(3), expected)


def test_between_two_states_the_joints_are_between_their_positions():
    robot = Posed(seen_arm())
    motion = Motion(("shoulder",), np.array([0.0, 1.0]), np.array([[0.0], [1.0]]), {})
    poses = States(motion, robot).poses_at(0.25)
    assert_allclose(poses, robot.kinematics.wxyz_xyz(np.array([0.25, 0.0])))


def test_joints_that_no_message_names_stand_where_the_robot_has_them():
    robot = Posed(seen_arm())
    robot.joints.set({"slide": 0.5})
    motion = Motion(("shoulder", "tail"), np.array([0.0]), np.array([[0.1, 9.0]]), {})
    states = States(motion, robot)
    assert states.unknown == ("tail",)
    assert_allclose(states.poses_at(0), robot.kinematics.wxyz_xyz(np.array([0.1, 0.5])))


def test_of_too_many_states_the_first_and_the_last_are_kept():
    motion = Motion(("a",), np.arange(100.0), np.arange(100.0)[:, None], {})
    kept = thinned(motion, 10)
    assert kept.size == 10
    assert (kept.times_s[0], kept.times_s[-1]) == (0, 99)
