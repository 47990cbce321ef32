from __future__ import annotations

import pytest

from tests.support.checked import box, checked, codes, inertial, link, mended, problem_of, robot


def heavy(*moments: float, mass_kg: float = 1.0, more: str = "") -> str:
    return robot(link("root"), link("arm", inertial(mass_kg, *moments), more))


@pytest.mark.parametrize(
    ("moments", "code", "said"),
    [
        ((-1, 1, 1), "bad-inertia", "all must be above zero"),
        ((0, 0, 0), "bad-inertia", "all must be above zero"),
        ((1, 1, 0), "bad-inertia", "all must be above zero"),
        ((1, 1, 2.001), "inertia-triangle", "exceeds the sum of the two others"),
        ((0.1, 5, 0.1), "inertia-triangle", "moments of inertia of 0.1, 0.1, 5 kg m²"),
    ],
)
def test_moments_that_no_body_has_are_found(moments: tuple[float, ...], code: str, said: str):
    problem = problem_of(checked(heavy(*moments)), code)
    assert 'Link "arm"' in problem.sentence
    assert said in problem.sentence
    assert problem.parts == ("link:arm",)


def test_what_is_beside_the_diagonal_counts():
    one = heavy(1, 1, 1).replace('ixy="0"', 'ixy="5"')
    assert "bad-inertia" in codes(one)
    assert "bad-inertia" not in codes(one.replace('ixy="5"', 'ixy="0.1"'))


@pytest.mark.parametrize("moments", [(1, 1, 1), (1, 1, 2), (1, 1, 2.000001), (1e-9, 1e-9, 1e-9)])
def test_moments_of_a_body_are_left_alone(moments: tuple[float, ...]):
    assert not {"bad-inertia", "inertia-triangle"} & set(codes(heavy(*moments)))


@pytest.mark.parametrize("mass_kg", [0, -1.5])
def test_a_mass_not_above_zero_is_the_one_finding_of_its_link(mass_kg: float):
    found = [code for code in codes(heavy(0, 0, 0, mass_kg=mass_kg)) if "collision" not in code]
    assert found[:1] == ["bad-mass"]
    assert "bad-inertia" not in found


def test_a_frame_of_zero_mass_loses_its_inertial_and_what_has_a_shape_keeps_it():
    after = mended(heavy(0, 0, 0, mass_kg=0), "bad-mass")
    assert "<inertial" not in after
    seen = heavy(0, 0, 0, mass_kg=0, more=box("visual", "1 1 1"))
    assert problem_of(checked(seen), "bad-mass").fix is None
    assert problem_of(checked(heavy(1, 1, 1, mass_kg=-1)), "bad-mass").fix is None


def test_an_impossible_inertia_becomes_that_of_the_box_at_the_same_mass():
    one = heavy(-1, 1, 1, mass_kg=12, more=box("collision", "1 2 3"))
    after = mended(one, "bad-inertia")
    assert 'ixx="13" ixy="0" ixz="0" iyy="10" iyz="0" izz="5"' in after
    assert "bad-inertia" not in codes(after)


def test_without_a_shape_there_is_no_fix_for_an_inertia():
    assert problem_of(checked(heavy(-1, 1, 1)), "bad-inertia").fix is None
