from __future__ import annotations

import io
import math
import time
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.robot.kinematics import Kinematics, floating_motion
from studio.robot.values import Joint, JointType, Limit, Link, Mimic, Origin, Robot
from tests.support.expanded import assembled, expanded_robots
from tests.support.yourdfpy_poses import poses_by_yourdfpy

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from numpy.typing import NDArray

    from studio.robot.values import Vector3

REVOLUTE, CONTINUOUS, PRISMATIC = JointType.REVOLUTE, JointType.CONTINUOUS, JointType.PRISMATIC
Z = (0.0, 0.0, 1.0)


def chain(*joints: Joint) -> Robot:
    """Links named after the joints' parents and children."""
    names = dict.fromkeys(name for joint in joints for name in (joint.parent, joint.child))
    return Robot("r", {name: Link(name) for name in names}, {one.name: one for one in joints})


def single(kind: JointType, **fields: object) -> Kinematics:
    return Kinematics(chain(Joint("j", kind, "a", "b", **fields)))  # type: ignore[arg-type]


def pose_of(kinematics: Kinematics, link: str, **positions: float) -> NDArray[np.float64]:
    world_from_links = kinematics.world_from_links(kinematics.positions_with_mimic(positions))
    return world_from_links[kinematics.link_names.index(link)]


def test_a_revolute_joint_turns_about_its_axis_at_its_origin():
    kinematics = single(REVOLUTE, origin=Origin((1, 2, 3)), axis=Z)
    c, s = math.cos(0.3), math.sin(0.3)
    expected = [[c, -s, 0, 1], [s, c, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]]
    np.testing.assert_allclose(pose_of(kinematics, "b", j=0.3), expected, atol=1e-12)


def test_a_prismatic_joint_slides_along_its_turned_axis():
    kinematics = single(PRISMATIC, origin=Origin((0, 0, 1), (0, 0, math.pi / 2)))
    np.testing.assert_allclose(pose_of(kinematics, "b", j=2)[:3, 3], [0, 2, 1], atol=1e-12)


finite = st.floats(-3, 3, allow_nan=False)


@given(
    st.tuples(finite, finite, finite),
    st.tuples(finite, finite, finite),
    st.tuples(finite, finite, finite),
    finite,
    st.sampled_from(["turn", "slide", "hold", "follow"]),
)
def test_refitted_kinematics_are_those_of_the_robot_with_other_numbers(
    xyz: Vector3, rpy: Vector3, axis: Vector3, limit: float, name: str
):
    before = chain(
        Joint("turn", REVOLUTE, "a", "b", Origin((1, 0, 0)), Z, Limit(-1, 1)),
        Joint("slide", PRISMATIC, "b", "c", limit=Limit(0, 1)),
        Joint("hold", JointType.FIXED, "c", "d", Origin((0, 0, 1))),
        Joint("follow", CONTINUOUS, "d", "e", axis=Z, mimic=Mimic("turn", 2.0, 0.1)),
    )
    old = before.joints[name]
    new = replace(
        old,
        origin=Origin(xyz, rpy),
        axis=axis,
        limit=Limit(-abs(limit), abs(limit)),
        mimic=old.mimic and Mimic("turn", limit, 0.3),
    )
    moved = replace(old, origin=Origin(xyz, old.origin.rpy))
    for joint in (moved, new):
        after = replace(before, joints={**before.joints, name: joint})
        _check_refitted(Kinematics(before), after, name)


def _check_refitted(kinematics: Kinematics, after: Robot, name: str) -> None:
    fresh = Kinematics(after)
    at = fresh.random_positions(np.random.default_rng(0))
    kinematics.wxyz_xyz(at)  # what it remembers of these is no longer so
    refitted = kinematics.refitted(after, [name])
    np.testing.assert_array_equal(refitted.random_positions(np.random.default_rng(0)), at)
    np.testing.assert_array_equal(refitted.wxyz_xyz(at), fresh.wxyz_xyz(at))
    np.testing.assert_array_equal(refitted.axes, fresh.axes)
    assert (refitted.lower.tolist(), refitted.upper.tolist()) == (
        fresh.lower.tolist(),
        fresh.upper.tolist(),
    )


def test_kinematics_refitted_to_joints_that_only_moved_are_those_of_the_robot():
    here = Joint("turn", REVOLUTE, "a", "b", Origin((1, 0, 0), (0.1, 0.2, 0.3)), Z, Limit(-1, 1))
    there = replace(here, origin=Origin((0, 2, 0), here.origin.rpy))
    turned = replace(there, axis=(1.0, 0.0, 0.0), limit=Limit(-2, 1))
    kinematics = Kinematics(chain(here))
    for joint in (there, turned, here):
        fresh = Kinematics(chain(joint))
        refitted = kinematics.refitted(chain(joint), ["turn"])
        assert refitted.reaches_as(kinematics) is (joint is there)
        np.testing.assert_array_equal(
            refitted.wxyz_xyz(np.array([0.5])), fresh.wxyz_xyz(np.array([0.5]))
        )
        kinematics = refitted


