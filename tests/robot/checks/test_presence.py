from __future__ import annotations

from studio.problems import Severity
from tests.support.checked import box, checked, codes, inertial, joint, link, problem_of, robot

MASS = inertial(1, 0.01, 0.01, 0.01)
VISUAL, COLLISION = box("visual", "0.2 0.2 0.2"), box("collision", "0.2 0.2 0.2")
MESH = '<visual><geometry><mesh filename="m.stl"/></geometry></visual>'
BASE = link("foot"), link("base", VISUAL, COLLISION, MASS), joint("fixed", "base", parent="foot")


def with_arm(arm: str, *more: str) -> list[str]:
    return codes(robot(*BASE, arm, joint("continuous", "arm"), *more))


def test_a_robot_that_has_all_of_it_has_nothing_to_say():
    assert not with_arm(link("arm", MESH, COLLISION, MASS))


def test_a_moving_link_without_mass_is_found_and_shown_with_its_joint():
    arm = link("arm", VISUAL, COLLISION)
    assert with_arm(arm) == ["missing-inertial"]
    problem = problem_of(checked(robot(*BASE, arm, joint("continuous", "arm"))), "missing-inertial")
    assert problem.severity is Severity.WARNING
    assert problem.parts == ("link:arm", "joint:arm")


def test_a_frame_a_fixed_leaf_and_a_body_with_one_mass_are_fine():
    assert not with_arm(link("arm"))
    assert not with_arm(
        link("arm"), link("tool", VISUAL, COLLISION, MASS), joint("fixed", "tool", parent="arm")
    )
    assert not with_arm(
        link("arm", MASS), link("tool", VISUAL, COLLISION), joint("fixed", "tool", parent="arm")
    )


def test_what_hangs_on_a_fixed_joint_of_a_moving_frame_moves():
    tool = link("tool", VISUAL, COLLISION), joint("fixed", "tool", parent="arm")
    assert with_arm(link("arm"), *tool) == ["missing-inertial"]


def test_a_link_with_a_mass_of_zero_is_not_told_twice():
    assert with_arm(link("arm", VISUAL, COLLISION, inertial(0, 0, 0, 0))) == ["bad-mass"]


def test_a_moving_mesh_without_collision_is_found_and_a_shape_is_not():
    assert with_arm(link("arm", MESH, MASS)) == ["missing-collision"]
    assert not with_arm(link("arm", VISUAL, MASS))


def test_a_robot_without_any_mass_or_collision_is_told_so_once():
    arms = [link(name, MESH) for name in "abc"]
    one = robot(link("base", VISUAL), *arms, *(joint("continuous", name) for name in "abc"))
    assert codes(one) == ["no-inertials", "no-collisions"]
    assert problem_of(checked(one), "no-inertials").place is None


def test_frames_alone_lack_nothing():
    assert not codes(robot(link("base"), link("arm"), joint("continuous", "arm")))


def test_a_root_link_with_a_mass_is_what_kdl_warns_about():
    one = robot(link("base", VISUAL, COLLISION, MASS))
    assert codes(one) == ["root-inertial"]
    assert problem_of(checked(one), "root-inertial").severity is Severity.INFO
