from __future__ import annotations

import pytest

from studio.problems import Severity
from studio.robot.structure import Structure
from studio.robot.values import Joint, JointType, Link, Mimic, Robot


def robot(links: str, *joints: str, **mimics: str) -> Robot:
    """Links by letter, joints by their two letters; `ab="cd"` makes joint ab follow cd."""
    return Robot(
        "r",
        {name: Link(name) for name in links},
        {
            name: Joint(
                name,
                JointType.CONTINUOUS,
                name[0],
                name[1],
                mimic=Mimic(mimics[name]) if name in mimics else None,
            )
            for name in joints
        },
    )


def found(one: Robot) -> list[tuple[str, str]]:
    return [(problem.code, key) for problem, key in Structure.of(one).findings]


def test_a_tree_has_nothing_to_say():
    structure = Structure.of(robot("abc", "ab", "ac"))
    assert not structure.findings
    assert not structure.broken


def test_a_tree_is_pruned_to_itself():
    one = robot("abc", "ab", "ac")
    assert Structure.of(one).pruned(one) is one


@pytest.mark.parametrize(
    ("one", "code", "key"),
    [
        (robot("ab", "ab", "xb"), "dangling-parent", "joint:xb"),
        (robot("ab", "ab", "bx"), "dangling-child", "joint:bx"),
        (robot("ab", "ab", "xy"), "dangling-parent", "joint:xy"),
        (robot("ab", "ab", "xy"), "dangling-child", "joint:xy"),
        (robot("abc", "ab", "ac", "cb"), "second-parent", "joint:cb"),
        (robot("abc", "ab", ab="zz"), "bad-mimic", "joint:ab"),
        (robot("ab", "ab", ab="ab"), "bad-mimic", "joint:ab"),
        (robot("abc", "ab"), "several-roots", "link:c"),
    ],
)
def test_each_fault_is_told_at_its_element_and_what_ros_rejects_is_an_error(
    one: Robot, code: str, key: str
):
    assert (code, key) in found(one)
    structure = Structure.of(one)
    assert not structure.broken
    for problem, _ in structure.findings:
        loaded = problem.code == "bad-mimic"
        assert problem.severity is (Severity.WARNING if loaded else Severity.ERROR)


def test_joints_that_hold_nothing_are_pruned():
    one = robot("abc", "ab", "ac", "cb", "bx")
    assert list(Structure.of(one).pruned(one).joints) == ["ab", "ac"]


def test_a_follower_of_nobody_moves_by_itself():
    one = robot("ab", "ab", ab="zz")
    assert Structure.of(one).pruned(one).joints["ab"].mimic is None


def test_a_round_of_mimics_is_opened_and_the_rest_still_follows():
    one = robot("abcd", "ab", "ac", "ad", ab="ac", ac="ab", ad="ab")
    pruned = Structure.of(one).pruned(one)
    followers = {name for name, joint in pruned.joints.items() if joint.mimic}
    assert len(followers) == 2
    assert "ad" in followers


@pytest.mark.parametrize(
    ("one", "loop"),
    [
        (robot("ab", "ab", "ba"), "a -> b -> a"),
        (robot("a", "aa"), "a -> a"),
        (robot("rabc", "ab", "bc", "ca"), "a -> b -> c -> a"),
    ],
)
def test_a_cycle_breaks_the_robot_and_names_its_links(one: Robot, loop: str):
    structure = Structure.of(one)
    assert structure.broken
    problem = next(problem for problem, _ in structure.findings if problem.code == "cycle")
    assert problem.severity is Severity.ERROR
    assert loop in problem.sentence


def test_two_cycles_are_two_findings():
    assert [code for code, _ in found(robot("abcd", "ab", "ba", "cd", "dc"))].count("cycle") == 2


def test_a_structure_fits_while_only_numbers_change():
    structure = Structure.of(robot("ab", "ab"))
    assert structure.fits(robot("ab", "ab"))
    assert not structure.fits(robot("abc", "ab"))
    assert not structure.fits(robot("ab", "ab", ab="ab"))
