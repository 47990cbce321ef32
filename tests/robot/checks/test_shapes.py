from __future__ import annotations

import pytest

from tests.support.checked import box, checked, codes, link, problem_of, robot, shape, without


def shaped(*inner: str) -> str:
    return robot(link("base", *inner))


SEEN = box("visual", "0.1 0.1 0.1")


@pytest.mark.parametrize(
    ("collision", "code", "said"),
    [
        (box("collision", "0.1 0.1 0.1", "0.15 0 0"), "collision-apart", "0.05 m beside"),
        (box("collision", "0.4 0.4 0.4"), "collision-size", "4 times larger"),
        (box("collision", "0.02 0.02 0.02"), "collision-size", "5 times smaller"),
        (box("collision", "100 100 100"), "collision-size", "1e+03 times larger"),
    ],
)
def test_a_collision_unlike_its_visual_is_found(collision: str, code: str, said: str):
    problem = problem_of(checked(shaped(SEEN, collision)), code)
    assert said in problem.sentence
    assert problem.parts == ("link:base",)


@pytest.mark.parametrize(
    "inner",
    [
        (SEEN,),
        (box("collision", "1 1 1"),),
        (SEEN, box("collision", "0.1 0.1 0.1", "0.1 0 0")),
        (SEEN, box("collision", "0.3 0.3 0.3")),
        (SEEN, box("collision", "0.04 0.04 0.04")),
        (SEEN, shape("collision", '<sphere radius="0.05"/>')),
        (SEEN, box("collision", "0.1 0.1 0.1", "9 0 0"), box("collision", "0.1 0.1 0.1")),
        (box("visual", "0.01 0.01 0.01"), box("collision", "1 1 1", "5 0 0")),
    ],
)
def test_a_collision_that_covers_its_visual_somehow_is_left_alone(inner: tuple[str, ...]):
    found = without(codes(shaped(*inner)), "no-inertials", "no-collisions", "collision-size")
    assert not found


def test_a_turned_shape_is_compared_as_it_lies():
    rod = '<origin rpy="0 1.5708 0"/>'
    seen = shape("visual", '<cylinder radius="0.01" length="1"/>', rod)
    along = box("collision", "0.1 0.02 0.02", "0.45 0 0")
    assert "collision-apart" not in codes(shaped(seen, along))
    assert "collision-apart" in codes(shaped(seen.replace(rod, ""), along))