def test_refitted_kinematics_leave_the_old_ones_as_they_were():
    robot = chain(Joint("j", REVOLUTE, "a", "b", limit=Limit(-1, 1)))
    kinematics = Kinematics(robot)
    moved = replace(robot.joints["j"], origin=Origin((5, 0, 0)), limit=Limit(-2, 2))
    kinematics.refitted(replace(robot, joints={"j": moved}), ["j"])
    assert pose_of(kinematics, "b")[:3, 3].tolist() == [0, 0, 0]
    assert kinematics.upper.tolist() == [1]


def test_roll_pitch_and_yaw_are_about_fixed_axes():
    kinematics = single(JointType.FIXED, origin=Origin((0, 0, 0), (math.pi / 2, 0, math.pi / 2)))
    turned = pose_of(kinematics, "b")[:3, :3] @ [0, 1, 0]
    np.testing.assert_allclose(turned, [0, 0, 1], atol=1e-12)


def test_an_axis_is_normalised():
    one, three = (single(PRISMATIC, axis=(0.0, 0.0, length)) for length in (1.0, 3.0))
    np.testing.assert_allclose(pose_of(three, "b", j=1), pose_of(one, "b", j=1))


@pytest.mark.parametrize("kind", [REVOLUTE, CONTINUOUS, PRISMATIC])
def test_a_zero_axis_moves_nothing(kind: JointType):
    np.testing.assert_array_equal(pose_of(single(kind, axis=(0.0, 0.0, 0.0)), "b", j=1), np.eye(4))


@pytest.mark.parametrize("kind", [JointType.FIXED, JointType.PLANAR, JointType.FLOATING])
def test_fixed_planar_and_floating_joints_stand_at_their_origin(kind: JointType):
    kinematics = single(kind, origin=Origin((1, 0, 0)))
    assert kinematics.movable == ()
    np.testing.assert_array_equal(pose_of(kinematics, "b")[:3, 3], [1, 0, 0])


def test_a_robot_of_one_link_stands_at_the_origin():
    kinematics = Kinematics(Robot("r", {"a": Link("a")}))
    np.testing.assert_array_equal(pose_of(kinematics, "a"), np.eye(4))
    assert kinematics.wxyz_xyz(np.zeros(0)).tolist() == [[1, 0, 0, 0, 0, 0, 0]]


def test_a_robot_of_nothing_has_no_poses():
    assert Kinematics(Robot("r")).world_from_links(np.zeros(0)).shape == (0, 4, 4)


def test_the_order_of_links_does_not_matter():
    robot = chain(
        Joint("far", PRISMATIC, "b", "c", axis=Z),
        Joint("near", PRISMATIC, "a", "b", axis=Z),
    )
    assert pose_of(Kinematics(robot), "c", far=1, near=2)[2, 3] == 3


@given(st.integers(1, 40))
def test_a_chain_of_any_length_adds_up(length: int):
    joints = [Joint(f"j{n}", PRISMATIC, f"l{n}", f"l{n + 1}", axis=Z) for n in range(length)]
    kinematics = Kinematics(chain(*joints))
    reached = pose_of(kinematics, f"l{length}", **{joint.name: 1.0 for joint in joints})
    assert reached[2, 3] == length


def test_several_roots_all_stand_at_the_origin():
    robot = Robot("r", {"a": Link("a"), "b": Link("b")})
    world_from_links = Kinematics(robot).world_from_links(np.zeros(0))
    np.testing.assert_array_equal(world_from_links, [np.eye(4)] * 2)


def test_a_batch_is_each_pose_of_it():
    kinematics = arm()
    batch = np.random.default_rng(0).uniform(-1, 1, (5, 2, len(kinematics.movable)))
    together = kinematics.wxyz_xyz(batch)
    assert together.shape == (5, 2, 4, 7)
    np.testing.assert_allclose(together[3, 1], kinematics.wxyz_xyz(batch[3, 1]), atol=1e-12)


def arm() -> Kinematics:
    """A limited turn, a slide in [0.1, 0.3], and a wheel."""
    return Kinematics(
        chain(
            Joint("turn", REVOLUTE, "a", "b", limit=Limit(-1, 2)),
            Joint("slide", PRISMATIC, "b", "c", limit=Limit(0.1, 0.3)),
            Joint("wheel", CONTINUOUS, "c", "d"),
        )
    )


def follower(name: str, leader: str, multiplier: float, offset: float, at: str) -> Joint:
    mimic = Mimic(leader, multiplier, offset)
    return Joint(name, PRISMATIC, "a", at, axis=Z, mimic=mimic)


def test_followers_of_followers_add_up_their_multipliers_and_offsets():
    kinematics = Kinematics(
        chain(
            follower("third", "second", -1, 0.5, "d"),
            follower("second", "first", 2, 1, "c"),
            Joint("first", PRISMATIC, "a", "b", axis=Z),
        )
    )
    assert kinematics.free == ("first",)
    assert kinematics.movable == ("third", "second", "first")
    assert kinematics.positions_with_mimic({"first": 3}).tolist() == [-6.5, 7, 3]
    assert kinematics.positions_with_mimic(np.array([3.0])).tolist() == [-6.5, 7, 3]


