from __future__ import annotations

import time
from itertools import pairwise

from studio.description import checks as text_checks
from studio.problems import whys
from studio.robot import checks as robot_checks
from studio.robot.checks.finding import CheckedRobot
from studio.robot.checks.robot_checks import ALIKE_AT_MOST, check_robot
from studio.robot.values import (
    Box,
    Collision,
    Inertial,
    Joint,
    JointType,
    Limit,
    Link,
    Origin,
    Robot,
    Visual,
)
from tests.support.checked import box, checked, codes, inertial, joint, link, robot
from tests.support.robots import rover


def alone(one: Robot) -> CheckedRobot:
    return CheckedRobot(one, lambda _: None, lambda _: None, lambda _: None)


def large_robot(links: int, lower: float = -1.0) -> Robot:
    """A chain of sound links, no two of one size."""
    origin = Origin()
    body = Inertial(origin, 1.0, ixx=0.002, iyy=0.002, izz=0.002)
    shapes = {f"l{n}": Box((0.1, 0.1, 0.1 + n * 1e-6)) for n in range(links)}
    return Robot(
        "r",
        {
            name: Link(name, (Visual(origin, shape),), (Collision(origin, shape),), body)
            for name, shape in shapes.items()
        },
        {
            n: Joint(n, JointType.REVOLUTE, before, n, limit=Limit(lower, 1, 1, 1))
            for before, n in pairwise(shapes)
        },
    )


def test_a_sound_robot_and_an_empty_one_have_nothing_to_say():
    assert [one.code for one in check_robot(alone(large_robot(3)))] == ["root-inertial"]
    assert not check_robot(alone(Robot("")))


def test_without_texts_and_places_there_are_findings_without_fixes():
    found = check_robot(alone(rover()))
    assert {one.code for one in found} == {"missing-inertial", "inertia-size"}
    assert all(one.place is None and one.fix is None for one in found)


def test_names_of_links_are_told_as_they_are_written():
    name = "&lt;b&gt; &quot;😀"
    one = robot(link("base"), link(name, inertial(-1, 1, 1, 1)))
    (problem,) = [p for p in check_robot(checked(one)) if p.code == "bad-mass"]
    assert '<b> "😀' in problem.sentence
    assert problem.parts == ('link:<b> "😀',)


def test_huge_and_tiny_numbers_come_to_findings_without_warnings():
    big = inertial("1e11", "1e11", "1e11", "1e11")
    tiny = inertial("1e-300", "1e-300", "1e-300", "1e-300")
    shape = box("visual", "1e11 1e-300 0") + box("collision", "0 0 0")
    one = robot(link("base", big, shape), link("arm", tiny, shape), joint("continuous", "arm"))
    assert "density" in codes(one)


def test_ten_thousand_links_are_checked_in_seconds():
    one = alone(large_robot(10_000))
    began_s = time.thread_time()
    check_robot(one)
    assert time.thread_time() - began_s < 20


def test_of_many_alike_the_first_are_told_and_the_others_counted():
    found = [p for p in check_robot(alone(large_robot(302, 2.0))) if p.code == "reversed-limits"]
    assert len(found) == ALIKE_AT_MOST + 1
    assert "101 more parts" in found[-1].sentence
    assert found[-1].severity is found[0].severity


def test_every_code_that_a_check_explains_is_explained_in_both_languages():
    found = whys(robot_checks, text_checks)
    assert len(found) >= 31
    for code, texts in found.items():
        assert set(texts) == {"en", "de"}, code
        assert all(text.endswith((".", "?")) for text in texts.values()), code
