from __future__ import annotations

from studio.robot.checks.presence import rigid_bodies
from studio.robot.values import Joint, JointType, Link, Robot

FIXED, TURNS = JointType.FIXED, JointType.CONTINUOUS


def robot(links: str, *joints: tuple[str, JointType]) -> Robot:
    return Robot(
        "r",
        {name: Link(name) for name in links},
        {ends: Joint(ends, kind, ends[0], ends[1]) for ends, kind in joints},
    )


def names(one: Robot) -> list[tuple[str, str]]:
    return [
        ("".join(link.name for link in body.links), body.mover.name if body.mover else "")
        for body in rigid_bodies(one)
    ]


def test_fixed_joints_join_and_others_part():
    one = robot("abcde", ("ab", FIXED), ("bc", TURNS), ("cd", FIXED), ("ce", FIXED))
    assert names(one) == [("ab", ""), ("cde", "bc")]


def test_each_root_has_a_body_of_its_own():
    assert names(robot("abc", ("ab", FIXED))) == [("ab", ""), ("c", "")]


def test_a_cycle_ends():
    assert names(robot("abc", ("bc", FIXED), ("cb", FIXED))) == [("a", "")]


def test_a_long_chain_of_fixed_joints_is_one_body():
    links = {str(n): Link(str(n)) for n in range(5000)}
    joints = {str(n): Joint(str(n), FIXED, str(n), str(n + 1)) for n in range(len(links) - 1)}
    (body,) = rigid_bodies(Robot("r", links, joints))
    assert len(body.links) == 5000