def test_a_follower_of_a_fixed_joint_stands_at_its_offset():
    robot = chain(
        Joint("weld", JointType.FIXED, "a", "b"), follower("follow", "weld", 5, 0.25, "c")
    )
    assert Kinematics(robot).positions_with_mimic({}).tolist() == [0.25]


def test_positions_of_followers_and_strangers_are_not_taken():
    kinematics = Kinematics(
        chain(Joint("lead", PRISMATIC, "a", "b"), follower("follow", "lead", 1, 0, "c"))
    )
    assert kinematics.positions_with_mimic({"follow": 9, "nobody": 9}).tolist() == [0, 0]


@pytest.mark.parametrize(("value", "clamped"), [(9, 2), (-9, -1), (0.5, 0.5)])
def test_a_position_is_clamped_to_the_limits(value: float, clamped: float):
    assert arm().clamp("turn", value) == clamped


def test_a_wheel_and_upside_down_limits_are_not_clamped():
    assert arm().clamp("wheel", 99) == 99
    assert single(REVOLUTE, limit=Limit(1, -1)).clamp("j", 99) == 99


def test_a_position_that_is_no_number_is_refused():
    with pytest.raises(ValueError, match="not a finite number"):
        arm().clamp("turn", math.nan)


def test_zero_is_the_nearest_position_within_the_limits():
    assert arm().zero_positions().tolist() == [0, 0.1, 0]


def test_random_positions_keep_the_limits_and_move_the_wheel():
    kinematics, rng = arm(), np.random.default_rng(0)
    thrown = np.array([kinematics.random_positions(rng) for _ in range(200)])
    assert (thrown >= [-1, 0.1, -math.pi]).all()
    assert (thrown <= [2, 0.3, math.pi]).all()
    assert thrown.std(axis=0).min() > 0.05


def test_a_swing_begins_where_the_joints_are():
    kinematics = arm()
    start = np.array([0.7, 0.2, -1.0])
    np.testing.assert_allclose(kinematics.swing(0.0, start), start, atol=1e-12)
    np.testing.assert_allclose(kinematics.swing(0.0), kinematics.zero_positions(), atol=1e-12)


def test_a_swing_reaches_both_limits_without_a_jump():
    kinematics = arm()
    swung = np.array([kinematics.swing(t) for t in np.linspace(0, 8, 2001)])
    np.testing.assert_allclose(swung[:, :2].min(axis=0), [-1, 0.1], atol=1e-4)
    np.testing.assert_allclose(swung[:, :2].max(axis=0), [2, 0.3], atol=1e-4)
    steps = np.abs(np.diff(swung, axis=0))
    turned = np.minimum(steps[:, 2], 2 * math.pi - steps[:, 2])
    assert steps[:, :2].max() < 0.02
    assert turned.max() < 0.02


def test_a_floating_motion_is_the_written_out_matrix():
    half = 0.35
    motion = floating_motion(
        np.array([1.0, 2, 3]), 5 * np.array([math.cos(half), 0, 0, math.sin(half)])
    )
    c, s = math.cos(0.7), math.sin(0.7)
    np.testing.assert_allclose(
        motion, [[c, -s, 0, 1], [s, c, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]], atol=1e-12
    )


@pytest.mark.corpus
def test_every_real_robot_stands_as_yourdfpy_puts_it(corpus: Path):
    compared = 0
    for robot in expanded_robots(corpus):
        change = assembled(robot.urdf)
        if change.kept_last_good:
            continue
        kinematics = Kinematics(change.robot)
        positions = kinematics.random_positions(np.random.default_rng(compared))
        by_name = dict(zip(kinematics.movable, positions.tolist(), strict=True))
        theirs = poses_by_yourdfpy(io.BytesIO(robot.urdf.encode()), by_name)
        if theirs is None:
            continue
        ours = dict(zip(kinematics.link_names, kinematics.world_from_links(positions), strict=True))
        assert ours.keys() == theirs.keys(), robot.file
        difference = max(float(np.abs(ours[link] - theirs[link]).max()) for link in ours)
        assert difference < 1e-9, f"{robot.file}: {difference}"
        compared += 1
    assert compared > 50


def test_sixty_links_take_a_fraction_of_a_frame(record_property: Callable[[str, object], None]):
    joints = [Joint(f"j{n}", REVOLUTE, f"l{n}", f"l{n + 1}") for n in range(60)]
    kinematics = Kinematics(chain(*joints))
    positions = kinematics.zero_positions()
    start = time.thread_time()
    for _ in range(200):
        kinematics.wxyz_xyz(positions)
    took_ms = (time.thread_time() - start) / 200 * 1e3
    record_property("wxyz_xyz_60_links_ms", took_ms)
    assert took_ms < 16
